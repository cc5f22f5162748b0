#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "scene/ray_query.h"

namespace atrium::scene {

/// A triangle of an opening through which a room sees the sky, in scene coordinates.
struct Portal {
  std::array<Vec3f, 3> corners;  ///< counter-clockwise seen from inside
  Eigen::AlignedBox3f room;      ///< holds what sees the opening from inside
};

/// The openings of a scene that has a sky or a sun, for LightSampler: those that its hints name,
/// and (PortalHints::find) the thin panes with the open sky on one side and much less of it on the
/// other. Which side is inside, and what the room is, is found by some hundred rays each;
/// deterministic. Openings without a pane have to be named.
/// \throws Error  for a hint that names an object that is not there.
[[nodiscard]] std::vector<Portal> find_portals(const RayQuery& query);

}  // namespace atrium::scene
