#include "pane_detection.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "adjacency.h"

namespace atrium::scene {
namespace {

constexpr double kThickest = 0.05;         // [m]
constexpr double kThicknessShare = 0.125;  // of the smaller side
constexpr double kFaceShare = 0.8;         // of the surface, both faces together
constexpr double kParallel = 1e-4;         // 1 - cosine: 0.8 degrees

Vec3d corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions[mesh.triangles[triangle][k]].cast<double>();
}

Vec3d cross_of(const Mesh& mesh, std::uint32_t t) {
  return (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
}

/// One of the two faces: triangles that look along a direction, all in one plane.
struct Face {
  std::vector<std::uint32_t> triangles;
  double area2 = 0.0;
  double lowest = std::numeric_limits<double>::infinity();  ///< of the offsets along the normal
  double highest = -std::numeric_limits<double>::infinity();
  [[nodiscard]] double middle() const { return 0.5 * (lowest + highest); }
};

void add(Face& face, const Mesh& mesh, std::uint32_t t, double area2, const Vec3d& origin,
         const Vec3d& normal) {
  face.triangles.push_back(t);
  face.area2 += area2;
  for (std::size_t k = 0; k < 3; ++k) {
    const double offset = (corner(mesh, t, k) - origin).dot(normal);
    face.lowest = std::min(face.lowest, offset);
    face.highest = std::max(face.highest, offset);
  }
}

/// The smaller side of the face's rectangle along its longest edge.
double smaller_side(const Mesh& mesh, const Face& face, const Vec3d& normal) {
  Vec3d longest = Vec3d::Zero();
  for (const std::uint32_t t : face.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d edge = corner(mesh, t, (k + 1) % 3) - corner(mesh, t, k);
      if (edge.squaredNorm() > longest.squaredNorm()) longest = edge;
    }
  }
  // The longest edge may be a rectangle's diagonal: take the better of several directions.
  double best = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : face.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d edge = corner(mesh, t, (k + 1) % 3) - corner(mesh, t, k);
      if (edge.norm() < 0.3 * longest.norm()) continue;
      const Vec3d across = normal.cross(edge).normalized();
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const std::uint32_t other : face.triangles) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double x = corner(mesh, other, c).dot(across);
          low = std::min(low, x);
          high = std::max(high, x);
        }
      }
      best = std::min(best, high - low);
    }
    if (face.triangles.size() > 200) break;  // a many-sided outline: one triangle's edges will do
  }
  return best;
}

struct Slab {
  Face front;
  Vec3d normal;
  double middle = 0.0;  ///< offset of the mid-plane from `origin` along the normal
  Vec3d origin;
  double thickness = 0.0;
};

std::optional<Slab> find_slab(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::uint32_t largest = triangles[0];
  double total = 0.0;
  for (const std::uint32_t t : triangles) {
    total += cross_of(mesh, t).norm();
    if (cross_of(mesh, t).squaredNorm() > cross_of(mesh, largest).squaredNorm()) largest = t;
  }
  Slab slab;
  slab.normal = cross_of(mesh, largest).normalized();
  slab.origin = corner(mesh, largest, 0);
  Face back;
  for (const std::uint32_t t : triangles) {
    const Vec3d cross = cross_of(mesh, t);
    const double area2 = cross.norm();
    const double cosine = cross.dot(slab.normal) / area2;
    if (cosine > 1.0 - kParallel) add(slab.front, mesh, t, area2, slab.origin, slab.normal);
    if (cosine < -1.0 + kParallel) add(back, mesh, t, area2, slab.origin, slab.normal);
  }
  if (back.triangles.empty()) return std::nullopt;
  slab.thickness = std::abs(slab.front.middle() - back.middle());
  slab.middle = 0.5 * (slab.front.middle() + back.middle());
  const double flat = std::max(1e-5, 0.02 * slab.thickness);
  const bool planar =
      slab.front.highest - slab.front.lowest <= flat && back.highest - back.lowest <= flat;
  const bool equal = std::abs(slab.front.area2 - back.area2) <= 0.02 * slab.front.area2;
  const bool thin = slab.thickness > 0.0 && slab.thickness <= kThickest &&
                    slab.front.area2 + back.area2 >= kFaceShare * total;
  if (!planar || !equal || !thin) return std::nullopt;
  if (slab.thickness > kThicknessShare * smaller_side(mesh, slab.front, slab.normal))
    return std::nullopt;
  return slab;
}

Mesh sheet_of(const Mesh& mesh, const Slab& slab) {
  Mesh out;
  out.name = mesh.name + " (pane)";
  std::vector<std::uint32_t> to(mesh.positions.size(), Adjacency::kNone);
  for (const std::uint32_t t : slab.front.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (to[v] == Adjacency::kNone) {
        to[v] = static_cast<std::uint32_t>(out.positions.size());
        const Vec3d p = mesh.positions[v].cast<double>();
        const double offset = (p - slab.origin).dot(slab.normal);
        out.positions.push_back((p + (slab.middle - offset) * slab.normal).cast<float>());
        if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[v]);
        if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[v]);
      }
      corners[k] = to[v];
    }
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace

PaneSplit split_panes(const Mesh& mesh) {
  PaneSplit out;
  const Weld weld = weld_positions(mesh.positions);
  const Adjacency adjacency = find_adjacency(mesh.triangles, weld);
  const Parts parts = connected_parts(adjacency);
  std::vector<std::vector<std::uint32_t>> members(parts.count);
  std::vector<bool> closed(parts.count, true);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    members[parts.of_triangle[t]].push_back(t);
    for (std::uint32_t e = 0; e < 3; ++e) {
      if (adjacency.across[3 * t + e] == Adjacency::kNone) closed[parts.of_triangle[t]] = false;
    }
  }
  std::vector<bool> taken(mesh.triangles.size(), false);
  for (std::uint32_t part = 0; part < parts.count; ++part) {
    if (!closed[part]) continue;
    const std::optional<Slab> slab = find_slab(mesh, members[part]);
    if (!slab) continue;
    out.panes.push_back({sheet_of(mesh, *slab), slab->thickness});
    for (const std::uint32_t t : members[part]) taken[t] = true;
  }
  out.rest = mesh;
  std::size_t index = 0;
  std::erase_if(out.rest.triangles, [&](const Triangle&) { return taken[index++]; });
  return out;
}

}  // namespace atrium::scene
