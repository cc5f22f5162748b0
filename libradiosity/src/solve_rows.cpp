#include "solvers.h"

#include "assembly.h"
#include "bounces.h"
#include "changed_lights.h"
#include "draws.h"
#include "hot_light.h"
#include "kept_state.h"
#include "make_rows.h"
#include "mesh_error.h"
#include "rounds.h"
#include "scene/archive.h"
#include "watching.h"

namespace atrium::radiosity {
namespace {

/// What depends on reflectances. Which patches are hot does not matter to the result, and their
/// light straight from the lights is what it was.
template <int N>
void forget_reflected(RowState<N>& s) {
  if (s.earlier.hot_reflectance != hot_reflectance(s)) s.shot = s.no_samples();
  s.gathered = s.no_samples();
  s.brought = {};
  s.ray_guide = {};
  for (GroupLight<N>& g : s.groups) g = GroupLight<N>();
  if (s.stage > Stage::Rows) take_direct(s);
  s.round = 0;
  s.goals = {};
}

/// Takes over where another solver was.
template <int N>
void restore(RowState<N>& s, const Start& start) {
  const SideParents parents(start.parent, s.problem.side_count());
  read_state(s, *start.state, parents.old_sides(), start.changed.light());
  if (start.changed.light()) {
    relight(s, parents, start);
    return;
  }
  if (s.earlier.active != s.problem.sides.is_active) start.state->damaged();
  const bool same = !start.changed.reflectance;
  s.result.iteration = s.earlier.iteration;
  s.iterations_before_assembly = s.result.iteration.iterations;
  if (s.stage <= Stage::Rows) {
    // These follow from rows that are traced again.
    s.exposed.assign(s.problem.side_count(), 1.0f);
    s.mixed.assign(s.problem.side_count(), 0);
    s.result.valid = s.problem.sides.is_active;
    s.groups.assign(s.groups.size(), GroupLight<N>());
    s.result.iteration = {};
    if (!same) forget_reflected(s);
    return;
  }
  if (!same && s.earlier.hot_reflectance != hot_reflectance(s)) {
    // What rays found of hot patches by chance is in the rows.
    forget_reflected(s);
    s.stage = Stage::Rows;
    return;
  }
  s.work.begin("rows", 0.4);
  if (s.rows.rays.empty()) trace_again(s);
  take_direct(s);
  if (same) return;
  forget_reflected(s);
  solve_bounces(s);
  guide_rays(s);
  s.stage = Stage::FirstGather;
}

/// Light straight from the lights, and what photons bring.
template <int N>
void measure_lights(RowState<N>& s) {
  s.work.begin("direct light", 0.15);
  if (s.sight_of_lights.empty())
    s.sight_of_lights = sight_of_lights(s.problem, s.regions, s.counters);
  draw_direct(s, s.problem.sides.active, s.by_error() ? kPilot : s.problem.options.direct_samples);
  show_direct(s);
  s.work.begin(s.problem.specular ? "caustics" : "flux balance", s.problem.specular ? 0.3 : 0.17);
  s.photons = trace_photons(s.problem, s.work, s.counters);
  (void)paused(s, Stage::Light);
  if (s.problem.specular) show_direct(s);
}

/// A quarter of the rays against the rows' field, the rest against the one that these make of it:
/// the rows' own noise would stay in the second bounce otherwise. Few rays are not worth it.
template <int N>
void gather_twice(RowState<N>& s, int rays) {
  constexpr int kWorthwhile = 64;
  if (s.stage < Stage::Gather) {
    const std::vector<SideIndex> lit = s.lit_sides();
    if (rays >= kWorthwhile) {
      draw_gather(s, top_up(s.problem, s.gathered, lit, rays / 4, s.importance));
      const bool stop = paused(s, Stage::FirstGather);
      assemble(s);
      if (stop || paused(s, Stage::FirstGather)) return;
    }
    if (rays >= kWorthwhile) refine_field(s);
    s.goals.gather = goals_of(top_up(s.problem, s.gathered, lit, rays, s.importance), s.gathered);
  }
  draw_gather(s, missing(s.goals.gather, s.gathered));
  (void)paused(s, Stage::Gather);
  assemble(s);
  (void)paused(s, Stage::Gather);
}

/// The solution of what is known.
template <int N>
Solution<N> hand_over(RowState<N>& s) {
  keep(s);
  s.result.state = std::move(s.kept);
  s.result.flux = flux_balance(s.problem, s.result, s.photons, s.rows);
  if (!s.work.stopped())
    s.result.mesh_error = find_mesh_error(s.problem, s.result, s.direct, s.gathered,
                                          s.counting_share(), s.mixed, s.work, s.counters);
  for (std::size_t g = 0; g < s.groups.size() && s.groups.size() > 1; ++g)
    s.result.groups.push_back(part_of(s, g));
  return std::move(s.result);
}

/// In stages. An interrupt leaves the state in which a later solver gets to the same bits: every
/// decision depends on samples that were complete when it was made, or is remembered.
template <int N>
Solution<N> solve(RowState<N>& s) {
  s.work.memory().hold(MemoryBudget::Part::Samples, s.sample_bytes());
  if (s.stage == Stage::Light) measure_lights(s);
  if (s.stage <= Stage::Rows) build_rows(s);
  s.work.begin("gathering", 0.98);
  if (s.stage < Stage::RoundLight)
    gather_twice(s, s.by_error() ? kPilot : s.problem.options.gather_rays);
  else if (finish_round(s))
    ++s.round;
  else
    assemble(s);
  if (s.by_error()) reach_error(s);
  if (!s.work.stopped()) s.round = 0;
  return hand_over(s);
}

}  // namespace

template <int N>
Solution<N> solve_with_rows(const Problem<N>& problem, const Start& start, Work& work,
                            scene::Counters& counters) {
  RowState<N> s(problem, work, counters);
  if (start.state != nullptr) restore(s, start);
  return solve(s);
}

#define ATRIUM_INSTANTIATE(N) \
  template Solution<N> solve_with_rows(const Problem<N>&, const Start&, Work&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
