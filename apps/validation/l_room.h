#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "material/frame.h"

namespace atrium::validation {

/// A surface of an enclosure: planar rectangles, corners counter-clockwise from inside.
struct RoomSurface {
  std::string name;
  std::vector<std::vector<Vec3d>> rectangles;
};

/// The L-shaped room of Pinney & Bean, test 4 (BRE; View3D's example of that name): walls 1 to 6,
/// ceiling, floor. Arms of 1 m x 2 m about a corner of 1 m x 1 m, 3 m high.
[[nodiscard]] std::vector<RoomSurface> l_room();

/// F(i, j) of its surfaces. Closed form at a point for the part of each rectangle that the inner
/// corner leaves visible, Gauss quadrature over the other surface. Shares no code with Atrium's
/// factors. Rows sum to 1 within 1e-6.
[[nodiscard]] Eigen::MatrixXd l_room_factors();

/// Share of black-body emission of i that j absorbs, with all reflections; rows sum to the
/// emissivity. Source: Hottel & Sarofim 1967 ("script F"): eps^2 (I - (1 - eps) F)^-1 F.
[[nodiscard]] Eigen::MatrixXd l_room_exchange(double emissivity);

}  // namespace atrium::validation
