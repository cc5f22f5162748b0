#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace atrium {

template <class Real>
using Vec2 = Eigen::Matrix<Real, 2, 1>;
template <class Real>
using Vec3 = Eigen::Matrix<Real, 3, 1>;

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;

/// Orthonormal frame with z = the normal. Local directions have z as their cosine.
struct Frame {
  Vec3f x, y, z;

  /// Branch-free basis around a unit normal. Source: Duff et al. 2017 (JCGT 6(1)).
  explicit Frame(const Vec3f& n) : z(n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z());
    const float b = n.x() * n.y() * a;
    x = Vec3f(1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
    y = Vec3f(b, sign + n.y() * n.y() * a, -n.y());
  }
  [[nodiscard]] Vec3f to_local(const Vec3f& v) const { return {v.dot(x), v.dot(y), v.dot(z)}; }
  [[nodiscard]] Vec3f to_world(const Vec3f& v) const { return x * v.x() + y * v.y() + z * v.z(); }
};

/// Cosine-weighted direction on the upper hemisphere, z up; density cos/pi [1/sr].
/// \param u  in [0, 1)^2. Concentric map, Shirley & Chiu 1997.
[[nodiscard]] Vec3f sample_cosine_hemisphere(const Vec2f& u);

inline Vec3f sample_cosine_hemisphere(const Vec2f& u) {
  const float ox = 2.0f * u.x() - 1.0f;
  const float oy = 2.0f * u.y() - 1.0f;
  const bool wide = std::abs(ox) > std::abs(oy);
  const float r = wide ? ox : oy;
  if (r == 0.0f) return {0.0f, 0.0f, 1.0f};
  constexpr float quarter_pi = 0.785398163397448f;
  const float phi = quarter_pi * ((wide ? oy : ox) / r);
  // Taylor series within [-pi/4, pi/4], to the last digit of a float: libm takes thrice as long.
  const float p = phi * phi;
  const float sine =
      phi * (1.0f + p * (-1.0f / 6 + p * (1.0f / 120 + p * (-1.0f / 5040 + p * (1.0f / 362880)))));
  const float cosine =
      1.0f +
      p * (-0.5f + p * (1.0f / 24 + p * (-1.0f / 720 + p * (1.0f / 40320 - p * (1.0f / 3628800)))));
  return {r * (wide ? cosine : sine), r * (wide ? sine : cosine),
          std::sqrt((1.0f - r) * (1.0f + r))};
}

}  // namespace atrium
