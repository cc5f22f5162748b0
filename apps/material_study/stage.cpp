#include "material_study/stage.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace atrium::study {

namespace {

using material::Material;

class Builder {
 public:
  scene::MaterialId add(Material m) {
    model_.materials.push_back(std::move(m));
    return scene::MaterialId(model_.materials.size() - 1);
  }
  scene::MaterialId diffuse(const material::SpectralValue& reflectance, double emission = 0.0) {
    Material m;
    m.name = "surroundings " + std::to_string(model_.materials.size());
    m.body_reflectance = reflectance;
    m.emission = emission;
    return add(std::move(m));
  }
  void mesh(scene::MaterialId material, scene::MeshData data) {
    data.name = "mesh " + std::to_string(model_.meshes.size());
    model_.nodes.push_back(
        {data.name, scene::MeshId(model_.meshes.size()), material, Eigen::Affine3d::Identity()});
    model_.meshes.push_back(std::move(data));
  }
  /// The front is where u x v points.
  void quad(scene::MaterialId material, const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    scene::MeshData data;
    add_quad(data, corner, u, v);
    mesh(material, std::move(data));
  }
  static void add_quad(scene::MeshData& data, const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    const auto i = static_cast<std::uint32_t>(data.positions.size());
    for (const Vec3d& p : {corner, Vec3d(corner + u), Vec3d(corner + u + v), Vec3d(corner + v)})
      data.positions.push_back(p);
    data.triangles.push_back({i, i + 1, i + 2});
    data.triangles.push_back({i, i + 2, i + 3});
  }
  /// Of latitudes and longitudes, shaded smoothly.
  void sphere(scene::MaterialId material, const Vec3d& center, double radius) {
    constexpr int kRings = 96, kSegments = 2 * kRings;
    scene::MeshData data;
    for (int i = 0; i <= kRings; ++i)
      for (int j = 0; j < kSegments; ++j) {
        const double theta = std::numbers::pi * i / kRings;
        const double phi = 2.0 * std::numbers::pi * j / kSegments;
        const Vec3d n(std::sin(theta) * std::cos(phi), std::cos(theta),
                      std::sin(theta) * std::sin(phi));
        data.positions.push_back(center + radius * n);
        data.normals.push_back(n.cast<float>());
      }
    const auto at = [](int i, int j) {
      return static_cast<std::uint32_t>(i * kSegments + j % kSegments);
    };
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kSegments; ++j) {
        if (i > 0) data.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        if (i + 1 < kRings) data.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      }
    mesh(material, std::move(data));
  }
  /// Upright, turned about its vertical axis.
  void block(scene::MaterialId material, double half, double height, double angle) {
    const Vec3d u(std::cos(angle), 0.0, -std::sin(angle)), v(std::sin(angle), 0.0, std::cos(angle));
    const Vec3d up(0.0, height, 0.0), base(0.0, 1e-3, 0.0);
    scene::MeshData data;
    const Vec3d a = base - half * u - half * v, b = base + half * u - half * v,
                c = base + half * u + half * v, d = base - half * u + half * v;
    add_quad(data, a, 2.0 * half * u, 2.0 * half * v);  // below
    add_quad(data, d + up, 2.0 * half * u, -2.0 * half * v);
    for (const auto& [from, to] :
         {std::pair(d, c), std::pair(c, b), std::pair(b, a), std::pair(a, d)})
      add_quad(data, from, to - from, up);
    mesh(material, std::move(data));
  }
  void floor(double half, int fields) {
    scene::MeshData light, dark;
    const double step = 2.0 * half / fields;
    for (int i = 0; i < fields; ++i)
      for (int j = 0; j < fields; ++j)
        add_quad((i + j) % 2 == 0 ? light : dark, Vec3d(-half + i * step, 0.0, -half + j * step),
                 Vec3d(0.0, 0.0, step), Vec3d(step, 0.0, 0.0));
    mesh(diffuse(0.5), std::move(light));
    mesh(diffuse(0.15), std::move(dark));
  }
  void camera(const Vec3d& eye, const Vec3d& target, double yfov) {
    scene::Camera camera;
    camera.name = "study";
    camera.to_scene = scene::look_at(eye, target, Vec3d::UnitY());
    camera.yfov = yfov;
    model_.cameras.push_back(std::move(camera));
  }
  scene::Model& model() { return model_; }

 private:
  scene::Model model_;
};

/// Floor, sky, a square lamp high on the left, a narrow upright one on the right.
void add_studio(Builder& b) {
  b.floor(4.0, 16);
  b.quad(b.diffuse(0.0, 14.0), Vec3d(-3.2, 3.0, 0.4), Vec3d(1.0, 0.9, 0.0), Vec3d(0.0, 0.0, 1.6));
  b.quad(b.diffuse(0.0, 14.0), Vec3d(2.6, 0.4, 0.6), Vec3d(-0.1, 0.0, 0.3), Vec3d(0.0, 2.4, 0.0));
  scene::Environment sky;
  sky.radiance = 0.4;
  b.model().environment = sky;
}

void add_room(Builder& b) {
  const auto grey = b.diffuse(0.7), red = b.diffuse(make_rgb(0.6, 0.1, 0.08)),
             green = b.diffuse(make_rgb(0.12, 0.5, 0.12));
  const Vec3d x(4.0, 0.0, 0.0), y(0.0, 3.0, 0.0), z(0.0, 0.0, 4.0), o(-2.0, 0.0, -2.0);
  b.quad(grey, o, z, x);       // floor
  b.quad(grey, o + y, x, z);   // ceiling
  b.quad(grey, o, x, y);       // back
  b.quad(grey, o + z, y, x);   // behind the camera
  b.quad(red, o, y, z);        // left
  b.quad(green, o + x, z, y);  // right
  b.quad(b.diffuse(0.0, 9.0), Vec3d(-0.8, 2.98, -0.8), Vec3d(1.6, 0.0, 0.0), Vec3d(0.0, 0.0, 1.6));
}

}  // namespace

const char* name_of(Stage stage) {
  return stage == Stage::Sphere ? "sphere" : stage == Stage::Box ? "box" : "room";
}

scene::Model make_stage(Stage stage, const Material& material) {
  Builder b;
  const scene::MaterialId subject = b.add(material);
  switch (stage) {
    case Stage::Sphere:
      b.sphere(subject, Vec3d(0.0, 1.001, 0.0), 1.0);
      add_studio(b);
      b.camera(Vec3d(0.0, 2.0, 4.4), Vec3d(0.0, 0.93, 0.0), 0.52);
      break;
    case Stage::Box:
      b.block(subject, 0.75, 1.4, 0.6);
      add_studio(b);
      b.camera(Vec3d(0.0, 2.6, 4.2), Vec3d(0.0, 0.62, 0.0), 0.52);
      break;
    case Stage::Room:
      b.sphere(subject, Vec3d(0.0, 0.851, -0.4), 0.85);
      add_room(b);
      b.camera(Vec3d(0.0, 1.45, 1.95), Vec3d(0.0, 1.2, -1.0), 1.05);
      break;
  }
  return std::move(b.model());
}

double exposure_of(Stage stage) { return stage == Stage::Room ? 1.2 : 0.7; }

}  // namespace atrium::study
