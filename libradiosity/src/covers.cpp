#include "covers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "material/material.h"
#include "open_edges.h"
#include "triangle_tree.h"

namespace atrium::radiosity {
namespace {

bool is_diffuse(const material::Material& m) {
  const material::MaterialTraits t = material::traits(m);
  return (t.diffuse_reflection || t.diffuse_transmission) && !t.alpha_mask;
}

}  // namespace

struct Covers::Impl {
  const scene::Scene& scene;
  TriangleTree triangles{scene, is_diffuse};
};

Covers::Covers(const scene::Scene& scene) : impl_(new Impl{scene}) {}

Covers::~Covers() = default;

std::optional<Covers::Cover> Covers::of(const scene::SurfacePoint& point) const {
  const double reach = 2.0 * static_cast<double>(point.error);
  const Eigen::AlignedBox3f box(point.position.array() - 2.0f * point.error,
                                point.position.array() + 2.0f * point.error);
  std::optional<Cover> best;
  const Vec3d p = point.position.cast<double>();
  for (const std::uint32_t i : impl_->triangles.meeting(box)) {
    const TriangleTree::Item& item = impl_->triangles.item(i);
    if (item.object.value >= point.object.value) continue;
    if (best && item.object.value >= best->object.value) continue;
    const auto c = impl_->scene.corners(item.object, item.triangle);
    const std::array<Vec3d, 3> v{c[0].cast<double>(), c[1].cast<double>(), c[2].cast<double>()};
    const Vec3d n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    const double cosine = n.dot(point.ng.cast<double>());
    if (!(std::abs(cosine) > 1.0 - 1e-6) || std::abs((p - v[0]).dot(n)) > reach) continue;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && n.cross(v[(k + 1) % 3] - v[k]).dot(p - v[k]) >= 0.0;
    if (inside) best = Cover{item.object, item.triangle, cosine < 0.0};
  }
  return best;
}

std::vector<Barrier> Covers::outlines_on(scene::ObjectId object, std::uint32_t triangle) const {
  const scene::SurfacePoint point =
      scene::surface_point(impl_->scene, object, triangle, 1.0f / 3, 1.0f / 3);
  const auto corners = impl_->scene.corners(object, triangle);
  std::array<Vec3d, 3> c;
  Eigen::AlignedBox3f box;
  for (std::size_t k = 0; k < 3; ++k) {
    c[k] = corners[k].cast<double>();
    box.extend(corners[k]);
  }
  const double reach = 2.0 * static_cast<double>(point.error);
  box.min().array() -= 2.0f * point.error;
  box.max().array() += 2.0f * point.error;
  const Vec3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  if (!n.allFinite()) return {};
  OpenEdges edges;
  for (const std::uint32_t i : impl_->triangles.meeting(box)) {
    const TriangleTree::Item& item = impl_->triangles.item(i);
    if (item.object.value >= object.value) continue;
    const auto other = impl_->scene.corners(item.object, item.triangle);
    const bool in_plane = std::all_of(other.begin(), other.end(), [&](const Vec3f& p) {
      return std::abs((p.cast<double>() - c[0]).dot(n)) <= reach;
    });
    if (in_plane) edges.add(item.object, other);
  }
  std::vector<Barrier> outlines;
  for (const OpenEdges::Edge& e : edges.list())
    if (const auto part = within_triangle(corners, {e.a, e.b, false, e.object}))
      outlines.push_back(*part);
  return outlines;
}

}  // namespace atrium::radiosity
