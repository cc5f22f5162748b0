#include "radiosity/form_factor.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "polygon.h"

namespace atrium::radiosity {
namespace {

using Polygon = std::vector<Vec3d>;

/// The part of a polygon in front of a plane; the tolerance keeps corners that lie on it.
Polygon in_front(std::span<const Vec3d> polygon, const Vec3d& origin, const Vec3d& normal) {
  const Polygon in(polygon.begin(), polygon.end());
  Polygon out;
  clip_polygon(
      in, out, [&](const Vec3d& v) { return normal.dot(v - origin); },
      [](const Vec3d& a, const Vec3d& b, double t) -> Vec3d { return a + t * (b - a); });
  return out;
}

/// Integral of ln|x - q| over the points q of a segment from a along the unit direction d.
double log_distance_integral(const Vec3d& x, const Vec3d& a, const Vec3d& d, double length) {
  const Vec3d r = x - a;
  const double s = r.dot(d);
  const double h2 = std::max(0.0, r.squaredNorm() - s * s);
  const double h = std::sqrt(h2);
  const auto primitive = [&](double t) {
    const double r2 = t * t + h2;
    const double log_term = r2 > 0.0 ? 0.5 * t * std::log(r2) : 0.0;
    return log_term - t + (h > 0.0 ? h * std::atan(t / h) : 0.0);
  };
  return primitive(length - s) - primitive(-s);
}

struct Node {
  double x, weight;
};

/// Gauss-Legendre with 16 nodes on [0, 1] after x = s^3 (10 - 15 s + 6 s^2), which flattens the
/// x ln x behaviour of the integrand where edges of two polygons meet.
const std::array<Node, 16>& nodes() {
  static const std::array<Node, 16> table = [] {
    constexpr std::array<double, 8> x{0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                      0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                      0.9445750230732326, 0.9894009349916499};
    constexpr std::array<double, 8> w{0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                      0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                      0.0622535239386479, 0.0271524594117541};
    std::array<Node, 16> result{};
    for (std::size_t i = 0; i < 16; ++i) {
      const double s = 0.5 + 0.5 * (i < 8 ? -x[7 - i] : x[i - 8]);
      const double derivative = 30.0 * s * s * (1.0 - s) * (1.0 - s);
      result[i] = {s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
                   0.5 * w[i < 8 ? 7 - i : i - 8] * derivative};
    }
    return result;
  }();
  return table;
}

/// Is nothing of the polygon farther above the plane than the rounding of its corners?
bool lies_in(const Polygon& polygon, const Vec3d& origin, const Vec3d& normal) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vec3d& v) {
    return normal.dot(v - origin) <= 1e-7 * (v - origin).norm();
  });
}

/// Double contour integral of ln r dx . dy over all pairs of edges.
double contour_integral(const Polygon& a, const Polygon& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d edge_a = a[(i + 1) % a.size()] - a[i];
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Vec3d edge_b = b[(j + 1) % b.size()] - b[j];
      const double length = edge_b.norm();
      if (length == 0.0) continue;
      const Vec3d d = edge_b / length;
      const double parallel = edge_a.dot(d);
      if (parallel == 0.0) continue;
      double inner = 0.0;
      for (const Node& n : nodes())
        inner += n.weight * log_distance_integral(a[i] + n.x * edge_a, b[j], d, length);
      sum += inner * parallel;
    }
  }
  return sum;
}

}  // namespace

double point_to_polygon(const Vec3d& p, const Vec3d& normal, std::span<const Vec3d> polygon) {
  const Polygon visible = in_front(polygon, p, normal);
  double sum = 0.0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Vec3d a = visible[i] - p;
    const Vec3d b = visible[(i + 1) % visible.size()] - p;
    const Vec3d gamma = a.cross(b);
    const double sine = gamma.norm();
    if (sine > 0.0) sum += std::atan2(sine, a.dot(b)) * normal.dot(gamma) / sine;
  }
  return std::abs(sum) / (2.0 * std::numbers::pi);
}

double polygon_exchange_area(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  if (a.size() < 3 || b.size() < 3) return 0.0;
  const Vec3d normal_a = polygon_area_vector(a).normalized();
  const Vec3d normal_b = polygon_area_vector(b).normalized();
  const Polygon part_a = in_front(a, b[0], normal_b);
  const Polygon part_b = in_front(b, a[0], normal_a);
  if (lies_in(part_a, b[0], normal_b) || lies_in(part_b, a[0], normal_a)) return 0.0;
  // The kernel's sign: polygons that face each other wind in opposite senses.
  return std::max(0.0, contour_integral(part_a, part_b) / (2.0 * std::numbers::pi));
}

double parallel_rectangles(double a, double b, double c) {
  const double x = a / c;
  const double y = b / c;
  const double x2 = 1.0 + x * x;
  const double y2 = 1.0 + y * y;
  const double sum =
      0.5 * std::log(x2 * y2 / (x2 + y2 - 1.0)) + x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
      y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y);
  return 2.0 * sum / (std::numbers::pi * x * y);
}

double perpendicular_rectangles(double width, double height, double l) {
  const double w = width / l;
  const double h = height / l;
  const double w2 = w * w;
  const double h2 = h * h;
  const double s = h2 + w2;
  const double logs = std::log((1.0 + w2) * (1.0 + h2) / (1.0 + s)) +
                      w2 * std::log(w2 * (1.0 + s) / ((1.0 + w2) * s)) +
                      h2 * std::log(h2 * (1.0 + s) / ((1.0 + h2) * s));
  return (w * std::atan(1.0 / w) + h * std::atan(1.0 / h) -
          std::sqrt(s) * std::atan(1.0 / std::sqrt(s)) + 0.25 * logs) /
         (std::numbers::pi * w);
}

}  // namespace atrium::radiosity
