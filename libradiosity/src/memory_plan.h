#pragma once

#include "memory_budget.h"
#include "radiosity/solve.h"

namespace atrium::radiosity {

/// Of a side, whose rows beyond_sides() holds at once.
inline constexpr int kBalanceRays = 256;

/// What decides how much memory a side takes.
struct SideShape {
  int lanes = 1;
  std::size_t groups = 1;
  bool body = false;  ///< are there coupled materials?
  Solver solver = Solver::Rows;
  Keep keep = Keep::Nothing;
};

/// Bytes of irradiance, of what solving takes and of the state that is kept, by side; from above.
[[nodiscard]] std::uint64_t field_bytes_per_side(const SideShape& shape);

/// How many elements may there be, at most `wanted`, so that both sides of all get at least a first
/// round of rays? From above as well: sides that do not take part leave room for longer rows.
/// \throws RuntimeFailure  if the budget does not hold the scene and a few elements.
[[nodiscard]] std::uint32_t elements_that_fit(const MemoryBudget& memory, const scene::Scene& scene,
                                              const SideShape& shape, std::uint32_t wanted);

}  // namespace atrium::radiosity
