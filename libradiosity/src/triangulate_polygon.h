#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "material/frame.h"

namespace atrium::radiosity {

/// Appends triangles (numbers of corners) of a convex polygon whose corners may lie in the middle
/// of its edges. No triangle is without area unless the polygon is; ears with large angles go
/// first. Keeps the winding.
void triangulate_polygon(std::span<const Vec3f> corners,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace atrium::radiosity
