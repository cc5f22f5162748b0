#include "plain_things.h"

#include <algorithm>

#include "ceilings.h"
#include "loaded_scene.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "radiosity/bake.h"
#endif

namespace atrium::view {

using scene::BakedModel;

bool PlainThings::is_glass(std::size_t thing) const {
  return model.materials[model.primitives[thing].material].kind ==
         BakedModel::Material::Kind::Glass;
}

#ifdef ATRIUM_WITH_RADIOSITY

namespace {

/// By object; empty: the mesh is of another scene, or does not say.
std::vector<std::uint8_t> objects_in(const Mesh& mesh, const scene::Scene& scene) {
  const bool same = std::equal(
      scene.objects.begin(), scene.objects.end(), mesh.objects.begin(), mesh.objects.end(),
      [](const scene::Object& o, const std::string& name) { return o.name == name; });
  if (!same || find_array(mesh.polygons.cell_arrays, "object_id") == nullptr) return {};
  std::vector<std::uint8_t> in(scene.objects.size(), 0);
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    if (const std::int64_t id = id_at(mesh, "object_id", k);
        id >= 0 && id < static_cast<std::int64_t>(in.size()))
      in[static_cast<std::size_t>(id)] = 1;
  return in;
}

Mesh shapes_of(const BakedModel& model, std::size_t things) {
  scene::PolygonMesh polygons;
  Array thing{"object_id", 1, {}};
  for (std::size_t i = 0; i < things; ++i) {
    const BakedModel::Primitive& p = model.primitives[i];
    const auto first = static_cast<std::uint32_t>(polygons.points.size());
    for (const Vec3f& v : p.positions) polygons.points.push_back(v.cast<double>() + model.origin);
    for (const std::uint32_t c : p.indices) polygons.polygon_points.push_back(first + c);
    polygons.polygon_sizes.insert(polygons.polygon_sizes.end(), p.indices.size() / 3, 3);
    thing.values.insert(thing.values.end(), p.indices.size() / 3, static_cast<float>(i));
  }
  if (polygons.polygon_sizes.empty()) return {};
  polygons.cell_arrays = {std::move(thing)};
  return make_mesh(std::move(polygons), "things without elements");
}

}  // namespace

PlainThings plain_things(const LoadedScene& loaded, const Mesh& mesh,
                         std::span<const scene::GroupField> groups) {
  PlainThings things;
  const scene::Scene& s = *loaded.scene;
  const std::vector<std::uint8_t> in_mesh = objects_in(mesh, s);
  if (in_mesh.empty()) return things;
  things.model = radiosity::bake_plain(s, loaded.basis, in_mesh, groups);
  for (std::size_t o = 0; o < in_mesh.size(); ++o) {
    if (in_mesh[o] != 0) continue;
    things.object.push_back(static_cast<std::uint32_t>(o));
    things.material.push_back(s.objects[o].material.value);
  }
  things.shapes = shapes_of(things.model, things.size());
  return things;
}

#else

PlainThings plain_things(const LoadedScene&, const Mesh&, std::span<const scene::GroupField>) {
  return {};
}

#endif

std::vector<scene::GroupField> groups_named(const scene::Scene& scene,
                                            const std::vector<std::string>& names) {
  std::vector<scene::GroupField> groups;
  if (names.size() < 2) return groups;
  for (const scene::Grouping grouping : {scene::Grouping::Declared, scene::Grouping::ByName})
    if (groups.empty() && scene::find_light_groups(scene, grouping).names == names)
      for (const std::string& name : names) {
        groups.emplace_back();
        groups.back().name = name;
      }
  return groups;
}

std::vector<std::uint8_t> hidden_things(const PlainThings& things, const Mesh& mesh,
                                        const std::vector<Selection>& hidden, bool no_ceilings) {
  std::vector<std::uint8_t> out(things.size(), 0);
  for (const Selection& s : hidden)
    for (std::size_t i = 0; i < out.size(); ++i)
      if ((s.kind == Selection::Kind::Object && s.id == things.object[i]) ||
          (s.kind == Selection::Kind::Material && s.id == things.material[i]))
        out[i] = 1;
  if (!no_ceilings || things.shapes.polygon_count() == 0) return out;
  const std::vector<std::uint8_t> covers = find_ceilings(mesh, things.shapes);
  for (std::size_t k = 0; k < covers.size(); ++k)
    if (covers[k] != 0) out[static_cast<std::size_t>(id_at(things.shapes, "object_id", k))] = 1;
  return out;
}

}  // namespace atrium::view
