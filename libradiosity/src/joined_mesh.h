#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/elements.h"

namespace atrium::radiosity {

/// The pieces of the elements as polygons without cracks: within an object, pieces that meet use
/// the same places, and a place in the middle of a longer edge is a corner of that polygon, too.
/// A point is a place as the polygons see it whose values continue into each other there.
struct JoinedMesh {
  std::vector<std::uint32_t> piece;         ///< by polygon
  std::vector<std::uint32_t> first_corner;  ///< by polygon, and the end
  std::vector<std::uint32_t> point;         ///< by corner
  std::vector<Vec3f> position;              ///< by point, scene coordinates
  [[nodiscard]] std::size_t polygon_count() const { return piece.size(); }
};

struct JoinOptions {
  double crease_angle_deg = 40.0;  ///< between facets; values of sharper edges stay apart
};

/// Values continue within a facet, and into another facet of the object across a shared edge if
/// the triangles there bend by at most the crease angle and have the same shading normal. Facets
/// in one plane do not continue: something parts them. Clumps continue into clumps alone.
/// Pieces narrower than what coordinates resolve vanish.
[[nodiscard]] JoinedMesh join_pieces(const scene::Scene& scene, const Elements& elements,
                                     const JoinOptions& options = {});

/// Barycentric coordinates (of corners 1 and 2) of the point of a triangle's plane below a point.
[[nodiscard]] Vec2f barycentric(const scene::Scene& scene, const ElementPiece& piece,
                                const Vec3f& point);

}  // namespace atrium::radiosity
