#include "error_control.h"

#include <algorithm>

namespace atrium::radiosity {

namespace {

/// Mean over a side and its active neighbours.
template <int N, class Value>
double local_mean(const Problem<N>& problem, const Neighbours& neighbours, SideIndex i,
                  Value&& value) {
  double sum = value(i);
  double count = 1.0;
  neighbours.visit(i, [&](SideIndex j) {
    if (problem.sides.is_active[j] == 0) return;
    sum += value(j);
    count += 1.0;
  });
  return sum / count;
}

}  // namespace

template <int N>
std::vector<double> error_weights(const Problem<N>& problem, const SideValues<N>& irradiance,
                                  const std::vector<float>& share) {
  const auto area_of = [&](SideIndex i) {
    return static_cast<double>(problem.area(i)) *
           (share.empty() ? 1.0 : static_cast<double>(share[i]));
  };
  double area = 0.0;
  double flux = 0.0;
  for (const SideIndex i : problem.sides.active) {
    if (irradiance[i].is_zero()) continue;
    area += area_of(i);
    flux += area_of(i) * static_cast<double>(irradiance[i].mean());
  }
  std::vector<double> weights(problem.side_count(), 0.0);
  if (!(flux > 0.0)) return weights;
  const double least = 0.01 * flux / area;
  for (const SideIndex i : problem.sides.active) {
    const double scale = std::max(least, static_cast<double>(irradiance[i].mean()));
    weights[i] = area_of(i) / (area * scale * scale);
  }
  return weights;
}

template <int N>
std::vector<double> sample_variance(const Problem<N>& problem, const Neighbours& neighbours,
                                    const Tally<N>& tally, Samples whose, GroupChoice group) {
  const std::vector<SideIndex>& active = problem.sides.active;
  std::vector<double> value(problem.side_count(), 0.0);
  for (const SideIndex i : active)
    for (std::size_t g = group.value_or(0); g < (group ? *group + 1 : tally.groups()); ++g)
      value[i] += static_cast<double>(tally.mean(i, g).mean());
  std::vector<double> scale(problem.side_count(), 0.0);     // squared
  std::vector<double> own(problem.side_count(), 0.0);
  double all = 0.0;
  double all_scale = 0.0;
  for (const SideIndex i : active) {
    const double mean = local_mean(problem, neighbours, i, [&](SideIndex j) { return value[j]; });
    scale[i] = mean * mean;
    if (tally.valid(i) == 0) scale[i] = 0.0;
    own[i] = (group ? tally.variance(i, *group) : tally.variance(i)) * tally.valid(i);
    all += own[i];
    all_scale += scale[i];
  }
  std::vector<double> result(problem.side_count(), 0.0);
  for (const SideIndex i : active) {
    // A ratio of sums: relative variances of nearly dark sides are wild.
    double sum = 0.0;
    double sum_scale = 0.0;
    const auto take = [&](SideIndex j) {
      sum += own[j];
      sum_scale += scale[j];
    };
    if (whose == Samples::All) take(i);
    neighbours.visit(i, take);
    if (!(sum_scale > 0.0)) {
      sum = all;
      sum_scale = all_scale;
    }
    result[i] = sum_scale > 0.0 ? scale[i] * sum / sum_scale : 0.0;
  }
  return result;
}

template <int N>
std::vector<std::vector<Draw>> plan_samples(const Problem<N>& problem,
                                            const std::vector<double>& weights,
                                            const std::vector<float>& exposed,
                                            const std::vector<Stratum<N>>& strata, double share) {
  constexpr double kGrowth = 4.0;
  constexpr double kFew = 16.0;
  const auto cost = [&](const Stratum<N>& s, SideIndex i) {
    return s.cost / static_cast<double>(exposed[i]);
  };
  // Lagrange: n = lambda sqrt(weight * variance / cost); the sum of weight * variance / n is then
  // root_costs / lambda.
  double root_costs = 0.0;
  double now = 0.0;
  for (const Stratum<N>& s : strata)
    for (const SideIndex i : problem.sides.active) {
      if (weights[i] == 0.0) continue;
      root_costs += std::sqrt(weights[i] * s.variance[i] * cost(s, i));
      if (s.tally->valid(i) > 0) now += weights[i] * s.variance[i] / s.tally->valid(i);
    }
  const double lambda = now > 0.0 ? root_costs / (share * share * now) : 0.0;
  std::vector<std::vector<Draw>> plans(strata.size());
  for (std::size_t c = 0; c < strata.size(); ++c) {
    const Stratum<N>& s = strata[c];
    for (const SideIndex i : problem.sides.active) {
      if (weights[i] == 0.0) continue;
      const double have = s.tally->valid(i);
      const double wanted = std::min(lambda * std::sqrt(weights[i] * s.variance[i] / cost(s, i)),
                                     kGrowth * std::max(have, kFew));
      // Less than a tenth more is not worth it.
      if (!(wanted > 1.1 * have)) continue;
      // Even numbers in each replicate; see HotPatches::kSamplesPerRay.
      const auto more = static_cast<std::uint32_t>(
          std::ceil((wanted - have) / (2.0 * kReplicates * static_cast<double>(exposed[i])))) * 2;
      plans[c].push_back({i, more});
    }
  }
  return plans;
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template std::vector<double> error_weights(const Problem<N>&, const SideValues<N>&,             \
                                             const std::vector<float>&);                         \
  template std::vector<double> sample_variance(const Problem<N>&, const Neighbours&,             \
                                               const Tally<N>&, Samples, GroupChoice);           \
  template std::vector<std::vector<Draw>> plan_samples(const Problem<N>&,                        \
                                                       const std::vector<double>&,               \
                                                       const std::vector<float>&,                \
                                                       const std::vector<Stratum<N>>&, double);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
