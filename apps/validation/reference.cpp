#include "validation/reference.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace atrium::validation::reference {

Polygon clip(const Polygon& in, const Vec3d& normal, double offset) {
  Polygon out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vec3d& a = in[i];
    const Vec3d& b = in[(i + 1) % in.size()];
    const double da = normal.dot(a) + offset, db = normal.dot(b) + offset;
    if (da >= 0.0) out.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0))
      out.push_back(a + da / (da - db) * (b - a));
  }
  return out;
}

double point_factor(const Vec3d& p, const Vec3d& normal, const Polygon& polygon) {
  const Polygon above = clip(polygon, normal, -normal.dot(p));
  double sum = 0.0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    const Vec3d a = (above[i] - p).normalized();
    const Vec3d b = (above[(i + 1) % above.size()] - p).normalized();
    const Vec3d cross = a.cross(b);
    const double sine = cross.norm();
    if (sine > 1e-15) sum += std::atan2(sine, a.dot(b)) * cross.dot(normal) / sine;
  }
  return std::abs(sum) / (2.0 * std::numbers::pi);
}

double corner_parallel(double a, double b) {
  const double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
  return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * std::numbers::pi);
}

double corner_upright(double a, double b) {
  const double x = std::sqrt(1 + a * a);
  return (std::atan(b) - std::atan(b / x) / x) / (2 * std::numbers::pi);
}

double pane_transmittance(double n, double cosine) {
  const double c = cosine, t = std::sqrt(1 - (1 - c * c) / (n * n));
  const double s = std::pow((c - n * t) / (c + n * t), 2),
               p = std::pow((n * c - t) / (n * c + t), 2);
  return 0.5 * ((1 - s) / (1 + s) + (1 - p) / (1 + p));
}

}  // namespace atrium::validation::reference
