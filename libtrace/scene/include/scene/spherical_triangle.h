#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "material/frame.h"

namespace atrium::scene {

/// A triangle seen from a point, for sampling uniformly in solid angle: the estimate of irradiance
/// stays bounded however close the point is, where sampling by area has 1/d^2 in it.
/// Source: Arvo 1995, Stratified Sampling of Spherical Triangles.
class SphericalTriangle {
 public:
  template <class Scalar>
  SphericalTriangle(const std::array<Eigen::Matrix<Scalar, 3, 1>, 3>& corners,
                    const Eigen::Matrix<Scalar, 3, 1>& p) {
    for (std::size_t i = 0; i < 3; ++i)
      v_[i] = (corners[i] - p).template cast<double>().normalized();
    const double triple = std::abs(v_[0].dot(v_[1].cross(v_[2])));
    const double denominator = 1.0 + v_[0].dot(v_[1]) + v_[1].dot(v_[2]) + v_[2].dot(v_[0]);
    solid_angle_ = 2.0 * std::atan2(triple, denominator);  // Van Oosterom & Strackee 1983
  }

  /// [sr]; NaN or 0 where the point touches or is in the plane of the triangle.
  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  /// Large enough for sample() to be accurate and small enough to be a triangle at all; outside,
  /// sampling by area is as good.
  [[nodiscard]] bool usable() const { return solid_angle_ > 1e-4 && solid_angle_ < 6.2831; }

  /// Unit direction with density 1 / solid_angle(). Only if usable().
  [[nodiscard]] Vec3d sample(const Vec2f& u) const {
    const Vec3d &a = v_[0], &b = v_[1], &c = v_[2];
    const Vec3d ab = a.cross(b).normalized(), ac = a.cross(c).normalized();
    // The angle alpha at a, accurate where it is small or near pi.
    const double less = (ab - ac).norm(), more = (ab + ac).norm();
    const double cos_alpha = 0.25 * (more * more - less * less), sin_alpha = 0.5 * less * more;
    // The sub-triangle a, b, c' whose area is the share u.x of the whole: c' on the edge a-c.
    // phi = area + pi - alpha.
    const double area = static_cast<double>(u.x()) * solid_angle_;
    const double cos_area = std::cos(area), sin_area = std::sin(area);
    const double cos_phi = -(cos_area * cos_alpha + sin_area * sin_alpha);
    const double sin_phi = cos_area * sin_alpha - sin_area * cos_alpha;
    const double k1 = cos_phi + cos_alpha;
    const double k2 = sin_phi - sin_alpha * a.dot(b);
    const double numerator = k2 + (k2 * cos_phi - k1 * sin_phi) * cos_alpha;
    const double denominator = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
    const double q = denominator != 0.0 ? std::clamp(numerator / denominator, -1.0, 1.0) : 1.0;
    const Vec3d c2 = q * a + std::sqrt(std::max(0.0, 1.0 - q * q)) * away(c, a);
    const double z = 1.0 - static_cast<double>(u.y()) * (1.0 - c2.dot(b));
    return z * b + std::sqrt(std::max(0.0, 1.0 - z * z)) * away(c2, b);
  }

 private:
  // Unit component of x perpendicular to y.
  static Vec3d away(const Vec3d& x, const Vec3d& y) {
    const Vec3d d = x - x.dot(y) * y;
    const double n = d.norm();
    return n > 0.0 ? Vec3d(d / n) : Vec3d::Zero();
  }
  std::array<Vec3d, 3> v_;
  double solid_angle_ = 0.0;
};

}  // namespace atrium::scene
