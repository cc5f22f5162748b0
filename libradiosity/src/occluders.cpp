#include "occluders.h"

#include <algorithm>

#include "polygon.h"

namespace atrium::radiosity {
namespace {

/// Is the triangle behind, or in the plane of, every piece of the patch?
bool is_behind(const std::array<Vec3d, 3>& triangle, const Patch& patch, double slack) {
  return std::all_of(patch.polygons.begin(), patch.polygons.end(), [&](const auto& polygon) {
    const Vec3d normal = polygon_area_vector(polygon).normalized();
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](const Vec3d& v) { return normal.dot(v - polygon[0]) <= slack; });
  });
}

}  // namespace

Occluders::Occluders(const scene::Scene& scene) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::ObjectId id(o);
    Object object;
    for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t) {
      const std::array<Vec3f, 3> c = scene.corners(id, t);
      Triangle& triangle = object.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = c[k].cast<double>();
        triangle.box.extend(triangle.corners[k]);
      }
      object.box.extend(triangle.box);
    }
    if (!object.triangles.empty()) objects_.push_back(std::move(object));
  }
}

bool Occluders::may_block(const Patch& a, const Patch& b) const {
  scene::Bounds box;
  for (const Patch* patch : {&a, &b})
    for (const auto& polygon : patch->polygons)
      for (const Vec3d& v : polygon) box.extend(v);
  const double slack = 1e-6 * box.diagonal().norm();
  for (int axis = 0; axis < 3; ++axis) {
    const double inset = std::min(slack, 0.5 * box.sizes()[axis]);
    box.min()[axis] += inset;
    box.max()[axis] -= inset;
  }
  for (const Object& object : objects_) {
    if (!object.box.intersects(box)) continue;
    for (const Triangle& t : object.triangles)
      if (t.box.intersects(box) && !is_behind(t.corners, a, slack) &&
          !is_behind(t.corners, b, slack))
        return true;
  }
  return false;
}

}  // namespace atrium::radiosity
