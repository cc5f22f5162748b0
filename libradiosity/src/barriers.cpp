#include "barriers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "material/material.h"
#include "open_edges.h"
#include "polygon.h"
#include "triangle_tree.h"

namespace atrium::radiosity {
namespace {

using Box = Eigen::AlignedBox3f;
using Corners = std::array<Vec3d, 3>;

Corners to_double(const std::array<Vec3f, 3>& c) {
  return {c[0].cast<double>(), c[1].cast<double>(), c[2].cast<double>()};
}

Vec3d unit_normal(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).normalized(); }

bool stops_light(const material::Material& m) {
  const material::MaterialTraits t = material::traits(m);
  return !t.pane && !t.alpha_mask && m.medium == material::Material::Medium::Opaque;
}

/// The part of a line p + s d that lies in a triangle of normal n; empty if first > second.
std::pair<double, double> inside(const Corners& c, const Vec3d& n, const Vec3d& p, const Vec3d& d,
                                 double low, double high) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d inward = n.cross(c[(k + 1) % 3] - c[k]).normalized();
    const double at = (p - c[k]).dot(inward);
    const double slope = d.dot(inward);
    // Along an edge but for rounding: that edge cuts nothing off.
    const double slack = 1e-6 * (c[(k + 1) % 3] - c[k]).norm();
    if (std::abs(slope) < 1e-12) {
      if (at < -slack) return {1.0, 0.0};
      continue;
    }
    const double s = (-slack - at) / slope;
    (slope > 0.0 ? low : high) = slope > 0.0 ? std::max(low, s) : std::min(high, s);
  }
  return {low, high};
}

}  // namespace

std::optional<Barrier> within_triangle(const std::array<Vec3f, 3>& triangle,
                                       const Barrier& barrier) {
  const Corners c = to_double(triangle);
  const Vec3d n = unit_normal(c);
  const Vec3d d = barrier.b - barrier.a;
  double low = 0.0, high = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d inward = n.cross(c[(k + 1) % 3] - c[k]);
    const double at = (barrier.a - c[k]).dot(inward);
    const double slope = d.dot(inward);
    if (slope == 0.0 && at < 0.0) return std::nullopt;
    if (slope > 0.0) low = std::max(low, -at / slope);
    if (slope < 0.0) high = std::min(high, -at / slope);
  }
  if (!(low < high)) return std::nullopt;
  return Barrier{barrier.a + low * d, barrier.a + high * d, barrier.wall, barrier.object};
}

struct BarrierFinder::Impl {
  const scene::Scene& scene;
  TriangleTree triangles{scene, stops_light};
};

BarrierFinder::BarrierFinder(const scene::Scene& scene) : impl_(new Impl{scene}) {}

BarrierFinder::~BarrierFinder() = default;

std::vector<Barrier> BarrierFinder::on(scene::ObjectId object, std::uint32_t triangle,
                                       double reach) const {
  std::vector<Barrier> result;
  const Corners c = to_double(impl_->scene.corners(object, triangle));
  const Vec3d n = unit_normal(c);
  if (!n.allFinite()) return result;
  Eigen::AlignedBox3f box;
  for (const Vec3d& p : c) box.extend(p.cast<float>());
  box.min().array() -= static_cast<float>(reach);
  box.max().array() += static_cast<float>(reach);
  std::vector<std::uint32_t> near = impl_->triangles.meeting(box);
  std::sort(near.begin(), near.end());
  std::vector<Vec3d> part, half;
  const auto lerp = [](const Vec3d& a, const Vec3d& b, double t) { return Vec3d(a + t * (b - a)); };
  for (const std::uint32_t i : near) {
    const TriangleTree::Item& item = impl_->triangles.item(i);
    if (item.object == object && item.triangle == triangle) continue;
    const Corners u = to_double(impl_->scene.corners(item.object, item.triangle));
    const Vec3d m = unit_normal(u);
    if (!m.allFinite() || std::abs(m.dot(n)) > 0.98) continue;
    const auto height = [&](const Vec3d& p) { return (p - c[0]).dot(n); };
    part.assign(u.begin(), u.end());
    clip_polygon(
        part, half, [&](const Vec3d& p) { return reach - height(p); }, lerp);
    clip_polygon(
        half, part, [&](const Vec3d& p) { return reach + height(p); }, lerp);
    if (part.empty()) continue;
    // The line where the planes meet, and how far along it the part near the triangle goes.
    const Vec3d d = n.cross(m).normalized();
    const Vec3d down = m.cross(d);  // in the other triangle, across the line
    const Vec3d p = part[0] - height(part[0]) / down.dot(n) * down;
    double low = 1e300, high = -1e300;
    for (const Vec3d& q : part) {
      low = std::min(low, (q - p).dot(d));
      high = std::max(high, (q - p).dot(d));
    }
    const auto [first, last] = inside(c, n, p, d, low, high);
    if (last > first) result.push_back({p + first * d, p + last * d, true, item.object});
  }
  return result;
}

std::vector<Barrier> BarrierFinder::outlines_above(scene::ObjectId object, std::uint32_t triangle,
                                                   double reach, double length) const {
  constexpr double kParallel = 0.9999;  // within 0.8 degrees
  const std::array<Vec3f, 3> corners = impl_->scene.corners(object, triangle);
  const Corners c = to_double(corners);
  const Vec3d n = unit_normal(c);
  if (!n.allFinite()) return {};
  const auto height = [&](const Vec3d& p) { return (p - c[0]).dot(n); };
  Box box;
  for (const Vec3d& p : c) box.extend(p.cast<float>()).extend((p + reach * n).cast<float>());
  OpenEdges edges;
  for (const std::uint32_t i : impl_->triangles.meeting(box)) {
    const TriangleTree::Item& item = impl_->triangles.item(i);
    const std::array<Vec3f, 3> other = impl_->scene.corners(item.object, item.triangle);
    const Corners u = to_double(other);
    if (!(std::abs(unit_normal(u).dot(n)) > kParallel)) continue;
    const bool above = std::all_of(u.begin(), u.end(), [&](const Vec3d& p) {
      return height(p) > 1e-3 * reach && height(p) < reach;
    });
    if (above) edges.add(item.object, other);
  }
  const std::vector<OpenEdges::Edge> open = edges.list();
  std::set<std::uint32_t> large;
  for (const OpenEdges::Edge& e : open)
    if ((e.b - e.a).norm() > length) large.insert(e.object.value);
  std::vector<Barrier> outlines;
  for (const OpenEdges::Edge& e : open) {
    if (!large.contains(e.object.value)) continue;
    const Barrier edge{e.a - height(e.a) * n, e.b - height(e.b) * n, false, e.object};
    if (const auto part = within_triangle(corners, edge)) outlines.push_back(*part);
  }
  return outlines;
}

}  // namespace atrium::radiosity
