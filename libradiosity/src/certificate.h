#pragma once

#include "problem.h"

namespace atrium::radiosity {

/// \param claimed  error that the solution claims: the target where the options have none.
/// Nothing is measured if the work was stopped.
template <int N>
[[nodiscard]] Certificate make_certificate(const Problem<N>& problem,
                                           const scene::SurfaceField& field, double claimed,
                                           Work& work, scene::Counters& counters);

}  // namespace atrium::radiosity
