#pragma once

#include <array>
#include <cstddef>

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

/// A F [m^2] with what stands between, by points alone: for patches of very many pieces (a bush is
/// one element), whose exact factors would take the product of their numbers of pieces.
template <int N>
[[nodiscard]] LaneValues<N> sampled_exchange_area(const Problem<N>& problem, const Patch& a,
                                                  const Patch& b, const PairSamples& samples,
                                                  scene::Counters& counters);
[[nodiscard]] inline bool has_many_pieces(const Patch& a, const Patch& b) {
  constexpr std::size_t kMostPairs = 64;
  return a.polygons.size() * b.polygons.size() > kMostPairs;
}

}  // namespace atrium::radiosity
