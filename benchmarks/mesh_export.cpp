// Times what `atrium solve -o x.vtp` adds to a solve: a wall of N x N elements, written and read.
//   mesh_export [N]      N x N elements, 1000 by default
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "radiosity/bake.h"
#include "radiosity/export_mesh.h"
#include "scene/mesh_io.h"

namespace {

using namespace atrium;

/// A wall of 10 m x 10 m.
scene::Scene wall() {
  scene::Model model;
  material::Material m;
  m.name = "wall";
  m.body_reflectance = make_rgb(0.5f, 0.6f, 0.7f);
  model.materials.push_back(m);
  scene::MeshData mesh;
  mesh.positions = {Vec3d(0, 0, 0), Vec3d(10, 0, 0), Vec3d(10, 10, 0), Vec3d(0, 10, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  model.meshes.push_back(mesh);
  model.nodes.push_back({"wall", scene::MeshId(0U), scene::MaterialId(0U)});
  return scene::build_scene(std::move(model));
}

/// Values that change from element to element by a part that looks like noise.
scene::SurfaceField noisy(const radiosity::Elements& elements) {
  scene::SurfaceField field = elements.layout;
  field.lanes = 3;
  field.unit = "lx";
  field.valid.assign(2 * field.element_count(), 1);
  field.standard_error.assign(2 * field.element_count(), 1.0f);
  for (std::size_t i = 0; i < 6 * field.element_count(); ++i) {
    const std::size_t element = i / 6;
    const float x = 0.001f * static_cast<float>(element);
    const float noise = std::fmod(static_cast<float>(i) * 0.61803399f, 1.0f);
    field.irradiance.direct.push_back(500.0f + 100.0f * std::sin(x) + 5.0f * noise);
    field.irradiance.indirect.push_back(200.0f + 20.0f * std::cos(x) + 2.0f * noise);
  }
  return field;
}

/// Seconds since the last line, by the wall and of all processors.
class Clock {
 public:
  void say(const std::string& what) {
    const auto wall = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    std::printf("%-28s %7.2f %7.2f\n", what.c_str(),
                std::chrono::duration<double>(wall - wall_).count(),
                static_cast<double>(cpu - cpu_) / CLOCKS_PER_SEC);
    wall_ = std::chrono::steady_clock::now();
    cpu_ = std::clock();
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

}  // namespace

int main(int argc, char** argv) {
  const double n = argc > 1 ? std::atof(argv[1]) : 1000.0;
  const scene::Scene scene = wall();
  const auto elements = radiosity::make_elements(
      scene, {.element_size = 10.0 / n, .max_elements = static_cast<std::uint32_t>(n * n)});
  const scene::SurfaceField field = noisy(elements);
  const auto basis = material::SpectralBasis::rgb();
  std::printf("%zu elements              wall s   CPU s\n", field.element_count());
  const auto folder = std::filesystem::temp_directory_path();
  Clock clock;
  const auto again = radiosity::elements_of_field(scene, field);
  clock.say("elements of the field");
  const auto mesh = radiosity::to_polygon_mesh(scene, again, field, basis);
  clock.say("polygons and arrays");
  for (const char* ending : {"vtp", "vtu"}) {
    const auto file = folder / ("mesh_export." + std::string(ending));
    scene::write_polygon_mesh(mesh, file);
    clock.say("write ." + std::string(ending));
    const auto summary = scene::summarise_mesh_file(file);
    clock.say("read ." + std::string(ending));
    std::printf("%28.1f MB, %llu polygons\n",
                1e-6 * static_cast<double>(std::filesystem::file_size(file)),
                static_cast<unsigned long long>(summary.polygons));
    std::filesystem::remove(file);
  }
  const auto baked = radiosity::bake(scene, again, field, basis);
  clock.say("bake");
  const auto glb = scene::encode_glb(baked, {.white = 500.0});
  clock.say("encode .glb");
  std::printf("%28.1f MB\n", 1e-6 * static_cast<double>(glb.size()));
  return 0;
}
