// What a solve says it holds against what it asks the allocator for: this program counts both. The
// ray tracer has an allocator of its own (RayQuery::memory_bytes).
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"

namespace {

std::atomic<std::int64_t> held{0}, most{0};

void* take(std::size_t size, std::size_t alignment) {
  void* p = alignment > alignof(std::max_align_t)
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  const std::int64_t now = held += static_cast<std::int64_t>(malloc_usable_size(p));
  std::int64_t before = most;
  while (now > before && !most.compare_exchange_weak(before, now)) {
  }
  return p;
}
void give(void* p) noexcept {
  if (p != nullptr) held -= static_cast<std::int64_t>(malloc_usable_size(p));
  std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return take(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) {
  return take(size, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept { give(p); }
void operator delete(void* p, std::size_t) noexcept { give(p); }
void operator delete(void* p, std::align_val_t) noexcept { give(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { give(p); }

namespace atrium::radiosity {
namespace {

using test::SceneMaker;

/// A room with a lamp; with a mirror, photons are traced as well.
scene::Scene room(bool mirror) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.7));
  material::Material m = test::diffuse(0.0);
  m.k_df = 0.0;
  m.k_rg = 1.0;
  const auto wall = mirror ? maker.material(m) : white;
  maker.room({0, 0, 0}, {3, 3, 2}, {wall, white, white, white, white, white});
  const auto lamp = maker.material(test::emitter(10.0, 0.5));
  maker.quad(lamp, {1, 1, 1.9f}, {1, 2, 1.9f}, {2, 2, 1.9f}, {2, 1, 1.9f});
  return maker.take();
}

struct Measured {
  SolveResult result;
  std::uint64_t allocated;  ///< most at once, with the scene and its BVH
};
Measured measure(const scene::RayQuery& query, const SolveOptions& options) {
  const std::int64_t before = held;
  most = before;
  SolveResult result = solve(query, material::SpectralBasis::grey(), options);
  const auto own = static_cast<std::uint64_t>(most - before);
  const std::uint64_t allocated = own + result.memory.scene + result.memory.bvh;
  return {std::move(result), allocated};
}

class MemoryLimit : public ::testing::TestWithParam<bool> {};

TEST_P(MemoryLimit, CountsWhatIsAllocated) {
  const scene::Scene scene = room(GetParam());
  const scene::RayQuery query(scene);
  const Measured m = measure(query, {.max_elements = 12000, .gather_rays = 16});
  EXPECT_TRUE(m.result.given_up.empty());
  EXPECT_GT(m.result.memory.bvh, 0u);
  // Predictions are from above, by less than a factor of 2.
  EXPECT_LE(m.allocated, m.result.memory.peak);
  EXPECT_GT(2 * m.allocated, m.result.memory.peak);
}

TEST_P(MemoryLimit, IsKeptWithShorterRowsThenFewerElements) {
  const scene::Scene scene = room(GetParam());
  const scene::RayQuery query(scene);
  const SolveOptions options{.max_elements = 12000, .gather_rays = 16};
  const Measured all = measure(query, options);
  const auto mean = [](const SolveResult& r) {
    double sum = 0.0, area = 0.0;
    for (std::size_t e = 0; e < r.field.element_count(); ++e) {
      const double a = static_cast<double>(r.field.element_area[e]);
      sum += a * static_cast<double>(r.field.irradiance.direct[2 * e] +
                                     r.field.irradiance.indirect[2 * e]);
      area += a;
    }
    return sum / area;
  };
  std::uint64_t entries = all.result.counters[scene::Counter::RaysRow];
  std::size_t elements = all.result.field.element_count();
  for (const double share : {0.8, 0.4, 0.1}) {
    SCOPED_TRACE(share);
    SolveOptions limited = options;
    limited.memory_limit = static_cast<std::uint64_t>(share * static_cast<double>(all.allocated));
    const Measured m = measure(query, limited);
    EXPECT_EQ(m.result.stopped_by, "memory limit");
    EXPECT_FALSE(m.result.given_up.empty());
    EXPECT_LE(m.result.memory.peak, limited.memory_limit);
    EXPECT_LE(m.allocated, limited.memory_limit);
    EXPECT_LT(m.result.counters[scene::Counter::RaysRow], entries);
    EXPECT_LE(m.result.field.element_count(), elements);
    entries = m.result.counters[scene::Counter::RaysRow];
    elements = m.result.field.element_count();
    EXPECT_NEAR(mean(m.result), mean(all.result), 0.03 * mean(all.result));
  }
  EXPECT_LT(elements, all.result.field.element_count() / 4);
}

TEST_P(MemoryLimit, RefusesWhatDoesNotFit) {
  const scene::Scene scene = room(GetParam());
  const scene::RayQuery query(scene);
  EXPECT_THROW(static_cast<void>(measure(query, {.memory_limit = 10000})), RuntimeFailure);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MemoryLimit, ::testing::Bool(),
                         [](const auto& p) { return p.param ? "Mirror" : "Diffuse"; });

TEST(MemoryLimitOfMatrix, RefusesMatricesThatDoNotFit) {
  const scene::Scene scene = room(false);
  const scene::RayQuery query(scene);
  SolveOptions options{.solver = Solver::Matrix, .element_size = 0.5, .memory_limit = 2000000};
  EXPECT_THROW(static_cast<void>(measure(query, options)), RuntimeFailure);
  options.memory_limit = 20000000;
  const Measured m = measure(query, options);
  EXPECT_EQ(m.result.stopped_by, "tolerance");
  EXPECT_LE(m.result.memory.peak, options.memory_limit);
}

TEST(MemoryLimitOfShooting, HasElementsThatFit) {
  const scene::Scene scene = room(false);
  const scene::RayQuery query(scene);
  const SolveOptions options{.solver = Solver::Shooting, .memory_limit = 2000000};
  const Measured m = measure(query, options);
  EXPECT_EQ(m.result.stopped_by, "memory limit");
  EXPECT_GT(m.result.field.element_count(), 30U);
  EXPECT_LE(m.result.memory.peak, options.memory_limit);
  EXPECT_LE(m.allocated, options.memory_limit);
}

}  // namespace
}  // namespace atrium::radiosity
