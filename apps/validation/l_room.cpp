#include "validation/l_room.h"

#include <array>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "validation/reference.h"

namespace atrium::validation {
namespace {

using reference::Polygon;

/// What the inner corner, the vertical edge at (1, 1), leaves visible from p of a rectangle that
/// lies wholly in one of the arms or in the corner square.
Polygon visible_part(const Vec3d& p, const Polygon& rectangle) {
  Vec3d centre = Vec3d::Zero();
  for (const Vec3d& v : rectangle) centre += v / static_cast<double>(rectangle.size());
  const bool from_x = p.x() > 1.0, from_y = p.y() > 1.0;
  if (!(from_x && centre.y() > 1.0) && !(from_y && centre.x() > 1.0)) return rectangle;
  // The vertical plane through p and the edge; the room's outer corner (0, 0) is on the free side.
  Vec3d normal(p.y() - 1.0, 1.0 - p.x(), 0.0);
  const double offset = -normal.dot(Vec3d(1.0, 1.0, 0.0));
  return offset >= 0.0 ? reference::clip(rectangle, normal, offset)
                       : reference::clip(rectangle, -normal, -offset);
}

Vec3d normal_of(const Polygon& p) { return (p[1] - p[0]).cross(p[2] - p[0]).normalized(); }

/// A_i F(i, j) of two rectangles.
double exchange_area(const Polygon& from, const Polygon& to) {
  constexpr int kPanels = 8;
  constexpr std::array<double, 3> kNode{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const Vec3d u = from[1] - from[0], v = from[3] - from[0];
  const Vec3d normal = normal_of(from), facing = normal_of(to);
  double sum = 0.0;
  for (int i = 0; i < kPanels * 3; ++i)
    for (int j = 0; j < kPanels * 3; ++j) {
      const int across = i / 3, along = j / 3;
      const double s = (across + kNode[static_cast<std::size_t>(i % 3)]) / kPanels;
      const double t = (along + kNode[static_cast<std::size_t>(j % 3)]) / kPanels;
      const Vec3d p = from[0] + s * u + t * v;
      if (facing.dot(p - to[0]) <= 1e-12) continue;
      sum += kWeight[static_cast<std::size_t>(i % 3)] * kWeight[static_cast<std::size_t>(j % 3)] *
             reference::point_factor(p, normal, visible_part(p, to));
    }
  return sum * u.cross(v).norm() / (kPanels * kPanels);
}

Polygon wall(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0}, {x0, y0, 3}, {x1, y1, 3}, {x1, y1, 0}};
}
Polygon flat(double x0, double y0, double x1, double y1, double z) {
  if (z > 0.0) return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

}  // namespace

std::vector<RoomSurface> l_room() {
  return {{"wall 1", {wall(0, 0, 1, 0), wall(1, 0, 3, 0)}},
          {"wall 2", {wall(3, 0, 3, 1)}},
          {"wall 3", {wall(3, 1, 1, 1)}},
          {"wall 4", {wall(1, 1, 1, 3)}},
          {"wall 5", {wall(1, 3, 0, 3)}},
          {"wall 6", {wall(0, 3, 0, 1), wall(0, 1, 0, 0)}},
          {"ceiling", {flat(0, 0, 1, 1, 3), flat(1, 0, 3, 1, 3), flat(0, 1, 1, 3, 3)}},
          {"floor", {flat(0, 0, 1, 1, 0), flat(1, 0, 3, 1, 0), flat(0, 1, 1, 3, 0)}}};
}

Eigen::MatrixXd l_room_factors() {
  const std::vector<RoomSurface> room = l_room();
  const auto n = static_cast<Eigen::Index>(room.size());
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    double area = 0.0;
    for (const Polygon& a : room[static_cast<std::size_t>(i)].rectangles) {
      area += (a[1] - a[0]).cross(a[3] - a[0]).norm();
      for (Eigen::Index j = 0; j < n; ++j)
        for (const Polygon& b : room[static_cast<std::size_t>(j)].rectangles)
          f(i, j) += exchange_area(a, b);
    }
    f.row(i) /= area;
  }
  return f;
}

Eigen::MatrixXd l_room_exchange(double emissivity) {
  const Eigen::MatrixXd f = l_room_factors();
  const Eigen::MatrixXd system =
      Eigen::MatrixXd::Identity(f.rows(), f.cols()) - (1.0 - emissivity) * f;
  return emissivity * emissivity * system.partialPivLu().solve(f);
}

}  // namespace atrium::validation
