#include "bounces.h"

#include "variances.h"

namespace atrium::radiosity {
namespace {

template <int N>
void smooth(const RowState<N>& s, GroupLight<N>& g, const std::vector<double>& variance) {
  g.smoothing = Smoothing<N>(s.problem, s.neighbours, g.bounced, variance);
  g.seen = (*g.smoothing)(g.bounced);
}

/// First light of hot patches, by samples of them and by what the rows' rays found by chance.
template <int N>
SideValues<N> shot_of(const RowState<N>& s, std::size_t group) {
  SideValues<N> shot(s.problem.side_count());
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    const bool body = s.problem.sides.coupled[i / 2] != 0;
    shot[i] = s.shot_light(i, group, body);
    if (s.rows.rays[k] > 0)
      shot[i] += s.rows.hot_sum(k, group, body) / static_cast<float>(s.rows.rays[k]);
  }
  return shot;
}

}  // namespace

template <int N>
void take_direct(RowState<N>& s) {
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    GroupLight<N>& light = s.groups[g];
    light.direct = Irradiance<N>(s.problem.side_count(), s.problem.sides.any_coupled);
    light.caustic = s.photons.caustic[g].irradiance;
    light.source.assign(s.problem.side_count(), {});
    for (const SideIndex i : s.problem.sides.active) {
      const float exposed = s.exposed[i] > 0.0f ? 1.0f / s.exposed[i] : 0.0f;
      light.direct.plain[i] = s.direct.mean(i, g);
      light.caustic.plain[i] *= exposed;
      if (s.problem.sides.any_coupled) {
        light.direct.body[i] = s.direct.mean_body(i, g);
        light.caustic.body[i] *= exposed;
      }
      light.source[i] =
          exchange(s.problem, light.direct, i) + exchange(s.problem, light.caustic, i);
    }
  }
}

template <int N>
void solve_bounces(RowState<N>& s) {
  Iteration slowest;
  for (std::size_t n = 0; n < s.groups.size(); ++n) {
    GroupLight<N>& g = s.groups[n];
    SideValues<N> shot = shot_of(s, n);
    const SideValues<N> source = s.hot.patches.without_hot(g.source);
    if (!g.refined) {
      g.bounced.resize(s.problem.side_count());
      const Iteration it = solve_rows(s.problem, s.rows, source, shot, g.bounced, s.work);
      if (it.iterations >= slowest.iterations) slowest = it;
      smooth(s, g, row_variances(s, g));
    } else {
      SideValues<N> change(s.problem.side_count());
      const Iteration it = solve_rows(s.problem, s.rows, s.minus(source, g.solved_source),
                                      s.minus(shot, g.solved_shot), change, s.work);
      if (it.iterations >= slowest.iterations) slowest = it;
      change = (*g.smoothing)(change);
      for (const SideIndex i : s.problem.sides.active) {
        g.bounced[i] += change[i];
        g.seen[i] += change[i];
      }
    }
    g.solved_source = source;
    g.solved_shot = std::move(shot);
  }
  slowest.iterations += s.result.iteration.iterations;
  s.result.iteration = slowest;
  s.iterations_before_assembly = slowest.iterations;
}

template <int N>
void refine_field(RowState<N>& s) {
  s.iterations_before_assembly = s.result.iteration.iterations;
  for (std::size_t n = 0; n < s.groups.size(); ++n) {
    GroupLight<N>& g = s.groups[n];
    for (const SideIndex i : s.problem.sides.active)
      g.bounced[i] = exchange(s.problem, g.indirect, i);
    smooth(s, g, indirect_variances(s, n));
    g.refined = true;
  }
}

template <int N>
SideValues<N> radiosity_read(const RowState<N>& s, const GroupLight<N>& g) {
  const SideValues<N> source = s.hot.patches.without_hot(g.source);
  SideValues<N> b(s.problem.side_count());
  for (const SideIndex i : s.problem.sides.active)
    b[i] = leaving(s.problem.sides, i, source[i] + g.seen[i], source[i ^ 1U] + g.seen[i ^ 1U]);
  return b;
}

#define ATRIUM_INSTANTIATE(N)                \
  template void take_direct(RowState<N>&);   \
  template void solve_bounces(RowState<N>&); \
  template void refine_field(RowState<N>&);  \
  template SideValues<N> radiosity_read(const RowState<N>&, const GroupLight<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
