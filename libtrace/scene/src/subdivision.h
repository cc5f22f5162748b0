#pragma once

#include <optional>

#include "scene/camera.h"
#include "scene/mesh.h"

namespace atrium::scene {

/// Triangles on the limit surface of MeshData::cage, with normals; other arrays are carried along.
///
/// \param cage_mesh  a mesh with a cage.
/// \param max_error  largest distance between limit surface and triangles, as a share of the
///                   distance to the eye (or of the mesh's own diagonal without a view).
/// \param to_world   the place the mesh is seen at; the result stays in local coordinates.
/// \throws Error that names the mesh if the cage is broken.
[[nodiscard]] MeshData tessellate(const MeshData& cage_mesh, double max_error,
                                  const Eigen::Affine3d& to_world,
                                  const std::optional<Camera>& view);

}  // namespace atrium::scene
