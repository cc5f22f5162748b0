#pragma once

#include "scene/ray_query.h"

namespace atrium::scene {

/// The free path between two surface points. Both ends are off their surfaces by the error of their
/// positions, so neither surface is in the way, nor another one in the same plane.
[[nodiscard]] inline Ray segment(const SurfacePoint& from, const SurfacePoint& to) {
  const Vec3f between = to.position - from.position;
  const float distance = between.norm();
  const Vec3f w = between / distance;
  SurfacePoint seen = to;
  seen.error += 0x1p-20f * distance;  // by which the direction's rounding moves the end
  const Vec3f origin = offset_origin(from, w);
  const Vec3f d = offset_origin(seen, -w) - origin;
  const float length = d.norm();
  if (!(d.dot(w) > 0.0f)) return {origin, w, 0.0f, 0.0f};  // closer than that: nothing between
  return {origin, d / length, 0.0f, length};
}

}  // namespace atrium::scene
