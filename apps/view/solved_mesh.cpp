#include "solved_mesh.h"

#include <algorithm>

#include "scene/light_groups.h"

namespace atrium::view {
namespace {

using scene::GroupField;

/// By object: the light group that its emission is in.
std::vector<std::size_t> groups_of_objects(const scene::Scene& scene,
                                           std::span<const GroupField> groups) {
  const auto same = [&](const scene::LightGroups& found) {
    return std::equal(groups.begin(), groups.end(), found.names.begin(), found.names.end(),
                      [](const GroupField& g, const std::string& name) { return g.name == name; });
  };
  scene::LightGroups found = scene::find_light_groups(scene, scene::Grouping::Declared);
  if (!same(found)) found = scene::find_light_groups(scene, scene::Grouping::ByName);
  std::vector<std::size_t> result(scene.objects.size());
  for (std::size_t o = 0; o < result.size(); ++o)
    result[o] = found.group.at(scene::light_source(scene, scene::ObjectId(o)));
  return result;
}

/// The arrays of one group, made from the mesh of its light alone.
class GroupArrays {
 public:
  GroupArrays(Mesh& mesh, const scene::PolygonMesh& dark, const std::vector<std::size_t>& group_of)
      : mesh_(mesh), dark_(dark) {
    const Array& object = *find_array(mesh.polygons.cell_arrays, "object_id");
    at_points_.resize(mesh.polygons.points.size());
    for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
      at_polygons_.push_back(group_of[static_cast<std::size_t>(object.values[k])]);
      for (const std::uint32_t p : mesh.corners(k)) at_points_[p] = at_polygons_.back();
    }
  }

  void add(scene::PolygonMesh& light, std::size_t group, const std::string& name) {
    add(light.cell_arrays, dark_.cell_arrays, at_polygons_, group, name,
        mesh_.polygons.cell_arrays);
    add(light.point_arrays, dark_.point_arrays, at_points_, group, name,
        mesh_.polygons.point_arrays);
  }

 private:
  /// What lamps emit themselves is in every group's radiosity: it stays in their own only.
  static void add(std::vector<Array>& light, const std::vector<Array>& dark,
                  const std::vector<std::size_t>& group_at, std::size_t group,
                  const std::string& name, std::vector<Array>& into) {
    for (const char* quantity : {"irradiance", "irradiance_back", "radiosity", "radiosity_back"}) {
      Array* a = find_array(light, quantity);
      if (std::string_view(quantity).starts_with("radiosity")) {
        const Array& emitted = *find_array(dark, quantity);
        const auto n = static_cast<std::size_t>(a->components);
        for (std::size_t i = 0; i < a->values.size(); ++i)
          if (group_at[i / n] != group) a->values[i] -= emitted.values[i];
      }
      into.push_back({std::string(quantity) + "." + name, a->components, std::move(a->values)});
    }
  }

  Mesh& mesh_;
  const scene::PolygonMesh& dark_;
  std::vector<std::size_t> at_polygons_, at_points_;
};

void add_groups(const LoadedScene& loaded, const radiosity::Elements& elements,
                const scene::SurfaceField& field, std::span<const GroupField> groups, Mesh& mesh) {
  const auto with_factors = [&](const std::vector<double>& factors) {
    return radiosity::to_polygon_mesh(*loaded.scene, elements,
                                      scene::reweight(field, groups, factors), loaded.basis);
  };
  const scene::PolygonMesh dark = with_factors(std::vector<double>(groups.size(), 0.0));
  GroupArrays arrays(mesh, dark, groups_of_objects(*loaded.scene, groups));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<double> factors(groups.size(), 0.0);
    factors[g] = 1.0;
    scene::PolygonMesh light = with_factors(factors);
    arrays.add(light, g, groups[g].name);
  }
}

}  // namespace

Mesh mesh_of(const LoadedScene& loaded, const radiosity::Elements& elements,
             const scene::SurfaceField& field, std::span<const GroupField> groups) {
  Mesh mesh = make_mesh(radiosity::to_polygon_mesh(*loaded.scene, elements, field, loaded.basis),
                        "solution");
  for (const material::Material& m : loaded.scene->materials) mesh.materials.push_back(m.name);
  for (const scene::Object& o : loaded.scene->objects) mesh.objects.push_back(o.name);
  if (groups.size() > 1) add_groups(loaded, elements, field, groups, mesh);
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
