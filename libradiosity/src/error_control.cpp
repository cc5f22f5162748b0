#include "error_control.h"

#include <algorithm>

namespace atrium::radiosity {
namespace {

/// How many samples a region's opinion of one of its sides counts.
constexpr double kOpinion = 32.0;
/// Degrees of freedom that it counts beside a side's own replicates.
constexpr double kPooled = 4.0;

/// Values of sides that few samples were drawn for, nearer to their region's mean by that: what a
/// side's samples all missed its region has seen. \param samples  by side.
template <int N>
std::vector<double> nearer_to_region(const Problem<N>& problem, const Regions& regions,
                                     std::vector<double> values,
                                     const std::vector<double>& samples) {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    double area = 0.0;
    double sum = 0.0;
    for (const SideIndex i : regions.members(r)) {
      const auto a = static_cast<double>(problem.area(i));
      area += a;
      sum += a * values[i];
    }
    if (!(area > 0.0)) continue;
    for (const SideIndex i : regions.members(r))
      values[i] = (samples[i] * values[i] + 4.0 * sum / area) / (samples[i] + 4.0);
  }
  return values;
}

}  // namespace

template <int N>
std::vector<double> error_weights(const Problem<N>& problem, const std::vector<double>& irradiance,
                                  const std::vector<float>& share) {
  const auto area_of = [&](SideIndex i) {
    return static_cast<double>(problem.area(i)) *
           (share.empty() ? 1.0 : static_cast<double>(share[i]));
  };
  double area = 0.0;
  double flux = 0.0;
  for (const SideIndex i : problem.sides.active) {
    if (!(irradiance[i] > 0.0)) continue;
    area += area_of(i);
    flux += area_of(i) * irradiance[i];
  }
  std::vector<double> weights(problem.side_count(), 0.0);
  if (!(flux > 0.0)) return weights;
  const double least = 0.01 * flux / area;
  for (const SideIndex i : problem.sides.active) {
    if (!(irradiance[i] > 0.0)) continue;
    const double scale = std::max(least, irradiance[i]);
    weights[i] = area_of(i) / (area * scale * scale);
  }
  return weights;
}

template <int N>
std::vector<double> mean_variance(const Problem<N>& problem, const Regions& regions,
                                  const Tally<N>& tally, GroupChoice group) {
  constexpr double kOwn = 3.0;
  std::vector<double> result(problem.side_count(), 0.0);
  std::vector<double> value, own, samples;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const auto members = regions.members(r);
    value.assign(members.size(), 0.0);
    own.assign(members.size(), 0.0);
    samples.assign(members.size(), 0.0);
    double variance = 0.0;
    double scale = 0.0;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const SideIndex i = members[m];
      value[m] = total_of(tally, i, group);
      samples[m] = tally.valid(i);
      own[m] = (group ? tally.variance(i, *group) : tally.variance(i)) * samples[m];
      variance += own[m];
      scale += value[m] * value[m];
    }
    const double relative = scale > 0.0 ? variance / scale : 0.0;
    for (std::size_t m = 0; m < members.size(); ++m)
      if (samples[m] > 0.0)
        result[members[m]] = (kOwn * own[m] + kPooled * relative * value[m] * value[m]) /
                             ((kOwn + kPooled) * samples[m]);
  }
  return result;
}

template <int N>
std::vector<double> expected_variance(const Problem<N>& problem, const Regions& regions,
                                      const Tally<N>& tally, const std::vector<double>& strongest) {
  std::vector<double> mean(problem.side_count(), 0.0);
  std::vector<double> samples(problem.side_count(), 0.0);
  for (const SideIndex i : problem.sides.active) {
    mean[i] = tally.total(i);
    samples[i] = tally.valid(i);
  }
  const std::vector<double> scale = nearer_to_region(problem, regions, std::move(mean), samples);
  std::vector<double> result(problem.side_count(), 0.0);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    // Relative to the scale: the bright sides of a region would speak for all otherwise.
    double spread = 0.0;
    double replicated = 0.0;
    double sides = 0.0;
    for (const SideIndex i : regions.members(r)) {
      if (samples[i] < 2.0 || !(scale[i] > 0.0)) continue;
      const double per = 1.0 / (scale[i] * scale[i]);
      spread += per * tally.spread(i);
      replicated += per * tally.variance(i) * samples[i];
      sides += 1.0;
    }
    double drawn = 0.0;
    for (const SideIndex i : regions.members(r)) drawn += samples[i];
    const double missed = strongest[r] * strongest[r] / (drawn + 1.0);
    const double left = spread > 0.0 ? std::clamp(replicated / spread, 0.02, 1.5) : 0.0;
    const double opinion = spread > 0.0 ? spread / sides : 0.0;
    for (const SideIndex i : regions.members(r))
      result[i] = missed +
                  left * (samples[i] * tally.spread(i) + kOpinion * opinion * scale[i] * scale[i]) /
                      (samples[i] + kOpinion);
  }
  return result;
}

namespace {

/// Rays per valid sample.
template <int N>
double cost_of(const Stratum<N>& s, const std::vector<float>& exposed, SideIndex i) {
  return s.cost / static_cast<double>(exposed[i]);
}
template <int N>
bool takes_part(const Stratum<N>& s, const std::vector<float>& exposed, SideIndex i) {
  return exposed[i] > 0.0f && s.tally->valid(i) > 0;
}

}  // namespace

template <int N>
double round_effort(const Problem<N>& problem, const std::vector<double>& weights,
                    const std::vector<float>& exposed, const std::vector<Stratum<N>>& strata,
                    const std::vector<double>& so_far, double squared_error, double most_cost) {
  // With n = effort root(weight variance / cost), both the sum of weight variance / n times the
  // effort and the cost over the effort are this.
  std::vector<double> roots(strata.size(), 0.0);
  double all = 0.0;
  for (std::size_t c = 0; c < strata.size(); ++c) {
    for (const SideIndex i : problem.sides.active)
      if (takes_part(strata[c], exposed, i))
        roots[c] += std::sqrt(weights[i] * strata[c].variance[i] * cost_of(strata[c], exposed, i));
    all += roots[c];
  }
  if (!(all > 0.0)) return 0.0;
  const double most = most_cost / all;
  const auto error_at = [&](double effort) {
    double sum = 0.0;
    for (std::size_t c = 0; c < strata.size(); ++c)
      if (roots[c] > 0.0 && so_far[c] > 0.0) sum += 1.0 / (1.0 / so_far[c] + effort / roots[c]);
    return sum;
  };
  if (!(error_at(most) < squared_error)) return most;
  double low = 0.0;
  double high = most;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (error_at(middle) > squared_error ? low : high) = middle;
  }
  return high;
}

template <int N>
std::vector<Draw> plan_round(const Problem<N>& problem, const std::vector<double>& weights,
                             const std::vector<float>& exposed, const Stratum<N>& stratum,
                             double effort) {
  constexpr double kGrowth = 8.0;
  std::vector<Draw> plan;
  for (const SideIndex i : problem.sides.active) {
    if (!takes_part(stratum, exposed, i)) continue;
    const double wanted =
        std::clamp(
            effort * std::sqrt(weights[i] * stratum.variance[i] / cost_of(stratum, exposed, i)),
            static_cast<double>(kReplicates), kGrowth * stratum.tally->valid(i)) /
        static_cast<double>(exposed[i]);
    plan.push_back({i, static_cast<std::uint32_t>(std::ceil(wanted / kReplicates))});
  }
  return plan;
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template std::vector<double> error_weights(const Problem<N>&, const std::vector<double>&,      \
                                             const std::vector<float>&);                         \
  template std::vector<double> mean_variance(const Problem<N>&, const Regions&, const Tally<N>&, \
                                             GroupChoice);                                       \
  template std::vector<double> expected_variance(const Problem<N>&, const Regions&,              \
                                                 const Tally<N>&, const std::vector<double>&);   \
  template double round_effort(const Problem<N>&, const std::vector<double>&,                    \
                               const std::vector<float>&, const std::vector<Stratum<N>>&,        \
                               const std::vector<double>&, double, double);                      \
  template std::vector<Draw> plan_round(const Problem<N>&, const std::vector<double>&,           \
                                        const std::vector<float>&, const Stratum<N>&, double);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
