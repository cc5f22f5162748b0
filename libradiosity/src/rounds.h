#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Rounds of samples where they count most, until the estimate is below what was asked for.
template <int N>
void reach_error(RowState<N>& s);

/// Draws what is missing to the round. False if stopped; then the result is that of before.
template <int N>
bool finish_round(RowState<N>& s);

}  // namespace atrium::radiosity
