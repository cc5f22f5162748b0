#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"

// Scenes of quadrilaterals, made by hand so that no repair touches them.
namespace atrium::test {

inline material::Material diffuse(double reflectance) {
  material::Material m;
  m.name = "diffuse";
  m.k_df = 1.0;
  m.k_rg = 0.0;
  m.body_reflectance = material::SpectralValue(reflectance);
  return m;
}

inline material::Material emitter(double radiance, double reflectance) {
  material::Material m = diffuse(reflectance);
  m.name = "emitter";
  m.emission = material::SpectralValue(radiance);
  return m;
}

class SceneMaker {
 public:
  SceneMaker() { scene_.unit = scene::RadianceUnit::Watt; }

  scene::MaterialId material(material::Material m) {
    scene_.materials.push_back(std::move(m));
    return scene::MaterialId(scene_.materials.size() - 1);
  }

  // One object of any triangles.
  void object(scene::MaterialId material, std::vector<Vec3f> positions,
              std::vector<scene::Triangle> triangles, bool closed = false) {
    scene::Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    mesh.closed = closed;
    scene::Object o;
    o.mesh = scene::MeshId(scene_.meshes.size());
    o.material = material;
    o.first_triangle = triangles_;
    triangles_ += mesh.triangles.size();
    for (const Vec3f& p : mesh.positions) scene_.bounds.extend(p.cast<double>());
    scene_.meshes.push_back(std::move(mesh));
    scene_.objects.push_back(o);
  }

  // Front by counter-clockwise corners.
  void quad(scene::MaterialId m, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
    object(m, {a, b, c, d}, {{0, 1, 2}, {0, 2, 3}});
  }

  // A room seen from inside; materials of x0, x1, y0, y1, z0, z1.
  void room(const Vec3f& low, const Vec3f& high, const std::array<scene::MaterialId, 6>& m) {
    const auto p = [&](int x, int y, int z) {
      return Vec3f(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
    };
    quad(m[0], p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1));
    quad(m[1], p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0));
    quad(m[2], p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0));
    quad(m[3], p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1));
    quad(m[4], p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0));
    quad(m[5], p(0, 0, 1), p(0, 1, 1), p(1, 1, 1), p(1, 0, 1));
  }
  void room(const Vec3f& low, const Vec3f& high, scene::MaterialId m) {
    room(low, high, {m, m, m, m, m, m});
  }

  void point_light(const Vec3d& position, double intensity) {
    scene::Light light;
    scene::PointLight point;
    point.intensity = material::SpectralValue(intensity);
    light.kind = point;
    light.to_scene.translation() = position;
    scene_.lights.push_back(light);
  }

  // A sphere seen from inside or outside, by subdivision of an octahedron.
  void sphere(scene::MaterialId m, float radius, int levels, bool inside) {
    std::vector<Vec3f> p{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<scene::Triangle> t{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                   {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
      const auto mid = [&](std::uint32_t a, std::uint32_t b) {
        const auto [it, fresh] =
            middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p.size()));
        if (fresh) p.push_back((p[a] + p[b]).normalized());
        return it->second;
      };
      std::vector<scene::Triangle> next;
      for (const auto& [a, b, c] : t) {
        const std::uint32_t ab = mid(a, b), bc = mid(b, c), ca = mid(c, a);
        next.insert(next.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
      }
      t = std::move(next);
    }
    for (Vec3f& v : p) v *= radius;
    if (inside)
      for (scene::Triangle& v : t) std::swap(v[1], v[2]);
    object(m, std::move(p), std::move(t), true);
  }

  scene::Scene take() { return std::move(scene_); }

 private:
  scene::Scene scene_;
  std::uint64_t triangles_ = 0;
};

}  // namespace atrium::test
