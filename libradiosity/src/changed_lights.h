#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Goes on with other lights, perhaps on divided elements. Light straight from them is measured
/// anew, as often as before. Rows stay or are traced again, and samples that were gathered stay
/// where the rows say well enough what has changed for them; so only where the lights that
/// changed matter hemispheres are sampled again.
template <int N>
void relight(RowState<N>& s, const SideParents& parents, const Start& start);

}  // namespace atrium::radiosity
