#include "draws.h"

namespace atrium::radiosity {
namespace {

/// The samples so far have read another field: the rows say what the difference makes. So no
/// sample is lost when the field gets better, and none keeps what was wrong with the older one.
template <int N>
void bring_up_to_date(RowState<N>& s, std::size_t group, const SideValues<N>& field) {
  GroupLight<N>& g = s.groups[group];
  if (!g.read.empty()) {
    const SideValues<N> d = s.hot.patches.without_hot(s.minus(field, g.read));
    SideValues<N> b(s.problem.side_count());
    for (const SideIndex i : s.problem.sides.active)
      b[i] = leaving(s.problem.sides, i, d[i], d[i ^ 1U]);
    for (std::size_t k = 0; k < s.rows.size(); ++k) {
      const SideIndex i = s.problem.sides.active[k];
      if (s.rows.rays[k] == 0 || s.gathered.valid(i) == 0) continue;
      const float per_ray = 1.0f / static_cast<float>(s.rows.rays[k]);
      const Spectrum<N> plain = s.rows.apply(k, b, false) * per_ray;
      s.gathered.shift(i, group, plain,
                       s.problem.sides.any_coupled ? s.rows.apply(k, b, true) * per_ray : plain);
    }
  }
  g.read = field;
}

}  // namespace

template <int N>
void draw_direct(RowState<N>& s, const std::vector<Draw>& plan) {
  sample_direct(s.problem, Purpose::Count, DirectLights::All, s.sight_of_lights, s.mixed, plan,
                s.direct, s.work, s.counters);
}

template <int N>
void draw_direct(RowState<N>& s, const std::vector<SideIndex>& sides, int samples) {
  draw_direct(s, top_up(s.problem, s.direct, sides, samples));
}

template <int N>
void draw_direct_of_mixed(RowState<N>& s) {
  std::vector<SideIndex> again;
  for (const SideIndex i : s.problem.sides.active)
    if (s.exposed[i] < 1.0f && s.result.valid[i] != 0 && s.mixed[i] == 0) again.push_back(i);
  for (const SideIndex i : again) {
    s.mixed[i] = 1;
    s.direct.forget(i);
  }
  draw_direct(s, again, s.by_error() ? kPilot : s.problem.options.direct_samples);
}

template <int N>
void draw_hot(RowState<N>& s, const std::vector<Draw>& plan) {
  sample_hot(s.problem, s.hot.patches, s.hot.sight, s.mixed, plan, s.shot, s.work, s.counters);
}

template <int N>
void draw_hot(RowState<N>& s) {
  draw_hot(s, top_up(s.problem, s.shot, s.problem.sides.active,
                     s.by_error() ? kPilot : std::max(kPilot, s.problem.options.gather_rays / 2),
                     s.importance));
}

template <int N>
void draw_gather(RowState<N>& s, const std::vector<Draw>& plan) {
  std::vector<SideValues<N>> field;
  for (std::size_t n = 0; n < s.groups.size(); ++n) {
    const GroupLight<N>& g = s.groups[n];
    field.push_back(g.source);
    for (const SideIndex i : s.problem.sides.active) field.back()[i] += g.seen[i];
    bring_up_to_date(s, n, field.back());
  }
  sample_gather(s.problem, field, s.hot.patches, s.ray_guide, plan, s.gathered, s.work, s.counters);
}

#define ATRIUM_INSTANTIATE(N)                                                  \
  template void draw_direct(RowState<N>&, const std::vector<Draw>&);           \
  template void draw_direct(RowState<N>&, const std::vector<SideIndex>&, int); \
  template void draw_direct_of_mixed(RowState<N>&);                            \
  template void draw_hot(RowState<N>&, const std::vector<Draw>&);              \
  template void draw_hot(RowState<N>&);                                        \
  template void draw_gather(RowState<N>&, const std::vector<Draw>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
