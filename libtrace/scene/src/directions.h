#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "material/frame.h"

namespace atrium::scene {

/// Around +z, uniform in solid angle out to cos_max: density 1 / (2 pi (1 - cos_max)).
[[nodiscard]] inline Vec3f uniform_cone(const Vec2f& u, float cos_max) {
  const float z = 1.0f - u.x() * (1.0f - cos_max);
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float phi = 2.0f * std::numbers::pi_v<float> * u.y();
  return {r * std::cos(phi), r * std::sin(phi), z};
}
[[nodiscard]] inline Vec3f uniform_sphere(const Vec2f& u) { return uniform_cone(u, -1.0f); }

/// Barycentric coordinates of corners 1 and 2, uniform in area.
[[nodiscard]] inline Vec2f uniform_triangle(const Vec2f& u) {
  const float s = std::sqrt(u.x());
  return {s * (1.0f - u.y()), s * u.y()};
}

}  // namespace atrium::scene
