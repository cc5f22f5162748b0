#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "scene/camera.h"
#include "scene/mesh.h"

namespace atrium::scene {

/// Triangles of the limit surface of cage_mesh.cage, with limit positions and limit normals; local
/// coordinates, as the cage. Without a cage the mesh comes back as it is.
///
/// Rates follow curvature and distance per face, with one rate per shared edge, so neighbours meet
/// without cracks: boundary positions are equal to the last bit. Corners on an infinitely sharp
/// crease appear once per side, with that side's normal. Per-vertex uvs and colours are carried
/// along (interpolated within faces).
///
/// \param max_error  > 0: largest chord error, as a share of the distance to the eye (parallel
/// view:
///                   of the height of the view; none: of the diagonal of the mesh in the world).
///                   Rates stop at 64 per edge, and lower where the mesh would exceed 8 million
///                   triangles.
/// \throws Error for a cage that is none (indices, non-finite points), or without OpenSubdiv.
[[nodiscard]] MeshData tessellate(const MeshData& cage_mesh, double max_error,
                                  const Eigen::Affine3d& to_world,
                                  const std::optional<Camera>& view);

}  // namespace atrium::scene
