#include "triangulate.h"

#include <cmath>

namespace atrium::scene {
namespace {

/// Twice the signed area of a, b, c.
double area2(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Inside or on the border of a counter-clockwise triangle, its corners excepted.
bool covers(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
  if (p == a || p == b || p == c) return false;
  return area2(a, b, p) >= 0.0 && area2(b, c, p) >= 0.0 && area2(c, a, p) >= 0.0;
}

/// Projection along the polygon's normal, counter-clockwise.
std::vector<Vec2d> project(std::span<const Vec3d> points, const Vec3d& normal) {
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const Eigen::Index i = (drop + 1) % 3;
  const Eigen::Index j = (drop + 2) % 3;
  const double sign = normal[drop] < 0.0 ? -1.0 : 1.0;
  std::vector<Vec2d> out(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3d p = points[k] - points[0];
    out[k] = Vec2d(p[i] * sign, p[j]);
  }
  return out;
}

/// The outline that is left, as a ring of corners.
class Ring {
 public:
  explicit Ring(const std::vector<Vec2d>& points)
      : p_(points), next_(points.size()), previous_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      next_[i] = (i + 1) % points.size();
      previous_[i] = (i + points.size() - 1) % points.size();
    }
  }
  [[nodiscard]] std::size_t next(std::size_t i) const { return next_[i]; }
  [[nodiscard]] std::size_t previous(std::size_t i) const { return previous_[i]; }
  [[nodiscard]] double corner(std::size_t i) const {
    return area2(p_[previous_[i]], p_[i], p_[next_[i]]);
  }
  void remove(std::size_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
  }
  /// Convex, and no concave corner of the ring within: only those can lie inside an ear. When the
  /// work exceeds a bound (only broken outlines of thousands of corners get there), convex will do.
  [[nodiscard]] bool is_ear(std::size_t i) {
    if (!(corner(i) > 0.0)) return false;
    if (tests_ > kMostTests) return true;
    const std::size_t a = previous_[i];
    const std::size_t c = next_[i];
    for (std::size_t k = next_[c]; k != a; k = next_[k]) {
      ++tests_;
      if (corner(k) <= 0.0 && covers(p_[a], p_[i], p_[c], p_[k])) return false;
    }
    return true;
  }

 private:
  static constexpr std::uint64_t kMostTests = 300'000'000;
  const std::vector<Vec2d>& p_;
  std::uint64_t tests_ = 0;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> previous_;
};

/// The next ear from `start` on; without one the first corner without area, then the most convex.
std::size_t choose_corner(Ring& ring, std::size_t start, std::size_t left) {
  std::size_t best = start;
  std::size_t i = start;
  bool found_flat = false;
  for (std::size_t step = 0; step < left; ++step, i = ring.next(i)) {
    if (ring.is_ear(i)) return i;
    const double turn = ring.corner(i);
    if (!found_flat && (turn == 0.0 || turn > ring.corner(best))) best = i;
    found_flat = found_flat || turn == 0.0;
  }
  return best;
}

std::uint32_t index(std::size_t i) { return static_cast<std::uint32_t>(i); }

}  // namespace

Vec3d newell_vector(std::span<const Vec3d> points) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    sum += (points[i] - points[0]).cross(points[i + 1] - points[0]);
  }
  return sum;
}

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3d> points) {
  std::vector<std::array<std::uint32_t, 3>> out;
  if (points.size() < 3) return out;
  if (points.size() == 3) return {{0, 1, 2}};
  const std::vector<Vec2d> flat = project(points, newell_vector(points));
  Ring ring(flat);
  std::size_t at = 1;
  for (std::size_t left = points.size(); left > 3; --left) {
    const std::size_t ear = choose_corner(ring, at, left);
    out.push_back({index(ring.previous(ear)), index(ear), index(ring.next(ear))});
    ring.remove(ear);
    // Skipping one corner spreads the cuts instead of making a fan of needles.
    at = ring.next(ring.next(ear));
  }
  out.push_back({index(ring.previous(at)), index(at), index(ring.next(at))});
  return out;
}

}  // namespace atrium::scene
