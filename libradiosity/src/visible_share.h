#pragma once

#include <array>

#include "patches.h"

namespace atrium::radiosity {

/// How a pair of patches is sampled: `rays` points of the low-discrepancy sequence of seed and
/// stream.
struct PairSamples {
  std::uint64_t seed;
  std::uint32_t stream;
  int rays;
};

/// Share of the exchange between two patches that arrives: mean transmittance of surfaces and air
/// between their points, weighted with the kernel of the exchange. Exactly 1 where nothing stands
/// between and the air is clear; 0 where no pair of points faces each other.
template <int N>
[[nodiscard]] LaneValues<N> visible_share(const Problem<N>& problem, const Patch& a, const Patch& b,
                                          const PairSamples& samples, scene::Counters& counters);

}  // namespace atrium::radiosity
