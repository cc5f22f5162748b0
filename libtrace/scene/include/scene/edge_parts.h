#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "material/frame.h"

namespace atrium::scene {

/// An edge that no other triangle shares as a whole, between two numbered places.
struct OpenEdge {
  Vec3d a, b;
  std::uint32_t id_a = 0, id_b = 0;
};

/// A part of an open edge between two places that lie next to each other on it.
struct EdgePart {
  std::uint32_t edge = 0;  ///< which of the open edges
  std::uint32_t id_a = 0, id_b = 0;
};

/// Open edges divided where ends of others lie on them (to 1e-5 of their length): at T-junctions
/// the parts of long and short edges are the same, so triangles that meet there can be found by the
/// numbers of two places. In the order of the edges, along each from a to b.
/// \return  nothing if there are too many edges to look (above 100,000).
[[nodiscard]] std::optional<std::vector<EdgePart>> divide_edges(std::span<const OpenEdge> edges);

}  // namespace atrium::scene
