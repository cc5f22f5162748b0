#pragma once

#include <string>

#include "scene/mesh_io.h"

namespace atrium::scene {

/// What the mesh module offers; see ImageIoModule for the conventions.
class MeshIoModule {
 public:
  virtual ~MeshIoModule() = default;
  /// `.vtp` or `.vtu` by the ending of `file`.
  virtual std::string write(const PolygonMesh& mesh, const std::string& file) const = 0;
  virtual std::string summarise(const std::string& file, MeshFileSummary& summary) const = 0;
};

/// Entry point `atrium_mesh_io`: nullptr if the interface version is another.
using MeshIoEntry = const MeshIoModule* (*)(int interface_version);

/// Part of the module: MeshIoModule::summarise().
[[nodiscard]] std::string summarise_with_vtk(const std::string& file, MeshFileSummary& summary);

}  // namespace atrium::scene
