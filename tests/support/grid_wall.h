#pragma once

#include <cstdint>

#include "scene/mesh_io.h"

namespace atrium::test {

/// Adds a wall from `corner` along u and v, cut into nu x nv quadrilaterals whose fronts look along
/// u x v: points and polygons row by row, u first.
inline void add_grid_wall(scene::PolygonMesh& mesh, const Vec3d& corner, const Vec3d& u,
                          const Vec3d& v, int nu, int nv) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.points.push_back(corner + u * i / nu + v * j / nv);
  const auto at = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(j * (nu + 1) + i);
  };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      for (const std::uint32_t p : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)})
        mesh.polygon_points.push_back(p);
      mesh.polygon_sizes.push_back(4);
    }
}

}  // namespace atrium::test
