#include <iterator>
#include <set>

#include "material/error.h"
#include "scene/scene_io.h"
#include "yaml_scene.h"

namespace atrium::scene {
namespace {

void read_unit(YamlScene& scene, const YamlMap& top) {
  if (const auto unit = top.find("unit")) {
    scene.unit = unit->choice({"nit", "watt"}) == 0 ? RadianceUnit::Nit : RadianceUnit::Watt;
  }
  Model& model = scene.model;
  const bool fresh = model.nodes.empty() && model.lights.empty() && !model.environment;
  if (!fresh && model.unit != scene.unit) {
    top.view().fail("this scene's unit is not that of the files before it");
  }
  model.unit = scene.unit;
}

void add_to_model(Model& model, Placed placed) {
  const auto move_all = [](auto& from, auto& to) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  move_all(placed.nodes, model.nodes);
  move_all(placed.lights, model.lights);
  move_all(placed.cameras, model.cameras);
}

void read_cameras(Model& model, const YamlView& list) {
  // The scene's own cameras come before those of the files that it refers to.
  std::vector<Camera> cameras;
  for (const YamlView& item : list.items()) cameras.push_back(read_camera(item));
  model.cameras.insert(model.cameras.end(), cameras.begin(), cameras.end());
}

/// Those of the names that stand somewhere in the file as a value.
std::set<std::string> mentioned(const YamlNode& tree, const std::set<std::string>& names) {
  std::set<std::string> found;
  std::vector<const YamlNode*> open{&tree};
  while (!open.empty()) {
    const YamlNode& node = *open.back();
    open.pop_back();
    if (names.contains(node.text)) found.insert(node.text);
    for (const YamlNode& item : node.items) open.push_back(&item);
    for (const YamlNode::Entry& entry : node.entries) open.push_back(&entry.value);
  }
  return found;
}

void read_needed_materials(YamlScene& scene, const YamlNode& tree, const YamlView& view) {
  std::set<std::string> names;
  for (const auto& [name, value] : view.named()) names.insert(name);
  read_materials(scene, view, mentioned(tree, names));
}

}  // namespace

void read_yaml(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  const YamlNode tree = load_yaml(file);
  YamlScene scene{model,
                  options,
                  file.string(),
                  RadianceUnit::Nit,
                  {},
                  {},
                  {},
                  {},
                  {},
                  {},
                  ModelBudget(model, options)};
  const YamlMap top = YamlView(tree, scene.file)
                          .map("scene", {"atrium", "description", "unit", "spectra", "materials",
                                         "groups", "objects", "lights", "cameras", "environment",
                                         "sky", "sun", "north", "portals", "medium"});
  if (top.get("atrium").number() != 1.0) top.get("atrium").fail("this version reads atrium: 1");
  read_unit(scene, top);
  const std::size_t first_node = model.nodes.size();

  // The order is that of use: each part may refer to the ones before it, wherever it stands.
  if (const auto view = top.find("spectra")) read_spectra(scene, *view);
  if (const auto view = top.find("materials")) read_needed_materials(scene, tree, *view);
  if (const auto view = top.find("groups")) {
    for (const auto& [name, list] : view->named()) scene.groups[name] = read_objects(scene, list);
  }
  if (const auto view = top.find("cameras")) read_cameras(model, *view);
  if (const auto view = top.find("objects")) add_to_model(model, read_objects(scene, *view));
  if (const auto view = top.find("lights")) add_to_model(model, read_lights(scene, *view));
  if (const auto view = top.find("environment")) {
    if (model.environment) view->fail("a file before this one has an environment already");
    model.environment = read_environment(scene, *view);
  }
  read_daylight(scene, top);
  if (const auto view = top.find("portals")) read_portals(scene, *view);
  if (const auto view = top.find("medium")) {
    if (material::max_value(model.medium_extinction) > 0.0)
      view->fail("a file before this one has a medium already");
    model.medium_extinction =
        read_extinction(scene, view->map("medium", {"extinction"}).get("extinction"));
  }
  resolve_powers(scene, first_node);
}

}  // namespace atrium::scene
