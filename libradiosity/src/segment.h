#pragma once

#include "scene/ray_query.h"

namespace atrium::radiosity {

/// The free path between two surface points: leaves the one, ends just before the other.
[[nodiscard]] inline scene::Ray segment(const scene::SurfacePoint& from,
                                        const scene::SurfacePoint& to) {
  constexpr float kBefore = 1.0f - 1e-4f;  // relative, as the rounding of a hit's distance is
  const Vec3f d = to.position - from.position;
  const float distance = d.norm();
  const Vec3f w = d / distance;
  return {scene::offset_origin(from, w), w, 0.0f, distance * kBefore};
}

}  // namespace atrium::radiosity
