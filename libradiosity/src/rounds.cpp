#include "rounds.h"

#include <cmath>

#include "assembly.h"
#include "bounces.h"
#include "draws.h"
#include "kept_state.h"
#include "make_rows.h"
#include "solution_error.h"

namespace atrium::radiosity {
namespace {

constexpr double kShadowRayCost = 0.5;  // of a hemisphere ray, measured
constexpr double kMargin = 0.97;        // a last round for little is dear

/// Radiosity of what gathering may come upon (lane mean over the flux), hot patches aside.
template <int N>
double strongest_radiosity(const RowState<N>& s) {
  double flux = 0.0;
  double squares = 0.0;
  for (const SideIndex i : s.problem.sides.active) {
    if (s.hot.patches.contains(i)) continue;
    const double b = static_cast<double>(
        leaving(s.problem.sides, i, total_plain(s.result, i), total_plain(s.result, i ^ 1U))
            .mean());
    flux += static_cast<double>(s.problem.area(i)) * b;
    squares += static_cast<double>(s.problem.area(i)) * b * b;
  }
  return flux > 0.0 ? squares / flux : 0.0;
}

/// A round costs no more than all before it: what these found is the base of its plan, and its
/// own light is better guided.
template <int N>
double cost_so_far(const RowState<N>& s) {
  double cost = 0.0;
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    cost += kShadowRayCost * (s.direct.valid(i) + s.shot.valid(i)) + s.gathered.valid(i) +
            s.rows.rays[k];
  }
  return cost;
}

/// Of the lights, hemispheres and hot patches.
template <int N>
std::vector<Stratum<N>> strata_of(const RowState<N>& s) {
  std::vector<double> lights(s.regions.size(), 0.0);
  std::vector<double> patches(s.regions.size(), 0.0);
  for (std::size_t r = 0; r < lights.size(); ++r) {
    lights[r] = s.sight_of_lights.open(r);
    patches[r] = s.hot.sight.open(r);
  }
  const std::vector<double> bright(s.regions.size(), strongest_radiosity(s));
  const auto stratum = [&](const Tally<N>& tally, const std::vector<double>& strongest,
                           double cost) {
    return Stratum<N>{&tally, expected_variance(s.problem, s.regions, tally, strongest), cost};
  };
  return {stratum(s.direct, lights, kShadowRayCost), stratum(s.gathered, bright, 1.0),
          stratum(s.shot, patches, kShadowRayCost)};
}

/// Twice as many photons, all of them new. False if stopped or at the end of their numbers.
template <int N>
bool more_photons(RowState<N>& s) {
  const std::uint64_t next = s.photons.count * 2;
  if (next > photons_that_fit<N>(s.work.memory(), next)) return false;
  s.work.begin("caustics", 0.98);
  Photons<N> photons = trace_photons(s.problem, next, s.work, s.counters);
  if (s.work.stopped()) {
    keep(s);
    return false;
  }
  s.photons = std::move(photons);
  return true;
}

/// The round joins those before it.
template <int N>
void end_round_of(const RowState<N>& s, Tally<N>& tally) {
  const double before = &tally == &s.gathered ? weighted_gathered(s) : weighted(s, tally);
  double now = 0.0;
  for (const SideIndex i : s.problem.sides.active)
    now += s.error.weights[i] * tally.variance_now(i);
  tally.end_round(before + now > 0.0 ? before / (before + now) : 0.5);
}

/// Says what the next round has to draw; false if nothing.
template <int N>
bool plan_next_round(RowState<N>& s) {
  const double target = std::pow(kMargin * s.problem.options.error, 2);
  const double caustics = weighted(s, s.result.caustic.variance);
  const bool too_few_photons = caustics > 0.5 * target && !more_photons(s);
  if (s.work.stopped()) return false;
  if (s.gathered.round() == 0) s.brought.end_first_round(s.gathered);
  for (Tally<N>* tally : {&s.direct, &s.gathered, &s.shot})
    if (tally->round() == 0) tally->end_round(1.0);
  s.error.weights = weights_now(s);
  s.error.before = s.error.found;
  const std::vector<Stratum<N>> strata = strata_of(s);
  // Rows and gathered light are estimates of the same.
  const double share = static_cast<double>(s.fresh_share);
  const std::vector<double> so_far{weighted(s, s.direct), share * weighted_gathered(s),
                                   weighted(s, s.shot)};
  double sampled = 0.0;
  for (const double v : so_far) sampled += v;
  if (!(sampled > 0.0)) return false;
  // Photons that there is no memory for are no reason to leave the rest as it is.
  const double for_samples = too_few_photons ? 0.5 * target : target - caustics;
  if (too_few_photons && sampled <= for_samples) return false;
  // What errors of other sides' light pass on becomes less with these.
  const double passed_on = std::max(1.0, (s.error.raw * s.error.raw - caustics) / sampled);
  const double wanted =
      std::max(for_samples / (passed_on * s.error.smoothing_gain), sampled / 256.0);
  const double effort =
      round_effort(s.problem, s.error.weights, s.exposed, strata, so_far, wanted, cost_so_far(s));
  if (!(effort > 0.0)) return false;
  refine_field(s);
  guide_rays(s);
  const auto goals = [&](const Stratum<N>& stratum) {
    return goals_of(plan_round(s.problem, s.error.weights, s.exposed, stratum, effort),
                    *stratum.tally);
  };
  s.goals.direct = goals(strata[0]);
  s.goals.gather = goals(strata[1]);
  s.goals.shot = goals(strata[2]);
  s.stage = Stage::RoundLight;
  return true;
}

}  // namespace

template <int N>
bool finish_round(RowState<N>& s) {
  if (s.stage == Stage::RoundLight) {
    s.work.begin("direct light", 0.98);
    draw_direct(s, missing(s.goals.direct, s.direct));
    draw_hot(s, missing(s.goals.shot, s.shot));
    if (paused(s, Stage::RoundLight)) return false;
    end_round_of(s, s.direct);
    end_round_of(s, s.shot);
    s.stage = Stage::RoundSolve;
  }
  if (s.stage == Stage::RoundSolve) {
    const std::vector<GroupLight<N>> before = s.groups;
    take_direct(s);
    solve_bounces(s);
    if (s.work.stopped()) {
      s.groups = before;
      return !paused(s, Stage::RoundSolve);
    }
  }
  if (s.stage != Stage::RoundDone) {
    s.work.begin("gathering", 0.98);
    draw_gather(s, missing(s.goals.gather, s.gathered));
    if (paused(s, Stage::RoundGather)) return false;
    end_round_of(s, s.gathered);
  }
  assemble(s);
  return !paused(s, Stage::RoundDone);
}

template <int N>
void reach_error(RowState<N>& s) {
  constexpr int kMaxRounds = 32;
  for (; s.round < kMaxRounds; ++s.round) {
    s.result.error_reached = s.result.error_estimate <= s.problem.options.error;
    if (s.result.error_reached || s.work.stopped()) return;
    if (!plan_next_round(s) || !finish_round(s)) break;
  }
  s.result.error_reached = s.result.error_estimate <= s.problem.options.error;
}

#define ATRIUM_INSTANTIATE(N)               \
  template bool finish_round(RowState<N>&); \
  template void reach_error(RowState<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
