#include "coarse.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

namespace atrium::view {
namespace {

/// Cell of the grid and main direction of a point's surface.
struct Key {
  std::int32_t x, y, z, direction;
  friend bool operator==(const Key&, const Key&) = default;
};
struct Hash {
  std::size_t operator()(const Key& k) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (const std::int32_t v : {k.x, k.y, k.z, k.direction})
      h = (h ^ static_cast<std::uint32_t>(v)) * 0xff51afd7ed558ccdULL, h ^= h >> 32;
    return h;
  }
};

/// 0 to 5: along which axis, and which way.
std::int32_t direction_of(const Vec3f& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0.0f ? 1 : 0);
}

std::vector<std::uint32_t> representatives(const Mesh& mesh, double cell) {
  std::vector<Vec3f> normal(mesh.polygons.points.size(), Vec3f::Zero());
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    for (const std::uint32_t p : mesh.corners(k)) normal[p] += mesh.area_normal[k];
  std::unordered_map<Key, std::uint32_t, Hash> first;
  std::vector<std::uint32_t> of(normal.size());
  for (std::uint32_t p = 0; p < of.size(); ++p) {
    const Vec3d at = mesh.polygons.points[p] / cell;
    const auto place = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
    of[p] =
        first.try_emplace({place(at.x()), place(at.y()), place(at.z()), direction_of(normal[p])}, p)
            .first->second;
  }
  return of;
}

}  // namespace

Triangles coarsen(const Mesh& mesh, const Triangles& triangles, std::size_t wanted) {
  if (triangles.size() <= wanted) return triangles;
  double area = 0.0;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) area += static_cast<double>(mesh.area(k));
  const double cell = std::sqrt(2.0 * area / static_cast<double>(wanted));
  const std::vector<std::uint32_t> of = representatives(mesh, cell);
  Triangles coarse;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& c = triangles.corners[t];
    const std::array<std::uint32_t, 3> merged{of[c[0]], of[c[1]], of[c[2]]};
    if (merged[0] == merged[1] || merged[1] == merged[2] || merged[2] == merged[0]) continue;
    coarse.corners.push_back(merged);
    coarse.polygon.push_back(triangles.polygon[t]);
  }
  return coarse;
}

}  // namespace atrium::view
