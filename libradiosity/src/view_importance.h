#pragma once

#include <vector>

#include "rows.h"

namespace atrium::radiosity {

/// How much errors of each side matter to pictures of SolveOptions::views, in [1/64, 1], by side:
/// camera rays say what is seen (through panes, mirrors and glass too), one step backwards over the
/// rows what lights that. Sides with at least a tenth of the mean importance per area of what is
/// seen count fully. Empty without views: everything counts.
template <int N>
[[nodiscard]] std::vector<float> view_importance(const Problem<N>& problem, const Rows<N>& rows,
                                                 scene::Counters& counters);

}  // namespace atrium::radiosity
