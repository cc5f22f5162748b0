#pragma once

#include "variances.h"

namespace atrium::radiosity {

/// Sum of variances by side with the weights of squared errors.
template <int N, class T>
[[nodiscard]] double weighted(const RowState<N>& s, const std::vector<T>& variance) {
  double sum = 0.0;
  for (const SideIndex i : s.problem.sides.active)
    sum += s.error.weights[i] * static_cast<double>(variance[i]);
  return sum;
}
template <int N>
[[nodiscard]] double weighted(const RowState<N>& s, const Tally<N>& tally) {
  double sum = 0.0;
  for (const SideIndex i : s.problem.sides.active) sum += s.error.weights[i] * tally.variance(i);
  return sum;
}
/// Of what was gathered, with what samples that were brought up to date add.
template <int N>
[[nodiscard]] double weighted_gathered(const RowState<N>& s);

/// Weights of squared errors by the irradiance so far.
template <int N>
[[nodiscard]] std::vector<double> weights_now(const RowState<N>& s);

/// One share of fresh rays for all sides, by reciprocal variances: shares by their numbers would
/// depend on what earlier rays found.
template <int N>
[[nodiscard]] float share_of_fresh(const RowState<N>& s, const RowVariances& row_variances);

/// States variances and error of the result.
/// \param found  total irradiance before it was smoothed.
template <int N>
void estimate_error(RowState<N>& s, const SideValues<N>& found);

}  // namespace atrium::radiosity
