#include "fields.h"

#include <algorithm>

#include "common/suggest.h"
#include "material/error.h"

namespace atrium::view {
namespace {

struct Known {
  const char* name;
  const char* title;
  const char* array;
  Look look;
  bool sided;
  bool has_unit;
};
constexpr Known kKnown[] = {
    {"radiosity", "radiosity", "radiosity", Look::TrueColour, true, true},
    {"illuminance", "illuminance", "irradiance", Look::Scale, true, false},
    {"irradiance", "irradiance", "irradiance", Look::Scale, true, true},
    {"direct", "direct irradiance", "irradiance_direct", Look::Scale, true, true},
    {"caustic", "caustic irradiance", "irradiance_caustic", Look::Scale, true, true},
    {"indirect", "indirect irradiance", "irradiance_indirect", Look::Scale, true, true},
    {"error", "standard error", "stderr", Look::Error, true, true},
    {"level", "level of elements", "level", Look::Classes, false, false},
    {"element", "element", "element_id", Look::Classes, false, false},
    {"material", "material", "material_id", Look::Classes, false, false},
    {"object", "object", "object_id", Look::Classes, false, false},
    {"reflectance", "reflectance", "reflectance", Look::Surface, false, false},
    {"emission", "exitance of lamps", "emission", Look::Scale, false, true}};

const Array* any_array(const Mesh& mesh, const std::string& name) {
  if (const Array* a = find_array(mesh.polygons.cell_arrays, name)) return a;
  return find_array(mesh.polygons.point_arrays, name);
}

/// Irradiance is in lux where what leaves a surface is in lumens per square metre.
std::string unit_of(const Mesh& mesh, const Known& field) {
  const auto unit = mesh.polygons.field_data.find("unit");
  if (unit == mesh.polygons.field_data.end() || unit->second.empty() || !field.has_unit) return "";
  const std::string_view array = field.array;
  const bool leaves = array == "radiosity" || array == "emission";
  return leaves && unit->second[0] == "lx" ? "lm/m^2" : unit->second[0];
}

std::string with_unit(const std::string& title, const std::string& unit) {
  return unit.empty() ? title : title + " [" + unit + "]";
}

/// What the arrays of known fields bring along.
bool belongs_to_known(const std::string& array) {
  if (array == "front_valid" || array == "back_valid" || array == "illuminance_lux") return true;
  std::string front = array.substr(0, array.find('.'));  // of a light group
  if (front.ends_with("_back")) front.resize(front.size() - 5);
  return std::any_of(std::begin(kKnown), std::end(kKnown),
                     [&](const Known& k) { return front == k.array; });
}

void add_others(const std::vector<Array>& arrays, std::vector<Field>& fields) {
  for (const Array& a : arrays) {
    const bool there =
        std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == a.name; });
    if (there || belongs_to_known(a.name)) continue;
    fields.push_back({a.name, a.name, a.name, Look::Scale, false, false});
  }
}

}  // namespace

std::vector<Field> fields_of(const Mesh& mesh) {
  std::vector<Field> fields;
  for (const Known& k : kKnown) {
    const Array* array = any_array(mesh, k.array);
    if (array == nullptr) continue;
    if (k.look == Look::TrueColour && array->components != 3) continue;
    const bool lux = std::string_view(k.name) == "illuminance";
    fields.push_back(
        {k.name, with_unit(k.title, lux ? "lx" : unit_of(mesh, k)), k.array, k.look, k.sided, lux});
  }
  // Without irradiance, the illuminance that somebody wrote alone.
  if (any_array(mesh, "irradiance") == nullptr && any_array(mesh, "illuminance_lux") != nullptr)
    fields.push_back(
        {"illuminance", "illuminance [lx]", "illuminance_lux", Look::Scale, false, false});
  add_others(mesh.polygons.point_arrays, fields);
  add_others(mesh.polygons.cell_arrays, fields);
  return fields;
}

std::size_t find_field(const std::vector<Field>& fields, const std::string& name) {
  const auto index = [&](const std::string& wanted) {
    return static_cast<std::size_t>(
        std::find_if(fields.begin(), fields.end(),
                     [&](const Field& f) { return f.name == wanted || f.array == wanted; }) -
        fields.begin());
  };
  if (name.empty()) {
    for (const char* preferred : {"radiosity", "illuminance"})
      if (const std::size_t i = index(preferred); i < fields.size()) return i;
    return 0;
  }
  const std::size_t found = index(name == "illuminance_lux" ? "illuminance" : name);
  if (found < fields.size()) return found;
  std::vector<std::string_view> known;
  known.reserve(fields.size());
  for (const Field& f : fields) known.push_back(f.name);
  throw Error("--field " + name + ": unknown" +
              (known.empty() ? "; the mesh has no arrays" : app::suggestion(name, known)));
}

std::vector<std::string> light_groups_of(const Mesh& mesh) {
  std::vector<std::string> groups;
  const auto known = [&](const std::string& group) {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
  };
  const std::string prefix = "irradiance.";
  for (const auto* arrays : {&mesh.polygons.point_arrays, &mesh.polygons.cell_arrays})
    for (const Array& a : *arrays) {
      if (!a.name.starts_with(prefix)) continue;
      const std::string group = a.name.substr(prefix.size());
      const bool back = group.ends_with("_back") && known(group.substr(0, group.size() - 5));
      if (!back && !known(group)) groups.push_back(group);
    }
  return groups;
}

const Array* find_group_array(const std::vector<Array>& arrays, const std::string& quantity,
                              bool back, const std::string& group) {
  if (!back) return find_array(arrays, quantity + "." + group);
  const Array* a = find_array(arrays, quantity + "_back." + group);
  return a != nullptr ? a : find_array(arrays, quantity + "." + group + "_back");
}

}  // namespace atrium::view
