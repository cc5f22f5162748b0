#include "make_rows.h"

#include <numeric>

#include "bounces.h"
#include "draws.h"
#include "hot_light.h"
#include "kept_state.h"
#include "view_importance.h"
#include "watching.h"

namespace atrium::radiosity {
namespace {

template <int N>
bool memory_holds(const RowState<N>& s, const std::vector<std::uint8_t>& wanted, int rays) {
  const auto rows = static_cast<std::uint64_t>(std::count(wanted.begin(), wanted.end(), 1));
  return bytes_for_rows<N>(s.rows.bytes(), rows * static_cast<std::uint64_t>(rays)) <=
         s.work.memory().room(MemoryBudget::Part::Rows);
}

}  // namespace

template <int N>
void build_rows(RowState<N>& s) {
  const int all = std::max(1, s.problem.options.row_rays);
  const int first = std::min(kPilot, all);
  const std::size_t n = s.problem.sides.active.size();
  s.work.begin("rows", 0.4);
  take_direct(s);
  if (!s.hot.chosen) choose_hot(s);
  know_hot_light(s, true);
  s.rows = trace_rows<N>(s.problem, s.hot.patches, {}, std::vector<std::uint8_t>(n, 1), 0, first,
                         s.work, s.counters);
  find_buried(s);
  draw_direct_of_mixed(s);
  take_direct(s);
  s.importance = view_importance(s.problem, s.rows, s.counters);
  draw_hot(s);
  solve_bounces(s);
  (void)paused(s, Stage::Rows);
  show_bounces(s, Bounces::Rows);
  if (first == all) {
    guide_rays(s);
    return;
  }
  s.work.begin("rows", 0.6);
  lengthen_rows(s);
  solve_bounces(s);
  guide_rays(s);
  (void)paused(s, Stage::Rows);
  show_bounces(s, Bounces::Rows);
}

template <int N>
void trace_again(RowState<N>& s) {
  const int all = std::max(1, s.problem.options.row_rays);
  for (int from = 0, to = std::min(kPilot, all); from < all;
       from = to, to = std::min(2 * to, all)) {
    std::vector<std::uint8_t> wanted;
    for (const std::uint32_t rays : s.earlier.traced)
      wanted.push_back(static_cast<int>(rays) >= to ? 1 : 0);
    s.rows = trace_rows<N>(s.problem, s.hot.patches, std::move(s.rows), wanted, from, to, s.work,
                           s.counters);
  }
  s.caught_up = !s.work.stopped();
}

template <int N>
void lengthen_rows(RowState<N>& s) {
  const int all = std::max(1, s.problem.options.row_rays);
  for (int from = std::min(kPilot, all), to = 2 * from; from < all; from = to, to *= 2) {
    to = std::min(to, all);
    std::vector<std::uint8_t> wanted(s.rows.size(), 0);
    for (std::size_t k = 0; k < s.rows.size(); ++k) {
      const SideIndex i = s.problem.sides.active[k];
      wanted[k] = s.is_lit(i) &&
                          s.rows.rays[k] + s.rows.dropped[k] == static_cast<unsigned>(from) &&
                          samples_of(s.problem, s.importance, i, all) >= to
                      ? 1
                      : 0;
    }
    if (!memory_holds(s, wanted, to - from)) {
      s.work.memory().give_up("rows of " + std::to_string(from) + " rays instead of " +
                              std::to_string(all));
      break;
    }
    s.rows = trace_rows<N>(s.problem, s.hot.patches, std::move(s.rows), wanted, from, to, s.work,
                           s.counters);
  }
}

template <int N>
void find_buried(RowState<N>& s) {
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    if (s.rows.dropped[k] == 0) continue;
    const std::uint32_t traced = s.rows.rays[k] + s.rows.dropped[k];
    s.exposed[i] = static_cast<float>(s.rows.rays[k]) / static_cast<float>(traced);
    if (s.rows.rays[k] == 0) s.result.valid[i] = 0;
  }
}

template <int N>
void guide_rays(RowState<N>& s) {
  // Rows do not say which of their entries were seen in a mirror, where another place shows them.
  if (s.problem.specular) return;
  std::vector<float> light(s.problem.side_count(), 0.0f);
  for (const GroupLight<N>& g : s.groups) {
    const SideValues<N> b = radiosity_read(s, g);
    for (const SideIndex i : s.problem.sides.active) light[i] += b[i].mean();
  }
  // Squares of what is left are numbers whatever the unit of light.
  const float most = std::accumulate(light.begin(), light.end(), 0.0f,
                                     [](float a, float b) { return std::max(a, b); });
  if (most > 0.0f)
    for (float& b : light) b /= most;
  s.ray_guide = HemisphereGuide(s.problem, s.regions, s.rows, light);
}

#define ATRIUM_INSTANTIATE(N)                \
  template void build_rows(RowState<N>&);    \
  template void trace_again(RowState<N>&);   \
  template void lengthen_rows(RowState<N>&); \
  template void find_buried(RowState<N>&);   \
  template void guide_rays(RowState<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
