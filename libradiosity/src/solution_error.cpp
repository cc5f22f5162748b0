#include "solution_error.h"

#include <array>
#include <cmath>

namespace atrium::radiosity {
namespace {

/// Irradiance by the field that rays read (lane mean).
template <int N>
std::vector<double> field_now(const RowState<N>& s) {
  std::vector<double> irradiance(s.problem.side_count(), 0.0);
  for (const GroupLight<N>& g : s.groups)
    for (const SideIndex i : s.problem.sides.active)
      irradiance[i] += static_cast<double>((g.source[i] + g.bounced[i]).mean());
  return irradiance;
}

/// Variance of each side's total by its own samples; Eq. 8 takes it with the weights of before
/// the last round, which do not know what that found: with its own a side whose samples all
/// missed the light would look certain.
template <int N>
std::vector<double> raw_variance(const RowState<N>& s, const Variances& v) {
  std::vector<double> result(s.problem.side_count(), 0.0);
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    const double share = s.fresh_share_of(i);
    result[i] = static_cast<double>(v.rest[i]) + s.direct.variance(i) + s.shot.variance(i) +
                share * share * s.gathered.variance(i);
  }
  return result;
}

/// The last round knows nothing of what smooths, so its own mean C tells the error of the
/// smoothed mean: the square of their difference is that of the systematic error (with what
/// earlier rounds left) and the variance that C has in it. With a small last round C is noisy;
/// the error is no less than what the noise of all rounds leaves after smoothing.
template <int N>
void state_smoothed_error(RowState<N>& s, const SideValues<N>& found, const Variances& v) {
  const auto fresh = static_cast<double>(s.fresh_share);
  const std::array<std::pair<const Tally<N>*, double>, 3> parts{
      {{&s.direct, 1.0}, {&s.shot, 1.0}, {&s.gathered, fresh}}};
  std::vector<double> difference(s.problem.side_count(), 0.0);
  for (const SideIndex i : s.problem.sides.active) {
    double last = static_cast<double>(found[i].mean());
    for (const auto& [tally, part] : parts) last += part * (tally->last_mean(i) - tally->total(i));
    difference[i] = static_cast<double>(total_plain(s.result, i).mean()) - last;
  }
  double sampled = 0.0;
  double least = 0.0;
  double systematic = 0.0;
  for (const SideIndex i : s.problem.sides.active)
    systematic += s.error.weights[i] * difference[i] * difference[i];
  for (const auto& [tally, part] : parts) {
    std::vector<double> own(s.problem.side_count(), 0.0);
    for (const SideIndex i : s.problem.sides.active) own[i] = tally->last_variance(i);
    const double share = part * tally->last_share();
    sampled += weighted(s, s.result_smoothing->variance(own, share, 0.0));
    systematic -= weighted(s, s.result_smoothing->variance(own, share, -part));
    for (const SideIndex i : s.problem.sides.active) own[i] = tally->variance(i);
    least += weighted(s, s.result_smoothing->variance(own, part, 0.0));
  }
  s.result.error_estimate = std::sqrt(std::max(least, sampled + systematic) + weighted(s, v.rest));
}

}  // namespace

template <int N>
double weighted_gathered(const RowState<N>& s) {
  double sum = weighted(s, s.gathered);
  for (const SideIndex i : s.problem.sides.active)
    sum += s.error.weights[i] * brought_variance(s, i, kAllGroups, 1.0);
  return sum;
}

template <int N>
std::vector<double> weights_now(const RowState<N>& s) {
  std::vector<double> irradiance(s.problem.side_count(), 0.0);
  for (const SideIndex i : s.problem.sides.active)
    irradiance[i] = static_cast<double>(total_plain(s.result, i).mean());
  return error_weights(s.problem, irradiance, s.counting_share());
}

template <int N>
float share_of_fresh(const RowState<N>& s, const RowVariances& row_variances) {
  // Of the first round before there is a result.
  const std::vector<double> weights =
      s.direct.round() > 0 ? s.error.weights
                           : error_weights(s.problem, field_now(s), s.counting_share());
  double rows = 0.0;
  double fresh = 0.0;
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    if (s.gathered.valid(i) == 0) continue;
    rows += weights[i] * row_variance(s, row_variances, i, kAllGroups);
    fresh += weights[i] * (s.gathered.variance(i) + brought_variance(s, i, kAllGroups, 1.0));
  }
  return rows + fresh > 0.0 ? static_cast<float>(rows / (rows + fresh)) : 1.0f;
}

template <int N>
void estimate_error(RowState<N>& s, const SideValues<N>& found) {
  const Variances& v = s.variances.back();
  s.result.indirect.variance = v.indirect;
  s.result.direct.variance = v.direct;
  s.result.caustic.variance = v.caustic;
  if (s.direct.round() == 0) s.error.weights = weights_now(s);
  s.error.raw = std::sqrt(weighted(s, raw_variance(s, v)));
  s.result.error_estimate = s.error.raw;
  if (!s.result_smoothing) return;
  state_smoothed_error(s, found, v);
  if (s.error.raw > 0.0)
    s.error.smoothing_gain =
        std::clamp(std::pow(s.result.error_estimate / s.error.raw, 2), 0.05, 1.0);
}

#define ATRIUM_INSTANTIATE(N)                                             \
  template double weighted_gathered(const RowState<N>&);                  \
  template std::vector<double> weights_now(const RowState<N>&);           \
  template float share_of_fresh(const RowState<N>&, const RowVariances&); \
  template void estimate_error(RowState<N>&, const SideValues<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
