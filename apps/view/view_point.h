#pragma once

#include <string>
#include <vector>

#include "mesh.h"
#include "scene/camera.h"

namespace atrium::view {

/// From where the mesh is looked at, in world coordinates.
struct ViewPoint {
  std::string name;
  Vec3d eye = Vec3d(0.0, 0.0, 1.0);
  Vec3d target = Vec3d::Zero();  ///< on the axis; orbits go round it
  Vec3d up = Vec3d::UnitY();
  double yfov_deg = 50.0;  ///< vertical field of view
  bool parallel = false;
  double height = 2.0;  ///< of the picture [m], if parallel
};

/// A camera of a scene. Panoramas become views of 90 degrees.
/// \param origin  world position of the scene's coordinates. \param distance  [m] of the target.
[[nodiscard]] ViewPoint view_of(const scene::Camera& camera, const Vec3d& origin, double distance);

/// From the front, the right and above, everything in view; y is up.
[[nodiscard]] ViewPoint overview(const Mesh& mesh, double aspect);
/// The plan: from straight above, parallel, -z up.
[[nodiscard]] ViewPoint plan(const Mesh& mesh, double aspect);

/// "x,y,z:tx,ty,tz[:ux,uy,uz][:FOV]": eye, target, up, vertical field of view in degrees; else a
/// name or number of the list. Empty: the first.
/// \throws Error  that lists the names.
[[nodiscard]] ViewPoint choose_view(const std::string& text, const std::vector<ViewPoint>& known);

}  // namespace atrium::view
