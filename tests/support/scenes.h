#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace atrium::testing {

/// Small scenes built in memory, with known answers.
class SceneMaker {
 public:
  scene::MaterialId material(material::Material m) {
    m.name = std::string("m").append(std::to_string(model_.materials.size()));
    model_.materials.push_back(std::move(m));
    return scene::MaterialId(model_.materials.size() - 1);
  }
#ifndef __clang__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false alarm of GCC 12, optional variants
#endif
  /// Lambertian, with emission (radiance) on the front only.
  scene::MaterialId diffuse(double reflectance, double emission = 0.0) {
    material::Material m;
    m.body_reflectance = reflectance;
    m.emission = emission;
    return material(std::move(m));
  }
#ifndef __clang__
#pragma GCC diagnostic pop
#endif
  void mesh(scene::MaterialId material, std::vector<Vec3d> positions,
            std::vector<scene::Triangle> triangles) {
    scene::MeshData data;
    data.name = "mesh" + std::to_string(model_.meshes.size());
    data.positions = std::move(positions);
    data.triangles = std::move(triangles);
    model_.nodes.push_back(
        {data.name, scene::MeshId(model_.meshes.size()), material, Eigen::Affine3d::Identity()});
    model_.meshes.push_back(std::move(data));
  }
  /// Parallelogram; the front is where u x v points.
  void quad(scene::MaterialId material, const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    mesh(material, {corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}});
  }
  /// Axis-parallel box from lo to hi; fronts look inwards (a room) or outwards (a block).
  void box(scene::MaterialId material, const Vec3d& lo, const Vec3d& hi, bool inwards) {
    std::vector<Vec3d> p;
    for (int i = 0; i < 8; ++i)
      p.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                     (i & 4) != 0 ? hi.z() : lo.z());
    std::vector<scene::Triangle> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                   {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                   {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    if (inwards)
      for (scene::Triangle& x : t) std::swap(x[1], x[2]);
    mesh(material, std::move(p), std::move(t));
  }
  /// Latitude-longitude sphere, fronts outwards (or inwards).
  void sphere(scene::MaterialId material, const Vec3d& center, double radius, int rings,
              bool inwards) {
    std::vector<Vec3d> p;
    std::vector<scene::Triangle> t;
    const int segments = 2 * rings;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j < segments; ++j) {
        const double theta = M_PI * i / rings, phi = 2.0 * M_PI * j / segments;
        p.push_back(center + radius * Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                            std::sin(theta) * std::sin(phi)));
      }
    const auto at = [&](int i, int j) {
      return static_cast<std::uint32_t>(i * segments + j % segments);
    };
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < segments; ++j) {
        scene::Triangle a{at(i, j), at(i, j + 1), at(i + 1, j + 1)},
            b{at(i, j), at(i + 1, j + 1), at(i + 1, j)};
        if (inwards) {
          std::swap(a[1], a[2]);
          std::swap(b[1], b[2]);
        }
        if (i > 0) t.push_back(a);
        if (i + 1 < rings) t.push_back(b);
      }
    mesh(material, std::move(p), std::move(t));
  }
  scene::Model& model() { return model_; }
  [[nodiscard]] scene::Scene build() { return scene::build_scene(std::move(model_)); }

 private:
  scene::Model model_;
};

}  // namespace atrium::testing
