#include "assembly.h"

#include "bounces.h"
#include "solution_error.h"

namespace atrium::radiosity {
namespace {

/// The pooled estimate of side k: that of the row and that of fresh rays.
template <int N>
void pool(RowState<N>& s, std::size_t k, std::size_t group, const SideValues<N>& b) {
  const SideIndex i = s.problem.sides.active[k];
  GroupLight<N>& g = s.groups[group];
  const float fresh = s.fresh_share_of(i);
  const float share =
      s.rows.rays[k] > 0 ? (1.0f - fresh) / static_cast<float>(s.rows.rays[k]) : 0.0f;
  const auto estimate = [&](bool body) {
    const Spectrum<N> gathered = body ? s.gathered.mean_body(i, group) : s.gathered.mean(i, group);
    return share * (s.rows.apply(k, b, body) + s.rows.hot_sum(k, group, body)) + fresh * gathered +
           s.shot_light(i, group, body);
  };
  g.indirect.plain[i] = estimate(false);
  if (s.problem.sides.coupled[i / 2] != 0) g.indirect.body[i] = estimate(true);
}

template <int N>
void pool(RowState<N>& s, std::size_t group) {
  GroupLight<N>& g = s.groups[group];
  g.indirect = Irradiance<N>(s.problem.side_count(), s.problem.sides.any_coupled);
  const SideValues<N> b = radiosity_read(s, g);
  for (std::size_t k = 0; k < s.rows.size(); ++k) pool(s, k, group, b);
}

template <int N>
void propagate(RowState<N>& s, std::size_t group) {
  GroupLight<N>& g = s.groups[group];
  SideValues<N> difference(s.problem.side_count());
  for (const SideIndex i : s.problem.sides.active)
    difference[i] = exchange(s.problem, g.indirect, i);
  const Smoothing<N> smoothing(s.problem, s.neighbours, difference, indirect_variances(s, group));
  difference = smoothing(difference);
  for (const SideIndex i : s.problem.sides.active) difference[i] -= g.seen[i];
  const SideValues<N> none(s.problem.side_count());
  SideValues<N> change(s.problem.side_count());
  const Iteration more = solve_rows(s.problem, s.rows, difference, none, change, s.work);
  s.result.iteration.iterations += more.iterations;
  change = smoothing(change);
  for (const SideIndex i : s.problem.sides.active) {
    const bool coupled = s.problem.sides.coupled[i / 2] != 0;
    Spectrum<N>& own = coupled ? g.indirect.body[i] : g.indirect.plain[i];
    // Light cannot be negative; where the correction's noise says so, the pooled value stays.
    const Spectrum<N> better = own + change[i];
    if (better.min() < 0.0f) continue;
    if (coupled)
      for (int lane = 0; lane < N; ++lane)
        if (own[lane] > 0.0f) g.indirect.plain[i][lane] *= better[lane] / own[lane];
    own = better;
  }
}

template <int N>
Irradiance<N> smoothed(const RowState<N>& s, const Irradiance<N>& e) {
  if (!s.result_smoothing) return e;
  Irradiance<N> result = e;
  result.plain = (*s.result_smoothing)(e.plain);
  if (!e.body.empty()) result.body = (*s.result_smoothing)(e.body);
  return result;
}

template <int N>
void sum_groups(RowState<N>& s) {
  const auto sum = [&](Irradiance<N> GroupLight<N>::*part, Estimate<N>& into) {
    into.irradiance = smoothed(s, s.groups[0].*part);
    for (std::size_t g = 1; g < s.groups.size(); ++g)
      add(s.problem, smoothed(s, s.groups[g].*part), into.irradiance);
  };
  sum(&GroupLight<N>::direct, s.result.direct);
  sum(&GroupLight<N>::caustic, s.result.caustic);
  sum(&GroupLight<N>::indirect, s.result.indirect);
}

template <int N>
SideValues<N> total_irradiance(const RowState<N>& s) {
  SideValues<N> total(s.problem.side_count());
  for (const SideIndex i : s.problem.sides.active) total[i] = total_plain(s.result, i);
  return total;
}

/// What is no more than noise between neighbours is shared among them. One smoothing for all
/// parts and groups, so that they still add up; what the rounds before the last one found says
/// how much.
template <int N>
void smooth_result(RowState<N>& s) {
  const Variances& v = s.variances.back();
  std::vector<double> variance(s.problem.side_count(), 0.0);
  for (const SideIndex i : s.problem.sides.active)
    variance[i] = static_cast<double>(v.direct[i]) + static_cast<double>(v.indirect[i]) +
                  static_cast<double>(v.caustic[i]);
  s.result_smoothing.emplace(s.problem, s.neighbours, s.error.before, variance);
}

}  // namespace

template <int N>
void assemble(RowState<N>& s) {
  s.iterations_before_assembly = s.result.iteration.iterations;
  const RowVariances row_variances = radiosity::row_variances(s);
  s.fresh_share = share_of_fresh(s, row_variances);
  s.result_smoothing.reset();
  for (std::size_t g = 0; g < s.groups.size(); ++g) pool(s, g);
  s.variances = all_variances(s, row_variances);
  for (std::size_t g = 0; g < s.groups.size(); ++g) propagate(s, g);
  sum_groups(s);
  const SideValues<N> found = total_irradiance(s);
  if (!s.error.before.empty()) {
    smooth_result(s);
    sum_groups(s);
  }
  estimate_error(s, found);
  s.error.found = found;
  if (!s.problem.options.watch) return;
  Solution<N> now = s.result;
  for (std::size_t g = 0; g < s.groups.size() && s.groups.size() > 1; ++g)
    now.groups.push_back(part_of(s, g));
  hand_out(s.problem, std::move(now));
}

template <int N>
GroupEstimate<N> part_of(const RowState<N>& s, std::size_t group) {
  const GroupLight<N>& g = s.groups[group];
  Variances v = s.variances[group];
  for (std::size_t i = 0; i < v.direct.size(); ++i) v.direct[i] += v.caustic[i];
  return {smoothed(s, g.direct), smoothed(s, g.caustic), smoothed(s, g.indirect),
          std::move(v.direct), std::move(v.indirect)};
}

#define ATRIUM_INSTANTIATE(N)           \
  template void assemble(RowState<N>&); \
  template GroupEstimate<N> part_of(const RowState<N>&, std::size_t);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
