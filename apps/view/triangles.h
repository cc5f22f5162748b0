#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// The polygons of a mesh as triangles, which is what is drawn.
struct Triangles {
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< points of the mesh
  std::vector<std::uint32_t> polygon;                 ///< by triangle

  [[nodiscard]] std::size_t size() const { return corners.size(); }
};

/// Convex polygons become the fan whose smallest triangle is largest: corners in the middle of an
/// edge keep their values. Others are cut ear by ear. Polygons with fewer than three corners or
/// without area give none.
/// \param shown  by polygon: is it wanted? Empty: all.
[[nodiscard]] Triangles triangulate(const Mesh& mesh, const std::vector<std::uint8_t>& shown = {});

}  // namespace atrium::view
