#pragma once

#include <vector>

#include "passes.h"
#include "visible_share.h"

namespace atrium::radiosity {

/// One side of a triangle that emits the same everywhere.
template <int N>
struct Emitter {
  Patch patch;
  Spectrum<N> exitance;
  LaneValues<N> received{};  ///< A F [m^2], summed over all sides
};

/// Emissive surfaces for solvers with factors between patches. Empty if one has a textured
/// emission, or if there are too many for the scene's elements: then they are sampled like others.
template <int N>
[[nodiscard]] std::vector<Emitter<N>> find_emitters(const Problem<N>& problem);

/// Is there no light but that of emissive surfaces?
[[nodiscard]] bool only_surfaces_emit(const scene::Scene& scene);

/// Flux balance of what the lights emit, before any of it is reflected: where it goes that no
/// element receives. Of emitters by their factors, if they are all the light there is; what the
/// factors leave is divided as the photons are. Of other lights by photons.
template <int N>
[[nodiscard]] FluxBalance emission_balance(const Problem<N>& problem,
                                           const std::vector<Emitter<N>>& emitters,
                                           const Photons<N>& photons);

}  // namespace atrium::radiosity
