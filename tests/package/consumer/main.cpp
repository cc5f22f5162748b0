// A lamp over a floor: solved, rendered, lit.
#include "radiosity/solve.h"
#include "scene/ray_query.h"
#include "trace/render.h"

int main() {
  namespace as = atrium::scene;
  as::Model model;
  model.meshes.resize(1);
  model.meshes[0].positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  model.meshes[0].triangles = {{0, 1, 2}, {0, 2, 3}};
  model.materials.resize(1);
  model.materials[0].body_reflectance = 0.5;
  model.nodes.push_back({"floor", as::MeshId(0u), as::MaterialId(0u)});
  model.lights.resize(1);
  model.lights[0].to_scene.translation() = atrium::Vec3d(0, 2, 0);
  const as::Scene scene = as::build_scene(model);
  const as::RayQuery query(scene);
  const auto basis = atrium::material::SpectralBasis::grey();
  const auto solution = atrium::radiosity::solve(query, basis);
  as::Camera camera;
  camera.to_scene = as::look_at({0, 2, 2}, {0, 0, 0}, {0, 1, 0});
  const auto picture = atrium::trace::render(query, basis, camera, solution.field,
                                             {.width = 16, .height = 12, .samples = 4});
  const int red = picture.image.channel_index("R");
  return picture.image.at(8, 6, red) > 0.0f ? 0 : 1;
}
