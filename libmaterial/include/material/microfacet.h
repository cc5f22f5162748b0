#pragma once

#include <cmath>

#include "material/frame.h"

namespace atrium::material {

/// The paper's facet distribution D(delta) = N(c) exp(-c^2 delta^2), delta the angle between facet
/// and surface normal [rad], normalised so that D cos(delta) integrates to 1 over the hemisphere.
/// Large c is smooth. c in [0, 1e6].  Source: MATERIAL_MODEL 5.1.
class GaussianFacets {
 public:
  explicit GaussianFacets(double c);

  [[nodiscard]] float c() const { return c_; }
  /// D(h) [1/sr] for a unit facet normal in local coordinates; 0 below the surface.
  [[nodiscard]] float density(const Vec3f& h) const;
  /// Facet normal by the truncated Rayleigh density in delta, azimuth uniform (MATERIAL_MODEL 6).
  [[nodiscard]] Vec3f sample(const Vec2f& u) const;
  /// Density of sample() [1/sr].
  [[nodiscard]] float pdf(const Vec3f& h) const;

 private:
  float c_;
  float norm_;  // N(c)
  float q_;     // 1 - exp(-pi^2 c^2 / 4)
};

/// N(c) = 1 / (pi I(c)), to 1e-11 relative for c in [0, 1e6].
[[nodiscard]] double gaussian_facets_norm(double c);

/// Angle between two unit vectors, accurate when they nearly agree.
[[nodiscard]] inline float angle_between(const Vec3f& a, const Vec3f& b) {
  return 2.0f * std::atan2((a - b).norm(), (a + b).norm());
}

/// Geometric attenuation of V-cavities (Torrance & Sparrow 1967); absolute cosines, so that it
/// serves transmission too.
[[nodiscard]] inline float g_vcavity(float nl, float nb, float nh, float lh, float bh) {
  if (!(bh > 0.0f) || !(lh > 0.0f)) return 0.0f;
  return std::min(1.0f, std::min(2.0f * nh * nb / bh, 2.0f * nh * nl / lh));
}

}  // namespace atrium::material
