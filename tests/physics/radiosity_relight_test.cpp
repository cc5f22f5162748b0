// Going on with other lights: what a solve from the beginning finds, for fewer rays.
#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using test::SceneMaker;

scene::Light point(const Vec3d& at, double intensity) {
  scene::Light light;
  light.kind = scene::PointLight{.intensity = material::SpectralValue(intensity), .falloff = {}};
  light.to_scene.translation() = at;
  return light;
}

/// A narrow spot downwards: the floor below it is a hot patch.
scene::Light spot(const Vec3d& at, double intensity) {
  scene::Light light;
  light.kind = scene::SpotLight{.intensity = material::SpectralValue(intensity),
                                .inner_angle = 0.1f,
                                .outer_angle = 0.12f,
                                .falloff = {}};
  light.to_scene.translation() = at;
  return light;
}

/// A row of four rooms of 3 m, each with a table and a lamp, joined by doors of 1 m x 2 m.
/// \param lights  beside the panel in the last room. \param panel  its radiance.
scene::Scene four_rooms(std::vector<scene::Light> lights, double panel = 3.0) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.6));
  const auto dark = maker.material(test::diffuse(0.3));
  const auto lamp = maker.material(test::emitter(panel, 0.5));
  for (int r = 0; r < 4; ++r) {
    const float x = 3.0f * static_cast<float>(r);
    maker.quad(dark, {x, 0, 0}, {x + 3, 0, 0}, {x + 3, 3, 0}, {x, 3, 0});
    maker.quad(white, {x, 0, 3}, {x, 3, 3}, {x + 3, 3, 3}, {x + 3, 0, 3});
    maker.quad(white, {x, 0, 0}, {x, 0, 3}, {x + 3, 0, 3}, {x + 3, 0, 0});
    maker.quad(white, {x, 3, 0}, {x + 3, 3, 0}, {x + 3, 3, 3}, {x, 3, 3});
    maker.quad(dark, {x + 1, 1, 0.8f}, {x + 2, 1, 0.8f}, {x + 2, 2.4f, 0.8f}, {x + 1, 2.4f, 0.8f});
    if (r == 0) continue;
    const auto wall = [&](float y0, float y1, float z0, float z1) {
      maker.quad(white, {x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1});
    };
    wall(0, 1, 0, 3);
    wall(2, 3, 0, 3);
    wall(1, 2, 2, 3);
  }
  maker.quad(white, {0, 0, 0}, {0, 3, 0}, {0, 3, 3}, {0, 0, 3});
  maker.quad(white, {12, 0, 0}, {12, 0, 3}, {12, 3, 3}, {12, 3, 0});
  maker.quad(lamp, {10, 1, 2.9f}, {10, 2, 2.9f}, {11, 2, 2.9f}, {11, 1, 2.9f});
  scene::Scene s = maker.take();
  s.objects.back().name = "panel";
  for (std::size_t k = 0; k < lights.size(); ++k) lights[k].name = "lamp " + std::to_string(k);
  s.lights = std::move(lights);
  return s;
}

std::vector<scene::Light> lamps(const Vec3d& first) {
  return {point(first, 5.0), point({4.5, 1.5, 2.6}, 5.0), point({7.5, 1.5, 2.6}, 5.0)};
}

struct Bench {
  explicit Bench(scene::Scene s) : scene(std::move(s)), query(scene) {}
  scene::Scene scene;
  scene::RayQuery query;

  SolveResult run(const SolveOptions& o, const SolveResult* previous = nullptr) const {
    const auto grey = material::SpectralBasis::grey();
    if (previous == nullptr) return solve(query, grey, o);
    return solve(query, grey, o, {}, Previous{previous->field, previous->state});
  }
};

SolveOptions options(double error = 0.0, int max_level = 0) {
  SolveOptions o;
  o.element_size = 0.4;
  o.max_level = max_level;
  o.error = error;
  o.keep = Keep::Samples;
  return o;
}

std::uint64_t rays(const SolveResult& r) {
  return r.counters[Counter::RaysDirect] + r.counters[Counter::RaysRow] +
         r.counters[Counter::RaysPhoton];
}

double total(const SolveResult& r, std::size_t i) {
  double sum = static_cast<double>(r.field.irradiance.direct[i]) +
               static_cast<double>(r.field.irradiance.indirect[i]);
  if (!r.field.irradiance.caustic.empty())
    sum += static_cast<double>(r.field.irradiance.caustic[i]);
  return sum;
}

/// The sides of two solutions of the same elements in units of their standard errors, and the whole
/// flux.
struct Difference {
  double rms = 0.0, outliers = 0.0, flux = 0.0;
};
Difference compare(const SolveResult& a, const SolveResult& b) {
  EXPECT_EQ(a.field.nodes, b.field.nodes);
  Difference d;
  double count = 0.0, flux_a = 0.0, flux_b = 0.0;
  for (std::size_t i = 0; i < a.field.element_count() * 2; ++i) {
    const double area = static_cast<double>(a.field.element_area[i / 2]);
    flux_a += area * total(a, i);
    flux_b += area * total(b, i);
    EXPECT_GE(total(a, i), 0.0);
    const double error = std::hypot(static_cast<double>(a.field.standard_error[i]),
                                    static_cast<double>(b.field.standard_error[i]));
    if (!(error > 0.0)) continue;
    const double z = (total(a, i) - total(b, i)) / error;
    d.rms += z * z;
    d.outliers += std::abs(z) > 3.0 ? 1.0 : 0.0;
    count += 1.0;
  }
  d.rms = std::sqrt(d.rms / count);
  d.outliers /= count;
  d.flux = flux_a / flux_b - 1.0;
  return d;
}

/// Goes on from one set of lights to another and compares with solves from the beginning.
/// \param share  of the rays of a solve from the beginning that may be needed, mean of the seeds.
void expect_relights(scene::Scene before, scene::Scene after, const SolveOptions& o, double share) {
  const Bench was(std::move(before));
  const Bench is(std::move(after));
  std::vector<Difference> relit, afresh;
  double needed = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SolveOptions own = o;
    own.seed = seed;
    const SolveResult old = was.run(own);
    const SolveResult rest = is.run(own, &old);
    own.seed = seed + 100;
    const SolveResult independent = is.run(own);
    own.seed = seed + 200;
    const SolveResult another = is.run(own);
    needed += 0.25 * static_cast<double>(rays(rest)) / static_cast<double>(rays(independent));
    if (o.error > 0.0)
      EXPECT_LE(rest.error_estimate, o.error);
    else
      EXPECT_LT(rest.error_estimate, 1.1 * independent.error_estimate);
    relit.push_back(compare(rest, independent));
    afresh.push_back(compare(another, independent));
  }
  ::testing::Test::RecordProperty("rays", std::to_string(needed));
  EXPECT_LT(needed, share);
  // As far from an independent solution as another independent one is, side by side: 300 sides and
  // four seeds know the RMS to 4 %, their errors are correlated; a fifth more is far off. The flux
  // of one solution is off by no more than its stated error, a bound for correlated sides.
  double rms = 0.0, rms_afresh = 0.0, flux = 0.0;
  for (std::size_t k = 0; k < relit.size(); ++k) {
    rms += relit[k].rms * relit[k].rms / 4.0;
    rms_afresh += afresh[k].rms * afresh[k].rms / 4.0;
    flux += relit[k].flux / 4.0;
    ::testing::Test::RecordProperty("flux_" + std::to_string(k), std::to_string(relit[k].flux));
    ::testing::Test::RecordProperty("flux_afresh_" + std::to_string(k),
                                    std::to_string(afresh[k].flux));
  }
  ::testing::Test::RecordProperty("rms", std::to_string(std::sqrt(rms)));
  ::testing::Test::RecordProperty("rms_afresh", std::to_string(std::sqrt(rms_afresh)));
  EXPECT_LT(std::sqrt(rms), 1.2 * std::sqrt(rms_afresh));
  EXPECT_NEAR(flux, 0.0, 0.005);
}

TEST(Relight, AMovedLampConcernsItsRoom) {
  expect_relights(four_rooms(lamps({1.5, 1.5, 2.6})), four_rooms(lamps({0.8, 2.0, 2.2})), options(),
                  0.75);
}
TEST(Relight, AMovedLampToAnError) {
  expect_relights(four_rooms(lamps({1.5, 1.5, 2.6})), four_rooms(lamps({0.8, 2.0, 2.2})),
                  options(0.03), 0.8);
}
TEST(Relight, AnotherLampAndADimmedPanel) {
  std::vector<scene::Light> more = lamps({1.5, 1.5, 2.6});
  more.push_back(point({10.5, 0.5, 1.0}, 2.0));
  expect_relights(four_rooms(lamps({1.5, 1.5, 2.6})), four_rooms(more, 2.0), options(0.03), 0.95);
}
TEST(Relight, ALampThatIsGone) {
  std::vector<scene::Light> fewer = lamps({1.5, 1.5, 2.6});
  fewer.erase(fewer.begin());
  expect_relights(four_rooms(lamps({1.5, 1.5, 2.6})), four_rooms(fewer), options(0.03), 0.95);
}
TEST(Relight, HotPatchesAreChosenAgain) {
  std::vector<scene::Light> before = lamps({1.5, 1.5, 2.6}), after = before;
  before.push_back(spot({0.5, 0.5, 2.5}, 400.0));
  after.push_back(spot({5.2, 0.5, 2.5}, 400.0));
  expect_relights(four_rooms(before), four_rooms(after), options(0.03), 0.9);
  expect_relights(four_rooms(before), four_rooms(lamps({1.5, 1.5, 2.6})), options(0.03), 0.9);
  expect_relights(four_rooms(lamps({1.5, 1.5, 2.6})), four_rooms(after), options(0.03), 0.9);
}

// A lamp in a closed box lights its inside; outside, that has no light any more, and the room has.
TEST(Relight, ALampThatComesOutOfABox) {
  const auto room = [](const Vec3d& lamp) {
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(0.5));
    maker.room({0, 0, 0}, {4, 3, 3}, white);
    maker.sphere(white, 0.9f, 2, false);
    scene::Scene s = maker.take();
    for (Vec3f& p : s.meshes.back().positions) p += Vec3f(2, 1.5f, 1.2f);
    s.lights = {point(lamp, 5.0), point({0.5, 0.5, 2.5}, 1.0)};
    return s;
  };
  const Bench was(room({2, 1.5, 1.2})), is(room({3.3, 2.2, 2.4}));
  const SolveResult rest = [&] {
    const SolveResult old = was.run(options());
    return is.run(options(), &old);
  }();
  SolveOptions o = options();
  o.seed = 5;
  EXPECT_NEAR(compare(rest, is.run(o)).flux, 0.0, 0.01);
}

// The lamp comes close to a wall: elements there are divided further, and their error is stated.
TEST(Relight, ElementsAreDividedWhereTheLightIsNow) {
  SolveOptions o = options(0.0, 3);
  o.mesh_error = 0.02;
  const Bench was(four_rooms(lamps({1.5, 1.5, 2.0})));
  const Bench is(four_rooms(lamps({0.1, 1.5, 1.5})));
  const SolveResult old = was.run(o);
  const SolveResult rest = is.run(o, &old);
  EXPECT_GT(rest.field.element_count(), old.field.element_count());
  // Gone on with, the divided elements are those of the solution.
  const SolveResult again = is.run(o, &rest);
  EXPECT_EQ(again.field.nodes, rest.field.nodes);
  EXPECT_EQ(again.field.irradiance.indirect, rest.field.irradiance.indirect);
  EXPECT_EQ(again.mesh_error, rest.mesh_error);
  SolveOptions other = o;
  other.seed = 5;
  const SolveResult independent = is.run(other);
  double flux = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < 2 * rest.field.element_count(); ++i)
    flux += static_cast<double>(rest.field.element_area[i / 2]) * total(rest, i);
  for (std::size_t i = 0; i < 2 * independent.field.element_count(); ++i)
    expected += static_cast<double>(independent.field.element_area[i / 2]) * total(independent, i);
  EXPECT_NEAR(flux / expected, 1.0, 0.01);
  // A coarser limit leaves the elements as they are, and says what that costs.
  o.max_elements = static_cast<std::uint32_t>(old.field.element_count());
  const SolveResult bound = was.run(o);
  EXPECT_GT(is.run(o, &bound).mesh_error, 1.2 * rest.mesh_error);
}

TEST(Relight, WithLightGroups) {
  SolveOptions o = options();
  o.light_groups = scene::Grouping::ByName;
  const Bench was(four_rooms(lamps({1.5, 1.5, 2.6})));
  const Bench is(four_rooms(lamps({0.8, 2.0, 2.2})));
  const SolveResult old = was.run(o);
  const SolveResult rest = is.run(o, &old);
  o.seed = 9;
  const SolveResult independent = is.run(o);
  ASSERT_EQ(rest.groups.size(), independent.groups.size());
  for (std::size_t g = 0; g < rest.groups.size(); ++g) {
    double mean = 0.0, expected = 0.0;
    for (std::size_t i = 0; i < 2 * rest.field.element_count(); ++i) {
      const double area = static_cast<double>(rest.field.element_area[i / 2]);
      mean += area * static_cast<double>(rest.groups[g].irradiance.indirect[i]);
      expected += area * static_cast<double>(independent.groups[g].irradiance.indirect[i]);
    }
    EXPECT_NEAR(mean / expected, 1.0, 0.015) << rest.groups[g].name;
  }
}

std::string refusal(const SolveResult& old, scene::Scene other, const SolveOptions& o) {
  try {
    (void)Bench(std::move(other)).run(o, &old);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Relight, MovedGeometryAndOtherMaterialsAreRefused) {
  const SolveOptions o = options();
  const SolveResult old = Bench(four_rooms(lamps({1.5, 1.5, 2.6}))).run(o);
  scene::Scene moved = four_rooms(lamps({1.5, 1.5, 2.6}));
  moved.meshes[4].positions[0].z() += 0.1f;
  EXPECT_NE(refusal(old, std::move(moved), o).find("other geometry"), std::string::npos);
  scene::Scene fog = four_rooms(lamps({1.5, 1.5, 2.6}));
  fog.medium_extinction = 0.1;
  EXPECT_NE(refusal(old, std::move(fog), o).find("other materials"), std::string::npos);
}

}  // namespace
}  // namespace atrium::radiosity
