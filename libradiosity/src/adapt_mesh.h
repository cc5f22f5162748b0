#pragma once

#include "error_control.h"
#include "passes.h"

namespace atrium::radiosity {

/// Elements whose size follows the direct light, with what was measured on the way.
template <int N>
struct AdaptedMesh {
  Elements elements;
  Tally<N> direct;     ///< light samples of every side
  double error = 0.0;  ///< RMS of interpolation against measurement over the area, estimated
};

/// Divides elements where interpolation between them misses direct light, largest contributions to
/// the squared error first, and measures the parts, until what is left is below
/// SolveOptions::mesh_error or no element may be divided further. The decision about an element is
/// made from its neighbours' samples and its own; the parts are measured afresh.
///
/// How far interpolation is off is known where elements were divided (what their parts measured
/// against what the whole's level said there); that scales the estimate for the rest, which is
/// from second differences.
template <int N>
[[nodiscard]] AdaptedMesh<N> adapt_mesh(const scene::Shading<N>& shading, Elements elements,
                                        const SolveOptions& options, Work& work,
                                        scene::Counters& counters);

}  // namespace atrium::radiosity
