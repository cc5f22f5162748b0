#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Variance of what rows find, by group and side.
using RowVariances = std::vector<std::vector<double>>;
template <int N>
[[nodiscard]] std::vector<double> row_variances(const RowState<N>& s, const GroupLight<N>& g);
template <int N>
[[nodiscard]] RowVariances row_variances(const RowState<N>& s);

/// What samples that were brought up to date add to the variance of a pooled estimate.
template <int N>
[[nodiscard]] double brought_variance(const RowState<N>& s, SideIndex i, GroupChoice group,
                                      double fresh) {
  return s.brought.variance(i, group.value_or(s.groups.size()), fresh, s.gathered);
}

/// Variances of the means of every group and, if there are several, of the sum of all.
template <int N>
[[nodiscard]] std::vector<Variances> all_variances(const RowState<N>& s, const RowVariances& rows);

/// Of a group's indirect light, by RowState::variances.
template <int N>
[[nodiscard]] std::vector<double> indirect_variances(const RowState<N>& s, std::size_t group) {
  const std::vector<float>& v = s.variances[group].indirect;
  return {v.begin(), v.end()};
}

template <int N>
[[nodiscard]] double row_variance(const RowState<N>& s, const RowVariances& rows, SideIndex i,
                                  GroupChoice group) {
  double sum = 0.0;
  for (std::size_t g = first_of(group); g < s.end_of(group); ++g) sum += rows[g][i];
  return sum;
}

}  // namespace atrium::radiosity
