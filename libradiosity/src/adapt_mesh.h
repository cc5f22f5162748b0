#pragma once

#include "error_control.h"
#include "passes.h"

namespace atrium::radiosity {

/// Elements whose size follows the direct light.
struct AdaptedMesh {
  Elements elements;
  double error = 0.0;  ///< RMS of interpolation against measurement over the area, estimated
  /// By element: the one of the start that it is or is part of. Empty: none was divided.
  std::vector<std::uint32_t> parent = {};
};

/// The mesh error that options ask for, or the default.
[[nodiscard]] double asked_mesh_error(const SolveOptions& options);

/// Divides elements where interpolation between them misses direct light, largest contributions to
/// the squared error first, and measures the parts, until what is left is below
/// SolveOptions::mesh_error or no element may be divided further. The decision about an element is
/// made from its neighbours' samples and its own; the parts are measured afresh. These samples are
/// not the solution's: an element whose samples are off is more likely to be divided, so of those
/// that are kept the mean is biased.
///
/// How far interpolation is off is measured at places inside the elements by pairs of samples
/// (light_places.h), so structure that is smaller than an element counts, and noise does not. Which
/// elements come first say these and the second differences of their neighbours' light.
template <int N>
[[nodiscard]] AdaptedMesh adapt_mesh(const scene::Shading<N>& shading,
                                     const Surroundings& surroundings, Elements elements,
                                     const SolveOptions& options, Work& work,
                                     scene::Counters& counters);

}  // namespace atrium::radiosity
