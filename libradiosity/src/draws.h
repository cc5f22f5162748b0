#pragma once

#include "row_state.h"

namespace atrium::radiosity {

template <int N>
[[nodiscard]] std::vector<Goal> goals_of(const std::vector<Draw>& plan, const Tally<N>& tally) {
  std::vector<Goal> goals;
  goals.reserve(plan.size());
  for (const Draw& d : plan) goals.push_back({d.side, tally.drawn(d.side) + d.more});
  return goals;
}
template <int N>
[[nodiscard]] std::vector<Draw> missing(const std::vector<Goal>& goals, const Tally<N>& tally) {
  std::vector<Draw> plan;
  for (const Goal& g : goals)
    if (g.until > tally.drawn(g.side)) plan.push_back({g.side, g.until - tally.drawn(g.side)});
  return plan;
}

/// Samples of the lights.
template <int N>
void draw_direct(RowState<N>& s, const std::vector<Draw>& plan);
/// As many as are missing to `samples`.
template <int N>
void draw_direct(RowState<N>& s, const std::vector<SideIndex>& sides, int samples);
/// Those of sides that lie partly inside closed bodies start again: every point asks where it is.
template <int N>
void draw_direct_of_mixed(RowState<N>& s);

/// Samples of hot patches.
template <int N>
void draw_hot(RowState<N>& s, const std::vector<Draw>& plan);
/// The first ones.
template <int N>
void draw_hot(RowState<N>& s);

/// Samples of hemispheres, against the field of now; those so far are brought up to date with it.
template <int N>
void draw_gather(RowState<N>& s, const std::vector<Draw>& plan);

}  // namespace atrium::radiosity
