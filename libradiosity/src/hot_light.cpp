#include "hot_light.h"

#include <cmath>

#include "bounces.h"
#include "draws.h"
#include "kept_state.h"

namespace atrium::radiosity {
namespace {

template <int N>
std::vector<SideValues<N>> sources(const RowState<N>& s) {
  std::vector<SideValues<N>> all;
  for (const GroupLight<N>& g : s.groups) all.push_back(g.source);
  return all;
}

}  // namespace

template <int N>
void choose_hot(RowState<N>& s) {
  constexpr int kFew = 8;
  Tally<N> pilot = s.no_samples();
  if (!sample_direct(s.problem, Purpose::Decide, DirectLights::All, {}, {},
                     top_up(s.problem, pilot, s.problem.sides.active, kFew), pilot, s.work,
                     s.counters)) {
    (void)paused(s, Stage::Rows);
    return;
  }
  std::vector<SideValues<N>> source;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    source.emplace_back(s.problem.side_count());
    for (const SideIndex i : s.problem.sides.active)
      source[g][i] =
          (s.problem.sides.coupled[i / 2] != 0 ? pilot.mean_body(i, g) : pilot.mean(i, g)) +
          exchange(s.problem, s.groups[g].caustic, i);
  }
  s.hot.patches = HotPatches<N>(s.problem, s.regions, std::move(source));
  s.hot.sight = {};
  if (!s.hot.patches.empty())
    s.hot.sight = sight_of_hot(s.problem, s.regions, s.hot.patches, s.counters);
  s.hot.chosen = true;
}

template <int N>
void know_hot_light(RowState<N>& s, bool asked_before) {
  constexpr int kFirst = 256;
  constexpr int kMost = 65536;
  if (s.hot.patches.empty() || s.hot.light_known) return;
  const double allowed = s.by_error() ? std::pow(0.25 * s.problem.options.error, 2) : 1.0;
  for (int samples = kFirst; samples <= kMost && !s.work.stopped(); samples *= 2) {
    const auto until = static_cast<std::uint32_t>((2 * samples - kFirst) / kReplicates);
    std::vector<Goal> goals;
    bool beyond = false;  // then this was not enough when it was asked before
    for (const SideIndex i : s.hot.patches.sides()) {
      goals.push_back({i, until});
      beyond = beyond || (asked_before && s.direct.drawn(i) > until);
    }
    draw_direct(s, missing(goals, s.direct));
    take_direct(s);
    s.hot.patches.set_source(sources(s));
    if (!beyond && hot_flux_variance(s) <= allowed) break;
  }
  s.hot.light_known = !s.work.stopped();
}

template <int N>
double hot_flux_variance(const RowState<N>& s, GroupChoice group) {
  double flux = 0.0;
  double variance = 0.0;
  for (const SideIndex i : s.hot.patches.sides()) {
    const double scale = static_cast<double>(s.problem.area(i)) *
                         static_cast<double>(s.problem.sides.reflectance[i].mean());
    double direct = 0.0;
    for (std::size_t g = first_of(group); g < s.end_of(group); ++g)
      direct += static_cast<double>(s.hot.patches.source(i, g).mean());
    flux += scale * direct;
    variance += scale * scale * (group ? s.direct.variance(i, *group) : s.direct.variance(i));
  }
  return flux > 0.0 ? variance / (flux * flux) : 0.0;
}

template <int N>
std::vector<float> hot_reflectance(const RowState<N>& s) {
  std::vector<float> all;
  for (const SideIndex i : s.hot.patches.sides()) {
    const Spectrum<N>& rho = s.problem.sides.reflectance[i];
    all.insert(all.end(), rho.lane.begin(), rho.lane.end());
  }
  return all;
}

#define ATRIUM_INSTANTIATE(N)                                         \
  template void choose_hot(RowState<N>&);                             \
  template void know_hot_light(RowState<N>&, bool);                   \
  template double hot_flux_variance(const RowState<N>&, GroupChoice); \
  template std::vector<float> hot_reflectance(const RowState<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
