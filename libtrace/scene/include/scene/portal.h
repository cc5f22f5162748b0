#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scene/ray_query.h"

namespace atrium::scene {

/// A triangle of an opening through which a room sees the sky, in scene coordinates.
struct Portal {
  std::array<Vec3f, 3> corners;  ///< counter-clockwise seen from inside
  Eigen::AlignedBox3f room;      ///< holds what sees the opening from inside
};

/// An opening as it was found.
struct Opening {
  std::vector<Portal> portals;
  std::string reason;                  ///< why it was taken
  Vec3d center = Vec3d::Zero();        ///< [m], world
  double area = 0.0;                   ///< [m^2]
  double outside = 0.0, inside = 0.0;  ///< share of the half space on either side that is open sky
};

/// The openings of a scene that has a sky or a sun, for LightSampler: those that its hints name,
/// and (PortalHints::find) those that have the open sky on one side and much less of it on the
/// other: flat thin panes; rectangles that coplanar walls leave free and that surfaces rim all
/// round; missing walls of box-like rooms. Which side is inside, and what the room is, is found by
/// some hundred rays each; deterministic. Other openings have to be named. At most 64 are found.
/// \throws Error  for a hint that names an object that is not there.
[[nodiscard]] std::vector<Opening> find_openings(const RayQuery& query);
/// Their portals.
[[nodiscard]] std::vector<Portal> find_portals(const RayQuery& query);

}  // namespace atrium::scene
