#include "validation/scene_kit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace atrium::validation {

using material::Material;
using scene::MaterialId;

MaterialId SceneKit::material(Material m) {
  m.name = "m" + std::to_string(model_.materials.size());
  model_.materials.push_back(std::move(m));
  return MaterialId(model_.materials.size() - 1);
}

MaterialId SceneKit::diffuse(double reflectance, double exitance) {
  Material m;
  m.body_reflectance = reflectance;
  m.emission = exitance / std::numbers::pi;
  return material(m);
}

MaterialId SceneKit::perfect_mirror() {
  Material m;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.n = 1.0;
  m.kappa = 1e5;
  return material(m);
}

MaterialId SceneKit::pane(double n, double tint) {
  Material m;
  m.medium = Material::Medium::Pane;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.k_tp_rg = 1.0;
  m.n = n;
  m.transmission_tint = tint;
  return material(m);
}

MaterialId SceneKit::sheet(double reflectance, double transmittance) {
  Material m;
  m.body_reflectance = reflectance;
  m.body_transmittance = transmittance;
  m.k_tp_df = 1.0;
  return material(m);
}

void SceneKit::mesh(const std::string& name, MaterialId material, std::vector<Vec3d> positions,
                    std::vector<scene::Triangle> triangles) {
  scene::MeshData data;
  data.name = name;
  data.positions = std::move(positions);
  data.triangles = std::move(triangles);
  model_.nodes.push_back({name, scene::MeshId(model_.meshes.size()), material});
  model_.meshes.push_back(std::move(data));
}

void SceneKit::polygon(const std::string& name, MaterialId material, std::vector<Vec3d> corners) {
  std::vector<scene::Triangle> triangles;
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) triangles.push_back({0, k, k + 1});
  mesh(name, material, std::move(corners), std::move(triangles));
}

void SceneKit::block(const std::string& name, MaterialId material, const Vec3d& low,
                     const Vec3d& high) {
  std::vector<Vec3d> p;
  p.reserve(8);
  for (int i = 0; i < 8; ++i)
    p.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                   (i & 4) != 0 ? high.z() : low.z());
  mesh(name, material, std::move(p),
       {{0, 2, 3},
        {0, 3, 1},
        {4, 5, 7},
        {4, 7, 6},
        {0, 1, 5},
        {0, 5, 4},
        {2, 6, 7},
        {2, 7, 3},
        {0, 4, 6},
        {0, 6, 2},
        {1, 3, 7},
        {1, 7, 5}});
}

void SceneKit::room(const Vec3d& low, const Vec3d& high, const std::array<MaterialId, 6>& m,
                    const std::string& prefix) {
  const auto p = [&](int x, int y, int z) {
    return Vec3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  polygon(prefix + "x0", m[0], {p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)});
  polygon(prefix + "x1", m[1], {p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0)});
  polygon(prefix + "y0", m[2], {p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0)});
  polygon(prefix + "y1", m[3], {p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1)});
  polygon(prefix + "z0", m[4], {p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)});
  polygon(prefix + "z1", m[5], {p(0, 0, 1), p(0, 1, 1), p(1, 1, 1), p(1, 0, 1)});
}

void SceneKit::room(const Vec3d& low, const Vec3d& high, MaterialId m, const std::string& prefix) {
  room(low, high, {m, m, m, m, m, m}, prefix);
}

void SceneKit::sphere(const std::string& prefix, std::span<const MaterialId> zones, double radius,
                      int levels, bool seen_from_inside) {
  std::vector<Vec3d> p{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
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
  std::vector<std::vector<scene::Triangle>> parts(zones.size());
  for (scene::Triangle triangle : t) {
    const double z = (p[triangle[0]] + p[triangle[1]] + p[triangle[2]]).z() / 3.0;
    const auto zone =
        static_cast<std::size_t>(std::clamp(0.5 * (1.0 - z) * static_cast<double>(zones.size()),
                                            0.0, static_cast<double>(zones.size()) - 0.5));
    if (seen_from_inside) std::swap(triangle[1], triangle[2]);
    parts[zone].push_back(triangle);
  }
  for (Vec3d& v : p) v *= radius;
  for (std::size_t k = 0; k < parts.size(); ++k)
    mesh(prefix + std::to_string(k), zones[k], p, std::move(parts[k]));
}

void SceneKit::point_light(const Vec3d& position, double intensity) {
  scene::Light light;
  light.kind = scene::PointLight{.intensity = intensity, .falloff = {}};
  light.to_scene.translation() = position;
  model_.lights.push_back(light);
}

void SceneKit::lambertian_light(const Vec3d& position, double intensity_0) {
  scene::ProfileLight lamp;
  lamp.profile.phi_deg = {0.0};
  for (int i = 0; i <= 360; ++i) {
    lamp.profile.theta_deg.push_back(i / 4.0);
    lamp.profile.candela.push_back(intensity_0 * std::cos(i / 4.0 * std::numbers::pi / 180.0));
  }
  scene::Light light;
  light.kind = lamp;
  light.to_scene.translation() = position;
  model_.lights.push_back(light);
}

void SceneKit::directional_light(const Vec3d& towards, double irradiance) {
  scene::Light light;
  light.kind = scene::DirectionalLight{.irradiance = irradiance};
  light.to_scene.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitZ(), towards).toRotationMatrix();
  model_.lights.push_back(light);
}

scene::Scene SceneKit::build() {
  scene::BuildOptions options;
  options.pane_detection = false;
  options.repair = false;
  return scene::build_scene(std::move(model_), options);
}

}  // namespace atrium::validation
