#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Fresh rays against the smoothed solution, pooled with the rows' own estimate against it; what
/// that changes is propagated through the rows once more, as a smooth field again. Then the result
/// and its error are stated.
template <int N>
void assemble(RowState<N>& s);

/// A group's part, for whoever dims the lights later.
template <int N>
[[nodiscard]] GroupEstimate<N> part_of(const RowState<N>& s, std::size_t group);

}  // namespace atrium::radiosity
