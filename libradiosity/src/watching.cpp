#include "watching.h"

#include "bounces.h"

namespace atrium::radiosity {
namespace {

template <int N>
Irradiance<N> bounces(const RowState<N>& s, const GroupLight<N>& g, Bounces known,
                      const Solution<N>& lit) {
  SideValues<N> unshot(s.problem.side_count());
  for (const SideIndex i : s.problem.sides.active)
    unshot[i] = leaving(s.problem.sides, i, g.source[i], g.source[i ^ 1U]);
  const Spectrum<N> ambient = ambient_irradiance(s.problem, lit, unshot);
  Irradiance<N> result(s.problem.side_count(), s.problem.sides.any_coupled);
  for (const SideIndex i : s.problem.sides.active) {
    if (known == Bounces::Rows)
      result.plain[i] = g.seen[i];
    else if (!total_plain(lit, i).is_zero())
      result.plain[i] = ambient;
  }
  if (s.problem.sides.any_coupled) result.body = result.plain;
  return result;
}

}  // namespace

template <int N>
void show_direct(RowState<N>& s) {
  if (!s.problem.options.watch) return;
  s.photons.caustic.resize(s.groups.size(),
                           Estimate<N>(s.problem.side_count(), s.problem.sides.any_coupled));
  take_direct(s);
  show_bounces(s, Bounces::Ambient);
}

template <int N>
void show_bounces(const RowState<N>& s, Bounces known) {
  if (!s.problem.options.watch) return;
  Solution<N> now = s.result;
  for (const GroupLight<N>& g : s.groups) {
    add(s.problem, g.direct, now.direct.irradiance);
    add(s.problem, g.caustic, now.caustic.irradiance);
  }
  const Solution<N> lit = now;
  for (const GroupLight<N>& g : s.groups) {
    GroupEstimate<N> e{g.direct, g.caustic, bounces(s, g, known, lit),
                       std::vector<float>(s.problem.side_count()),
                       std::vector<float>(s.problem.side_count())};
    add(s.problem, e.indirect, now.indirect.irradiance);
    if (s.groups.size() > 1) now.groups.push_back(std::move(e));
  }
  hand_out(s.problem, std::move(now));
}

#define ATRIUM_INSTANTIATE(N)              \
  template void show_direct(RowState<N>&); \
  template void show_bounces(const RowState<N>&, Bounces);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
