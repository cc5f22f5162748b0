#include "solved_mesh.h"

#include <algorithm>

#include "radiosity/export_mesh.h"
#include "scene/light_groups.h"

namespace atrium::view {
Mesh mesh_of(const LoadedScene& loaded, const radiosity::Elements& elements,
             const scene::SurfaceField& field, std::span<const scene::GroupField> groups) {
  if (groups.size() < 2) groups = {};
  Mesh mesh = make_mesh(
      radiosity::to_polygon_mesh(*loaded.scene, elements, field, loaded.basis, groups), "solution");
  for (const material::Material& m : loaded.scene->materials) mesh.materials.push_back(m.name);
  for (const scene::Object& o : loaded.scene->objects) mesh.objects.push_back(o.name);
  return mesh;
}

radiosity::SolveOptions solve_options(const SolveChoice& choice) {
  const app::Effort effort = app::effort_of(choice.quality);
  radiosity::SolveOptions o;
  o.solver = choice.shooting ? radiosity::Solver::Shooting : radiosity::Solver::Rows;
  o.max_elements = effort.max_elements;
  o.row_rays = effort.row_rays;
  o.gather_rays = effort.gather_rays;
  o.direct_samples = effort.direct_samples;
  o.caustic_photons = effort.caustic_photons;
  o.seed = choice.seed;
  o.error = choice.error;
  o.time_limit = choice.time_limit;
  o.light_groups = choice.shooting ? scene::Grouping::One : choice.groups;  // it knows none
  return o;
}

}  // namespace atrium::view
