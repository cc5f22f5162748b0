#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "material/cie.h"
#include "material/error.h"
#include "yaml_scene.h"

namespace atrium::scene {
namespace {

Eigen::Affine3d read_matrix(const YamlView& view) {
  const std::size_t count = view.items().size();
  if (count != 12 && count != 16) view.fail("a matrix has 12 or 16 numbers, row by row");
  const std::vector<double> m = view.numbers(count);
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  for (std::size_t i = 0; i < 12; ++i) {
    transform.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = m[i];
  }
  if (count == 16 && (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0)) {
    view.fail("the last row of a matrix must be 0 0 0 1");
  }
  if (!(std::abs(transform.linear().determinant()) > 0.0)) view.fail("the matrix is singular");
  return transform;
}

Eigen::AngleAxisd read_rotation(const YamlView& view) {
  constexpr double radians = std::numbers::pi / 180.0;
  if (view.is_number()) return {view.number() * radians, Vec3d::UnitY()};
  const YamlMap map = view.map("rotate", {"axis", "angle"});
  return {map.get("angle").number() * radians, map.get("axis").direction()};
}

// translate * rotate * scale, or the matrix.
Eigen::Affine3d read_transform(const YamlMap& map) {
  const auto translate = map.find("translate");
  const auto rotate = map.find("rotate");
  const auto scale = map.find("scale");
  if (const auto matrix = map.find("matrix")) {
    if (translate || rotate || scale) matrix->fail("give a matrix or translate, rotate, scale");
    return read_matrix(*matrix);
  }
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (translate) transform.translate(translate->vector());
  if (rotate) transform.rotate(read_rotation(*rotate));
  if (scale) {
    const Vec3d s = scale->is_number() ? Vec3d::Constant(scale->number()).eval() : scale->vector();
    if (!(s.cwiseAbs().minCoeff() > 0.0)) scale->fail("a scale must not be 0");
    transform.scale(s);
  }
  return transform;
}

// {count: n, step: [x, y, z]} is a row; {count: [a, b, c], step: [x, y, z]} a grid along the axes.
std::vector<Vec3d> read_repeat(const YamlView& view) {
  const YamlMap map = view.map("repeat", {"count", "step"});
  const Vec3d step = map.get("step").vector();
  const YamlView count = map.get("count");
  std::vector<Vec3d> offsets;
  if (!count.is_sequence()) {
    const int n = count.integer(1, limits::kCopies);
    for (int i = 0; i < n; ++i) offsets.push_back(i * step);
    return offsets;
  }
  const std::vector<YamlView> parts = count.items();
  if (parts.size() != 3) count.fail("count is a whole number or three of them");
  const int nx = parts[0].integer(1, limits::kCopies);
  const int ny = parts[1].integer(1, limits::kCopies);
  const int nz = parts[2].integer(1, limits::kCopies);
  if (static_cast<double>(nx) * ny * nz > limits::kCopies)
    count.fail("more than " + std::to_string(limits::kCopies) + " copies");
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) offsets.push_back(step.cwiseProduct(Vec3d(i, j, k)));
  return offsets;
}

std::string material_name(const YamlScene& scene, MaterialId id) {
  return scene.model.materials[id.value].name;
}

// materials: {old name: new name} of what a file, group or box brought along.
void replace_materials(YamlScene& scene, Placed& placed, const YamlView& view) {
  std::map<std::string, MaterialId> replacements;
  std::set<std::string> unused;
  const auto named = view.named();
  for (const auto& [old_name, new_name] : named) {
    replacements.emplace(old_name, find_material(scene, new_name));
    unused.insert(old_name);
  }
  std::set<std::string> names;
  for (Model::Node& node : placed.nodes) {
    const std::string name = material_name(scene, node.material);
    names.insert(name);
    const auto found = replacements.find(name);
    if (found == replacements.end()) continue;
    node.material = found->second;
    unused.erase(name);
  }
  for (const auto& [old_name, new_name] : named) {
    if (!unused.contains(old_name)) continue;
    std::string list;
    for (const std::string& name : names) list += " '" + name + "'";
    new_name.fail("nothing here has material '" + old_name + "'; there are:" + list);
  }
}

// All parts of one material become one mesh: a box of one material stays a closed solid.
void add_shape(YamlScene& scene, const YamlMap& map, const std::string& kind,
               const std::string& name, Placed& placed) {
  std::vector<ShapePart> parts = read_shape(kind, map.get(kind), scene.corners_left);
  for (const ShapePart& part : parts) scene.budget.need(bytes_of(part.mesh), map.view().place());
  std::map<std::string, YamlView> own;
  if (const auto materials = map.find("materials")) {
    for (const auto& [part_name, material] : materials->named()) {
      const auto is_part = [&wanted = part_name](const ShapePart& p) { return p.name == wanted; };
      if (std::none_of(parts.begin(), parts.end(), is_part))
        material.fail("a " + kind + " has no part '" + part_name + "' here");
      own.emplace(part_name, material);
    }
  }
  std::vector<std::pair<MaterialId, std::size_t>> done;  // mesh of each material
  for (ShapePart& part : parts) {
    const auto special = own.find(part.name);
    const MaterialId material =
        find_material(scene, special != own.end() ? special->second : map.get("material"));
    const auto same = std::find_if(done.begin(), done.end(),
                                   [&](const auto& entry) { return entry.first == material; });
    if (same == done.end()) {
      done.emplace_back(material, scene.model.meshes.size());
      Model::Node node;
      node.name = name;
      node.mesh = MeshId(scene.model.meshes.size());
      node.material = material;
      placed.nodes.push_back(std::move(node));
      part.mesh.name = name;
      scene.model.meshes.push_back(std::move(part.mesh));
      continue;
    }
    MeshData& mesh = scene.model.meshes[same->second];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.mesh.positions.begin(),
                          part.mesh.positions.end());
    mesh.uvs.insert(mesh.uvs.end(), part.mesh.uvs.begin(), part.mesh.uvs.end());
    for (const Triangle& t : part.mesh.triangles) {
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
}

template <class T>
std::vector<T> take_from(std::vector<T>& all, std::size_t first) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<T> tail(std::make_move_iterator(begin), std::make_move_iterator(all.end()));
  all.erase(begin, all.end());
  return tail;
}

Placed read_model_file(YamlScene& scene, const YamlView& view) {
  const std::filesystem::path file = view.file();
  const auto known = scene.files.find(file.string());
  if (known != scene.files.end()) return known->second;
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".yaml" || ending == ".yml") view.fail("a scene cannot hold another scene file");
  Model& model = scene.model;
  const std::size_t nodes = model.nodes.size();
  const std::size_t lights = model.lights.size();
  const std::size_t cameras = model.cameras.size();
  const std::size_t materials = model.materials.size();
  read_into(model, file, scene.options);
  Placed placed{take_from(model.nodes, nodes), take_from(model.lights, lights),
                take_from(model.cameras, cameras)};
  if (scene.unit == RadianceUnit::Watt) {
    for (Light& light : placed.lights) convert_to_watts(light);
    for (std::size_t i = materials; i < model.materials.size(); ++i) {
      material::SpectralValue& emission = model.materials[i].emission;
      emission = scaled(emission, 1.0 / material::kWhiteLumensPerWatt);
    }
    model.warnings.push_back(file.string() +
                             ": photometric values were divided by 179 lm/W (unit: watt)");
  }
  scene.files[file.string()] = placed;
  return placed;
}

std::size_t size_of(const Placed& p) { return p.nodes.size() + p.lights.size() + p.cameras.size(); }

void check_room(const YamlScene& scene, std::size_t count, const YamlView& view) {
  if (count > scene.placed_left)
    view.fail("more than " + std::to_string(limits::kPlaced) +
              " objects, those of groups and of each level of a nest counted");
}

Placed read_object(YamlScene& scene, const YamlView& view) {
  const YamlMap map = view.map(
      "object", {"name",   "box",   "polygon", "mesh",  "sphere",   "cylinder",   "cage",
                 "file",   "use",   "group",   "light", "material", "materials",  "translate",
                 "rotate", "scale", "matrix",  "at",    "repeat",   "light_group"});
  const std::string kind = map.one_of(
      {"box", "polygon", "mesh", "sphere", "cylinder", "cage", "file", "use", "group", "light"});
  const std::string name = map.has("name") ? map.get("name").text() : kind;
  const YamlView value = map.get(kind);
  Placed content;
  if (is_shape(kind)) {
    add_shape(scene, map, kind, name, content);
  } else if (kind == "file") {
    content = read_model_file(scene, value);
  } else if (kind == "group") {
    content = read_objects(scene, value);
  } else if (kind == "light") {
    content = read_light(
        scene, value.map("light", {"point", "spot", "directional", "ies", "rectangle"}), name);
  } else {
    const auto known = scene.groups.find(value.text());
    if (known == scene.groups.end()) value.fail("no group '" + value.text() + "' above this line");
    content = known->second;
  }
  if (!is_shape(kind)) {
    if (const auto materials = map.find("materials")) {
      replace_materials(scene, content, *materials);
    }
    if (const auto material = map.find("material")) {
      const MaterialId id = find_material(scene, *material);
      for (Model::Node& node : content.nodes) node.material = id;
    }
  }
  put_in_group(content, map);
  Placed placed;
  const std::vector<Eigen::Affine3d> places = read_places(map, read_transform(map));
  check_room(scene, places.size() * size_of(content), view);
  for (const Eigen::Affine3d& place : places) append(scene, placed, content, place, view);
  return placed;
}

}  // namespace

std::vector<Eigen::Affine3d> read_places(const YamlMap& map, const Eigen::Affine3d& base) {
  constexpr double radians = std::numbers::pi / 180.0;
  std::vector<Eigen::Affine3d> places = {base};
  if (const auto at = map.find("at")) {
    places.clear();
    for (const YamlView& item : at->items()) {
      const bool turned = item.items().size() == 4;
      const std::vector<double> p = item.numbers(turned ? 4 : 3);
      const Eigen::AngleAxisd turn(turned ? p[3] * radians : 0.0, Vec3d::UnitY());
      places.push_back(Eigen::Translation3d(p[0], p[1], p[2]) * turn * base);
    }
  }
  const auto repeat = map.find("repeat");
  if (!repeat) return places;
  std::vector<Eigen::Affine3d> copies;
  const std::vector<Vec3d> offsets = read_repeat(*repeat);
  if (offsets.size() * places.size() > limits::kCopies)
    repeat->fail("more than " + std::to_string(limits::kCopies) + " copies");
  for (const Vec3d& offset : offsets) {
    for (const Eigen::Affine3d& place : places)
      copies.push_back(Eigen::Translation3d(offset) * place);
  }
  return copies;
}

void append(YamlScene& scene, Placed& all, const Placed& part, const Eigen::Affine3d& place,
            const YamlView& view) {
  check_room(scene, size_of(part), view);
  scene.placed_left -= size_of(part);
  for (Model::Node node : part.nodes) {
    node.to_world = place * node.to_world;
    all.nodes.push_back(std::move(node));
  }
  // Lights and cameras have a place and a direction, but no size to scale.
  const auto rigid = [&](const Eigen::Affine3d& local) {
    Eigen::Affine3d world = place * local;
    const Eigen::Matrix3d turn = world.rotation();
    world.linear() = turn;
    return world;
  };
  for (Light light : part.lights) {
    light.to_scene = rigid(light.to_scene);
    all.lights.push_back(std::move(light));
  }
  for (Camera camera : part.cameras) {
    camera.to_scene = rigid(camera.to_scene);
    all.cameras.push_back(std::move(camera));
  }
}

void put_in_group(Placed& content, const YamlMap& map) {
  const std::string group = read_light_group(map);
  if (group.empty()) return;
  for (Model::Node& node : content.nodes) node.light_group = group;
  for (Light& light : content.lights) light.light_group = group;
}

std::string read_light_group(const YamlMap& map) {
  const auto view = map.find("light_group");
  if (!view) return {};
  std::string name = view->text();
  if (name.empty() || name.find('=') != std::string::npos)
    view->fail("the name of a light group is a text without '='");
  return name;
}

Placed read_objects(YamlScene& scene, const YamlView& list) {
  Placed all;
  for (const YamlView& item : list.items()) {
    append(scene, all, read_object(scene, item), Eigen::Affine3d::Identity(), item);
  }
  return all;
}

}  // namespace atrium::scene
