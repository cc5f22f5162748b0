#include "material_query/kinds.h"

#include "common/json.h"
#include "material/error.h"
#include "material_query/query.h"

namespace atrium::material_query {
namespace {

std::string valid_of(const Input& input) {
  switch (input.type) {
    case Input::Type::Number:
      return input.range.describe();
    case Input::Type::NumberOrNull:
      return input.range.describe() + " or null";
    case Input::Type::Numbers:
      return std::to_string(input.count) + " numbers " + input.range.describe();
    case Input::Type::Direction:
      return "unit vector";
    case Input::Type::Flag:
      return "true or false";
    case Input::Type::Text:
      return "text";
    case Input::Type::Lights:
      return "array of {l, J, r}";
  }
  return {};
}

}  // namespace

const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> all = [] {
    std::vector<Kind> kinds;
    for (const auto& list : {fresnel_kinds(), paper_kinds(), facet_kinds(), interface_kinds(),
                             parameter_kinds(), model_kinds(), material_kinds(), bsdf_kinds()})
      kinds.insert(kinds.end(), list.begin(), list.end());
    return kinds;
  }();
  return all;
}

Vec3d viewer_above(const Inputs& in) {
  Vec3d b = in.direction("b");
  if (!(b.z() >= 0.0)) {
    std::string z;
    app::append_json_number(z, b.z());
    throw Error("z of b is " + z + ", must be at least 0: the viewer is above the surface");
  }
  return b;
}

std::string kinds_as_markdown() {
  std::string text = "| kind | inputs | values |\n| --- | --- | --- |\n";
  for (const Kind& kind : all_kinds()) {
    text += "| `" + std::string(kind.name) + "`: " + std::string(kind.meaning) + " | ";
    for (std::size_t i = 0; i < kind.inputs.size(); ++i) {
      const Input& input = kind.inputs[i];
      text += (i > 0 ? "; `" : "`") + std::string(input.name) + "` " + std::string(input.meaning) +
              ", " + valid_of(input) + (input.required ? "" : " (optional)");
    }
    text += " | " + std::string(kind.values) + " |\n";
  }
  return text;
}

std::string kinds_as_json() {
  app::JsonWriter json;
  json.begin_array();
  for (const Kind& kind : all_kinds()) {
    json.begin_object();
    json.member("kind", kind.name);
    json.member("meaning", kind.meaning);
    json.begin_array("inputs");
    for (const Input& input : kind.inputs) {
      json.begin_object();
      json.member("name", input.name);
      json.member("meaning", input.meaning);
      json.member("valid", valid_of(input));
      json.member("required", input.required);
      json.end();
    }
    json.end();
    json.member("values", kind.values);
    json.end();
  }
  json.end();
  return json.text();
}

}  // namespace atrium::material_query
