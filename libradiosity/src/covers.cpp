#include "covers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <unsupported/Eigen/BVH>

#include "material/material.h"

namespace atrium::radiosity {
namespace {

using Box = Eigen::AlignedBox3f;
using Tree = Eigen::KdBVH<float, 3, std::uint32_t>;

struct Item {
  scene::ObjectId object;
  std::uint32_t triangle;
};

struct Meeting {
  Box box;
  std::vector<std::uint32_t> found;
  bool intersectVolume(const Box& b) const { return b.intersects(box); }
  bool intersectObject(std::uint32_t item) {
    found.push_back(item);
    return false;  // go on
  }
};

bool is_diffuse(const material::Material& m) {
  const material::MaterialTraits t = material::traits(m);
  return (t.diffuse_reflection || t.diffuse_transmission) && !t.alpha_mask;
}

}  // namespace

struct Covers::Impl {
  const scene::Scene* scene;
  std::vector<Item> items;
  Tree tree;
};

Covers::Covers(const scene::Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->scene = &scene;
  std::vector<std::uint32_t> numbers;
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::ObjectId id(o);
    if (!is_diffuse(scene.material_of(id))) continue;
    for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t) {
      Box box;
      for (const Vec3f& c : scene.corners(id, t)) box.extend(c);
      numbers.push_back(static_cast<std::uint32_t>(impl_->items.size()));
      impl_->items.push_back({id, t});
      boxes.push_back(box);
    }
  }
  impl_->tree.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
}

Covers::~Covers() = default;

std::optional<Covers::Cover> Covers::of(const scene::SurfacePoint& point) const {
  const double reach = 2.0 * static_cast<double>(point.error);
  Meeting meeting;
  meeting.box =
      Box(point.position.array() - 2.0f * point.error, point.position.array() + 2.0f * point.error);
  Eigen::BVIntersect(impl_->tree, meeting);
  std::optional<Cover> best;
  const Vec3d p = point.position.cast<double>();
  for (const std::uint32_t i : meeting.found) {
    const Item& item = impl_->items[i];
    if (item.object.value >= point.object.value) continue;
    if (best && item.object.value >= best->object.value) continue;
    const auto c = impl_->scene->corners(item.object, item.triangle);
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

}  // namespace atrium::radiosity
