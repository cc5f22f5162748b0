#include "memory_plan.h"

#include "material/error.h"

namespace atrium::radiosity {
namespace {

constexpr std::uint64_t kFloat = sizeof(float), kDouble = sizeof(double);

std::uint64_t spectrum(const SideShape& s) { return kFloat * static_cast<std::uint64_t>(s.lanes); }
std::uint64_t irradiance(const SideShape& s) { return spectrum(s) * (s.body ? 2 : 1); }

/// Three tallies (problem.h: lights, hot patches, gathering).
std::uint64_t sample_bytes_per_side(const SideShape& s) {
  return 3 * (s.groups * (irradiance(s) + 4 * kFloat) + 5 * kFloat);
}

/// Pieces, points and properties of one element; twice, as divided elements replace others.
std::uint64_t element_bytes(const SideShape& s) { return 2 * (400 + 4 * spectrum(s)); }

}  // namespace

std::uint64_t field_bytes_per_side(const SideShape& s) {
  constexpr std::uint64_t kVectors = 29;    // of the Krylov basis, and beside it
  constexpr std::uint64_t kVariances = 10;  // at the same time
  const std::uint64_t group = 3 * irradiance(s) + 6 * spectrum(s) + 8 * kFloat;
  std::uint64_t sum = 3 * (irradiance(s) + kFloat) + 2 * s.groups * group;
  if (s.solver == Solver::Rows)
    sum += kVectors * kDouble * static_cast<std::uint64_t>(s.lanes) + kVariances * kDouble;
  // A growing archive has up to twice its size.
  if (s.keep != Keep::Nothing) sum += 2 * (sample_bytes_per_side(s) + s.groups * group);
  return sum;
}

std::uint32_t elements_that_fit(const MemoryBudget& memory, const scene::Scene& scene,
                                const SideShape& shape, std::uint32_t wanted) {
  if (memory.limit() == 0) return wanted;
  constexpr std::uint64_t kTriangle = 300;   // pieces and points that every triangle has
  constexpr std::uint64_t kFirstRound = 16;  // rays of a row
  constexpr std::uint64_t kRay = 48;         // three entries of 16, while rows are joined
  constexpr std::uint64_t kBeyond =
      std::uint64_t{kBalanceRays} * 24;  // rows of the other solvers' balances
  constexpr std::uint32_t kFewest = 16;
  const std::uint64_t fixed = memory.held() + kTriangle * scene.triangle_count();
  const std::uint64_t row = shape.solver == Solver::Rows ? kFirstRound * kRay : kBeyond;
  const std::uint64_t each =
      element_bytes(shape) + 2 * (sample_bytes_per_side(shape) + field_bytes_per_side(shape) + row);
  const std::uint64_t least = fixed + std::min(wanted, kFewest) * each;
  if (least > memory.limit())
    throw RuntimeFailure("radiosity: a memory limit of " + megabytes(memory.limit()) +
                         " does not hold this scene: its " +
                         std::to_string(scene.triangle_count()) + " triangles alone need " +
                         megabytes(least));
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(wanted, (memory.limit() - fixed) / each));
}

}  // namespace atrium::radiosity
