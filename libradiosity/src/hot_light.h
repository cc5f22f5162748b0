#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Which patches are hot, by samples of their own.
template <int N>
void choose_hot(RowState<N>& s);

/// An error in the light of hot patches is one error of everything they light, so they get many
/// more light samples than others before it is used.
/// \param asked_before  sides with more samples got them here.
template <int N>
void know_hot_light(RowState<N>& s, bool asked_before);

/// Relative variance of the whole flux that hot patches reflect first.
template <int N>
[[nodiscard]] double hot_flux_variance(const RowState<N>& s, GroupChoice group = kAllGroups);

/// Lanes of all hot patches.
template <int N>
[[nodiscard]] std::vector<float> hot_reflectance(const RowState<N>& s);

}  // namespace atrium::radiosity
