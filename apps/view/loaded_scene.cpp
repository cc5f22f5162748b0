#include "loaded_scene.h"

#include <algorithm>

#include "material/error.h"
#include "scene/features.h"
#include "scene/scene_io.h"

namespace atrium::view {

LoadedScene load_scene(const std::vector<std::string>& files, const SolveChoice& options) {
  scene::Model model = scene::read_model(
      {files.begin(), files.end()}, {.emissive_nits_per_unit = options.nits_per_emissive_unit});
  LoadedScene loaded;
  scene::BuildOptions build;
  build.pane_detection = options.pane_detection;
  loaded.scene = std::make_unique<scene::Scene>(scene::build_scene(std::move(model), build));
  const scene::Scene& s = *loaded.scene;
  loaded.query = std::make_unique<scene::RayQuery>(s);
  loaded.basis = scene::choose_basis(s, scene::find_features(s), "auto").basis;
  const double distance = 0.25 * s.bounds.diagonal().norm();
  for (const scene::Camera& c : s.cameras) loaded.views.push_back(view_of(c, s.origin, distance));
  if (loaded.views.empty()) {
    scene::Camera inside = scene::choose_interior_view(s, *loaded.query);
    inside.name = "inside";
    loaded.views.push_back(view_of(inside, s.origin, distance));
  }
  return loaded;
}

void warn_of_scene(const scene::Scene& scene, const std::function<void(const std::string&)>& warn) {
  constexpr std::size_t kShown = 10;
  const std::vector<std::string>& all = scene.report.warnings;
  for (std::size_t i = 0; i < std::min(kShown, all.size()); ++i) warn(all[i]);
  if (all.size() > kShown)
    warn(std::to_string(all.size() - kShown) + " more warnings; atrium info lists them");
}

Mesh bare_mesh(const LoadedScene& loaded) {
  const scene::Scene& s = *loaded.scene;
  scene::PolygonMesh polygons;
  Array material{"material_id", 1, {}};
  Array object{"object_id", 1, {}};
  for (std::size_t o = 0; o < s.objects.size(); ++o) {
    const scene::ObjectId id(o);
    const material::MaterialTraits traits = material::traits(s.material_of(id));
    if (!traits.diffuse_reflection && !traits.diffuse_transmission) continue;
    for (std::uint32_t t = 0; t < s.mesh_of(id).triangles.size(); ++t) {
      for (const Vec3f& corner : s.corners(id, t)) {
        polygons.polygon_points.push_back(static_cast<std::uint32_t>(polygons.points.size()));
        polygons.points.push_back(corner.cast<double>() + s.origin);
      }
      polygons.polygon_sizes.push_back(3);
      material.values.push_back(static_cast<float>(s.objects[o].material.value));
      object.values.push_back(static_cast<float>(o));
    }
  }
  polygons.cell_arrays = {std::move(material), std::move(object)};
  Mesh mesh = make_mesh(std::move(polygons), "scene");
  for (const material::Material& m : s.materials) mesh.materials.push_back(m.name);
  for (const scene::Object& ob : s.objects) mesh.objects.push_back(ob.name);
  return mesh;
}

void require_light(const LoadedScene& loaded) {
  const scene::Features f = scene::find_features(*loaded.scene);
  if (!f.diffuse && !f.diffuse_transmission)
    throw Error("nothing to solve: no surface reflects or transmits light diffusely");
  if (!f.any_light()) throw Error("nothing to solve: nothing emits light");
}

}  // namespace atrium::view
