#pragma once

#include <optional>

#include "iterate.h"
#include "passes.h"
#include "scene/archive.h"

namespace atrium::radiosity {

/// One light group's part of a solution, with variances of its own.
template <int N>
struct GroupEstimate {
  Irradiance<N> direct, caustic, indirect;
  std::vector<float> light_variance;  ///< of direct and caustic
  std::vector<float> indirect_variance;
};

/// What a solver hands over: irradiance by side and how it got there.
template <int N>
struct Solution {
  Estimate<N> direct, caustic, indirect;
  std::vector<GroupEstimate<N>> groups;  ///< whose sum the estimates are; empty with one group
  std::vector<char> state;               ///< to go on from, if SolveOptions::keep says so
  std::vector<std::uint8_t> valid;       ///< by side
  FluxBalance flux;
  Iteration iteration;
  double error_estimate = 0.0;
  std::optional<double> mesh_error;  ///< see mesh_error.h; if the solver measured it
  bool error_reached = false;        ///< that was asked for

  explicit Solution(const Problem<N>& problem)
      : direct(problem.side_count(), problem.sides.any_coupled),
        caustic(problem.side_count(), problem.sides.any_coupled),
        indirect(problem.side_count(), problem.sides.any_coupled),
        valid(problem.sides.is_active) {}
};

/// Gives what is known to SolveOptions::watch, if somebody watches. Elements that a solution knows
/// nothing of count as not valid.
template <int N>
void hand_out(const Problem<N>& problem, Solution<N> solution);

/// Irradiance that light still on its way makes of all lit sides, with its further bounces, if it
/// spreads evenly [Cohen et al. 1988].
/// \param unshot  radiosity that has not been sent, by side.
template <int N>
[[nodiscard]] Spectrum<N> ambient_irradiance(const Problem<N>& problem, const Solution<N>& solution,
                                             const SideValues<N>& unshot);

/// How a scene differs from the one that a state is of.
struct Changed {
  bool reflectance = false;  ///< of diffuse surfaces
  bool lights = false;       ///< Scene::lights
  bool emission = false;     ///< environment, what surfaces emit

  /// Then elements may have been divided, too.
  [[nodiscard]] bool light() const { return lights || emission; }
};

/// What is known before.
struct Start {
  scene::ArchiveReader* state = nullptr;  ///< Solution::state
  Changed changed;
  /// By element: the one of the state that it is or is part of; empty: the same elements.
  std::vector<std::uint32_t> parent;
  std::vector<scene::Light> lights;  ///< of the scene that the state is of
};

/// \throws Error  if the state is damaged.
template <int N>
[[nodiscard]] Solution<N> solve_with_rows(const Problem<N>& problem, const Start& start, Work& work,
                                          scene::Counters& counters);
/// \throws Error  if the scene has specular surfaces or more sides than a dense matrix can hold.
template <int N>
[[nodiscard]] Solution<N> solve_with_matrix(const Problem<N>& problem, Work& work,
                                            scene::Counters& counters);
/// \throws Error  if the scene has specular surfaces.
template <int N>
[[nodiscard]] Solution<N> solve_with_shooting(const Problem<N>& problem, Work& work,
                                              scene::Counters& counters);

/// E_B where coupled, else E.
template <int N>
[[nodiscard]] const Spectrum<N>& exchange(const Problem<N>& problem, const Irradiance<N>& e,
                                          SideIndex i) {
  return problem.sides.coupled[i / 2] != 0 ? e.body[i] : e.plain[i];
}

/// Irradiance of all origins.
template <int N>
[[nodiscard]] Spectrum<N> total_plain(const Solution<N>& s, SideIndex i) {
  return s.direct.irradiance.plain[i] + s.caustic.irradiance.plain[i] +
         s.indirect.irradiance.plain[i];
}
template <int N>
[[nodiscard]] Spectrum<N> total_exchange(const Problem<N>& problem, const Solution<N>& s,
                                         SideIndex i) {
  return exchange(problem, s.direct.irradiance, i) + exchange(problem, s.caustic.irradiance, i) +
         exchange(problem, s.indirect.irradiance, i);
}

/// Flux per area [lane mean] that no diffuse part of a side sends on.
template <int N>
[[nodiscard]] double absorbed_per_area(const Problem<N>& problem, const Solution<N>& s,
                                       SideIndex i) {
  const Spectrum<N> kept =
      total_plain(s, i) - (problem.sides.reflectance[i] + problem.sides.transmittance[i ^ 1U]) *
                              total_exchange(problem, s, i);
  return static_cast<double>(kept.mean());
}

/// Absorbed: at diffuse surfaces by their irradiance, elsewhere by what paths lost. Escaped: by
/// rays that left. Neither is made from the other or from what the lights emit.
template <int N>
[[nodiscard]] FluxBalance flux_balance(const Problem<N>& problem, const Solution<N>& solution,
                                       const Photons<N>& photons, const Rows<N>& rows);

/// Where the light of a side goes that no side receives, as shares of it.
template <int N>
struct Beyond {
  LaneValues<N> escaped = filled<N>(1.0);
  LaneValues<N> absorbed{};  ///< by surfaces without elements: black ones, inner faces of bodies
  LaneValues<N> in_medium{};

  /// Adds a flux by lane to what it becomes, lane means.
  void divide(const LaneValues<N>& flux, FluxBalance& balance) const {
    for (std::size_t lane = 0; lane < N; ++lane) {
      balance.escaped += flux[lane] * escaped[lane] / N;
      balance.absorbed += flux[lane] * absorbed[lane] / N;
      balance.in_medium += flux[lane] * in_medium[lane] / N;
    }
  }
};
/// For solvers that know from factors how much that is; what becomes of it is asked of hemisphere
/// rays. By active side.
template <int N>
[[nodiscard]] std::vector<Beyond<N>> beyond_sides(const Problem<N>& problem, Work& work,
                                                  scene::Counters& counters);

/// \throws Error  naming the solver if something mirrors, refracts or glosses.
template <int N>
void require_diffuse(const Problem<N>& problem, const char* solver);

}  // namespace atrium::radiosity
