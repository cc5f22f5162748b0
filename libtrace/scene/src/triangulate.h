#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "material/frame.h"

namespace atrium::scene {

/// Cuts a polygon in space into points.size() - 2 triangles of its corners, by clipping ears in the
/// projection along its Newell normal. Concave polygons keep their area; corners may repeat.
///
/// Where the outline crosses itself no cut is right: the least bad corner is taken then.
/// Fewer than three points: nothing. Worst case quadratic in the number of corners.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(
    std::span<const Vec3d> points);

/// Sum of the cross products of the outline around its first point: twice the vector area.
[[nodiscard]] Vec3d newell_vector(std::span<const Vec3d> points);

}  // namespace atrium::scene
