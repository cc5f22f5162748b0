#pragma once

#include <optional>
#include <string>

#include "scene/camera.h"
#include "scene/mesh.h"

namespace atrium::scene {

/// What the module of subdivision surfaces offers. Nothing is thrown across the border of the
/// module: an empty result is success, anything else says what went wrong.
class SubdivisionModule {
 public:
  virtual ~SubdivisionModule() = default;

  /// As scene::tessellate(), of a cage whose indices are sound.
  virtual std::string tessellate(const MeshData& cage_mesh, double max_error,
                                 const Eigen::Affine3d& to_world,
                                 const std::optional<Camera>& view, MeshData& mesh) const = 0;
};

/// Entry point `atrium_subdivision`: nullptr if the interface version is another.
using SubdivisionEntry = const SubdivisionModule* (*)(int interface_version);

}  // namespace atrium::scene
