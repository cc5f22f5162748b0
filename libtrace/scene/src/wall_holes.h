#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace atrium::scene {

/// A rectangle in scene coordinates, corners in order round it, in the plane of a wall or of a
/// missing one. What lies there is not looked at.
struct HoleCandidate {
  std::array<Vec3f, 4> corners;
  bool wall_missing = false;  ///< a face of a bounding box; else a rectangle that coplanar
                              ///< triangles leave free
};

/// Rectangles through which a room may be open, largest first: what the flat walls of the scene
/// leave free within their own bounds, and the faces of the scene's and of large objects' bounding
/// boxes. Panes do not count as walls. Windows that are no rectangles, walls that are not flat and
/// rectangles smaller than a hundredth of the scene's diagonal are not found.
[[nodiscard]] std::vector<HoleCandidate> find_hole_candidates(const Scene& scene);

}  // namespace atrium::scene
