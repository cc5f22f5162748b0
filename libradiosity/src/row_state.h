#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "error_control.h"
#include "relight.h"
#include "smoothing.h"
#include "solvers.h"

namespace atrium::radiosity {

inline constexpr int kPilot = 16;  ///< samples of each kind before anything is decided

/// What the rows make of one light group.
template <int N>
struct GroupLight {
  Irradiance<N> direct, caustic, indirect;
  SideValues<N> source;   ///< exchange irradiance from lights
  SideValues<N> bounced;  ///< exchange irradiance of the rows' solution, later a better one
  bool refined = false;   ///< is it better?
  SideValues<N> solved_source, solved_shot;  ///< that `bounced` answers to
  SideValues<N> seen;  ///< bounced, smoothed: what fresh rays read beside the source
  SideValues<N> read;  ///< what the fresh rays so far have read, or as if they had
  std::optional<Smoothing<N>> smoothing;  ///< that made `seen`
};

/// What is being done. A stage that was interrupted is taken up again from what was drawn.
enum class Stage : std::uint8_t {
  Light,
  Rows,
  FirstGather,
  Gather,
  RoundLight,
  RoundSolve,
  RoundGather,
  RoundDone
};

/// Samples per replicate that a side has to get to; may be asked for any number of times.
struct Goal {
  SideIndex side;
  std::uint32_t until;
};
/// Of what is being drawn.
struct Goals {
  std::vector<Goal> direct, shot, gather;
};

/// Patches that are sampled like lamps, and how well they are known.
template <int N>
struct HotLight {
  HotPatches<N> patches;
  SightTable sight;
  bool chosen = false, light_known = false;
};

/// Variances of lane means, by side.
struct Variances {
  std::vector<float> direct, caustic, indirect;
  std::vector<float> rest;  ///< what is in these beside the side's own samples
};

/// What the stated error is made of.
template <int N>
struct ErrorState {
  std::vector<double> weights;  ///< of squared errors, by side
  double raw = 0.0;             ///< before smoothing
  double smoothing_gain = 1.0;  ///< what that left of its square when it was last done
  SideValues<N> before;         ///< irradiance before the last round, not smoothed
  SideValues<N> found;          ///< irradiance, not smoothed
};

/// What is known of the solver before this one.
template <int N>
struct Earlier {
  std::vector<float> hot_reflectance;
  std::vector<std::uint32_t> traced;  ///< rays of each row
  std::vector<std::uint8_t> active;   ///< by side
  std::vector<Spectrum<N>> hot_sums;  ///< Rows::hot
  Iteration iteration;
};

[[nodiscard]] inline std::size_t first_of(GroupChoice group) { return group.value_or(0); }

/// Adds a part of the light of all active sides.
template <int N>
void add(const Problem<N>& problem, const Irradiance<N>& part, Irradiance<N>& into) {
  for (const SideIndex i : problem.sides.active) {
    into.plain[i] += part.plain[i];
    if (problem.sides.any_coupled) into.body[i] += part.body[i];
  }
}

/// Everything that a solver by rows knows. Values only: what happens to them say the functions of
/// kept_state.h (reading and writing), draws.h, bounces.h, hot_light.h, make_rows.h, assembly.h,
/// rounds.h and changed_lights.h; their order solve_rows.cpp.
template <int N>
struct RowState {
  RowState(const Problem<N>& problem_in, Work& work_in, scene::Counters& counters_in)
      : problem(problem_in),
        work(work_in),
        counters(counters_in),
        result(problem_in),
        neighbours(problem_in.elements.layout),
        regions(problem_in),
        groups(problem_in.group_count()),
        direct(no_samples()),
        shot(no_samples()),
        gathered(no_samples()),
        exposed(problem_in.side_count(), 1.0f),
        mixed(problem_in.side_count(), 0) {}

  const Problem<N>& problem;
  Work& work;
  scene::Counters& counters;
  Solution<N> result;
  Neighbours neighbours;
  Regions regions;
  std::vector<GroupLight<N>> groups;
  Tally<N> direct;    ///< lights
  Tally<N> shot;      ///< first light of hot patches
  Tally<N> gathered;  ///< everything else that diffuse surfaces reflect
  BroughtSamples<N> brought;
  Photons<N> photons;
  Rows<N> rows;
  HotLight<N> hot;
  SightTable sight_of_lights;
  HemisphereGuide ray_guide;
  std::vector<float> exposed;       ///< by side: share of its area outside closed bodies
  std::vector<std::uint8_t> mixed;  ///< by side: only a part of it is outside
  std::vector<float> importance;    ///< of errors to the views, by side; empty: all count

  std::optional<Smoothing<N>> result_smoothing;
  float fresh_share = 1.0f;          ///< of gathered light in indirect light
  std::vector<Variances> variances;  ///< by group, then of the sum of all if there are several
  ErrorState<N> error;

  Stage stage = Stage::Light;
  int round = 0;
  Goals goals;
  int iterations_before_assembly = 0;
  Earlier<N> earlier;
  bool caught_up = true;   ///< false: stopped before the earlier solver's rows were traced again
  std::vector<char> kept;  ///< Solution::state

  [[nodiscard]] bool by_error() const { return problem.options.error > 0.0; }
  [[nodiscard]] Tally<N> no_samples() const {
    return Tally<N>(problem.side_count(), problem.group_count(), problem.sides.any_coupled);
  }
  [[nodiscard]] std::uint64_t sample_bytes() const {
    return direct.bytes() + shot.bytes() + gathered.bytes();
  }
  /// Does any group light the side, straight or by the rows?
  [[nodiscard]] bool is_lit(SideIndex i) const {
    return std::any_of(groups.begin(), groups.end(), [&](const GroupLight<N>& g) {
      return !(g.source[i].is_zero() && g.bounced[i].is_zero());
    });
  }
  [[nodiscard]] std::vector<SideIndex> lit_sides() const {
    std::vector<SideIndex> lit;
    for (const SideIndex i : problem.sides.active)
      if (is_lit(i)) lit.push_back(i);
    return lit;
  }
  /// First light of hot patches as far as samples of them found it.
  [[nodiscard]] Spectrum<N> shot_light(SideIndex i, std::size_t group, bool body) const {
    return body ? shot.mean_body(i, group) : shot.mean(i, group);
  }
  /// Share of fresh rays in the pooled estimate: one for all sides, as the shares of rounds are.
  [[nodiscard]] float fresh_share_of(SideIndex i) const {
    return gathered.valid(i) > 0 ? fresh_share : 0.0f;
  }
  /// Groups first_of(group) .. end_of(group) - 1 are those that are meant.
  [[nodiscard]] std::size_t end_of(GroupChoice group) const {
    return group ? *group + 1 : groups.size();
  }
  [[nodiscard]] SideValues<N> minus(SideValues<N> a, const SideValues<N>& b) const {
    for (const SideIndex i : problem.sides.active) a[i] -= b[i];
    return a;
  }
  /// Share of a side's area that counts: what lies outside closed bodies, by importance.
  [[nodiscard]] std::vector<float> counting_share() const {
    std::vector<float> share = exposed;
    if (!importance.empty())
      for (const SideIndex i : problem.sides.active) share[i] *= importance[i];
    return share;
  }
};

}  // namespace atrium::radiosity
