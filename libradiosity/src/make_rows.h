#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// A first round of rays for every side; more where it found light. A side that sees only dark
/// or no surfaces with all of its first rays keeps those.
template <int N>
void build_rows(RowState<N>& s);

/// The same rays as the earlier solver's, in the same rounds.
template <int N>
void trace_again(RowState<N>& s);

/// In rounds, as far as there is memory, the rows of sides that the rays so far found lit.
template <int N>
void lengthen_rows(RowState<N>& s);

/// Points inside closed bodies receive nothing; means are over the others. Where a side has both,
/// every point's samples have to ask which it is.
template <int N>
void find_buried(RowState<N>& s);

/// From now on rays go where the rows and the best field so far say that light comes from.
template <int N>
void guide_rays(RowState<N>& s);

}  // namespace atrium::radiosity
