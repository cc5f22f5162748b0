#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// What the lights' samples say so far becomes the source of every group.
template <int N>
void take_direct(RowState<N>& s);

/// The rows' answer to the sources; later only what their changes add to the field that samples
/// made better in between.
template <int N>
void solve_bounces(RowState<N>& s);

/// What samples found is a better field than the rows' for the next samples to read.
template <int N>
void refine_field(RowState<N>& s);

/// What the rows' entries read.
template <int N>
[[nodiscard]] SideValues<N> radiosity_read(const RowState<N>& s, const GroupLight<N>& g);

}  // namespace atrium::radiosity
