// What a scene file may not say, and how it is told.
#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

TEST_F(YamlScenes, UnknownKeysListTheKnownOnes) {
  const std::string message = error("materials:\n  wall: {bodyy: 0.5}\n");
  EXPECT_TRUE(message.starts_with("scene.yaml:3:10: unknown key 'bodyy' in material 'wall'"))
      << message;
  EXPECT_NE(message.find("known keys: like, medium"), std::string::npos) << message;
  EXPECT_NE(error("colour: 1\n").find("scene.yaml:2:1: unknown key 'colour' in scene"),
            std::string::npos);
  EXPECT_NE(error("lights:\n  - point: {position: [0, 0, 0], intensity: 1, watts: 2}\n")
                .find("unknown key 'watts' in point"),
            std::string::npos);
}

struct Bad {
  const char* name;
  const char* text;
  const char* message;
};
class BadScenes : public YamlScenes, public testing::WithParamInterface<Bad> {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / (std::string("atrium_bad_") + GetParam().name);
    std::filesystem::create_directories(folder_);
  }
};
TEST_P(BadScenes, AreRefused) {
  const std::string message = error(GetParam().text);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_TRUE(message.starts_with("scene.yaml:")) << message;
}
INSTANTIATE_TEST_SUITE_P(
    Yaml, BadScenes,
    testing::Values(
        Bad{"nan", "materials:\n  a: {body: .nan}\n", ":3:13: "},
        Bad{"inf", "materials:\n  a: {extinction: .inf}\n", "'.inf' is no number"},
        Bad{"huge", "lights:\n  - point: {position: [0, 0, 1e999], intensity: 1}\n",
            ":3:30: expected a finite number"},
        Bad{"hex", "lights:\n  - point: {position: [0, 0, 0x10], intensity: 1}\n",
            "expected a finite number"},
        Bad{"reflectance", "materials:\n  a: {body: 1.5}\n", "within 0 and 1"},
        Bad{"rgb_range", "materials:\n  a: {body: [0.1, -0.2, 0.3]}\n", "out of range"},
        Bad{"negative_light", "lights:\n  - point: {position: [0, 0, 0], intensity: -1}\n",
            "must be 0 or more"},
        Bad{"weights", "materials:\n  a: {k_df: 0.5, k_rg: 0.7}\n", "k_df + k_rg must be 1"},
        Bad{"metal", "materials:\n  a: {ior: Xx}\n", "no optical constants for 'Xx'; known:"},
        Bad{"no_material", "objects:\n  - box: {size: [1, 1, 1]}\n", "object needs 'material'"},
        Bad{"two_kinds",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, box: {size: [1, 1, 1]}, "
            "sphere: {radius: 1}}\n",
            "object takes only one of"},
        Bad{"unknown_material", "objects:\n  - {box: {size: [1, 1, 1]}, material: b}\n",
            "no material 'b'; there are: none"},
        Bad{"absolute", "objects:\n  - {file: /etc/hostname}\n", "must lie beside the scene"},
        Bad{"climbing", "objects:\n  - {file: a/../../b.glb}\n", "must lie beside the scene"},
        Bad{"missing", "objects:\n  - {file: b.glb}\n", "no file 'b.glb'"},
        Bad{"itself", "objects:\n  - {file: scene.yaml}\n", "cannot hold another scene"},
        Bad{"twice", "unit: nit\nunit: nit\n", "key 'unit' appears twice"},
        Bad{"version", "unit: nit\natrium2: 1\n", "unknown key"},
        Bad{"syntax", "materials: {a: [1, 2\n", "scene.yaml:"},
        Bad{"document", "unit: nit\n---\natrium: 1\n", "more than one YAML document"},
        Bad{"own_alias", "materials: &a {x: *a}\n", "an alias within its own value"},
        Bad{"own_alias_again", "spectra: {x: &a 1}\nmaterials: &a {x: *a}\n",
            ":3:19: an alias within its own value"},
        Bad{"no_anchor", "materials:\n  a: {body: *grey}\n",
            ":3:13: the alias 'grey' names nothing before it"},
        Bad{"undecodable", "unit: \xff\xfe\n", "scene.yaml:"},
        Bad{"control", "unit: \x01\n", "scene.yaml:"},
        Bad{"tab", "materials:\n\ta: {body: 0}\n", ":3:1: "},
        Bad{"no_power", "materials:\n  a: {emission: {power: 10}}\n",
            ":3:25: no surface has material 'a'"},
        Bad{"copies",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, box: {size: [1, 1, 1]}, "
            "repeat: {count: [1000, 1000, 1000], step: [1, 1, 1]}}\n",
            "more than 100000 copies"},
        Bad{"concave",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, polygon: [[0, 0, 0], "
            "[2, 0, 0], [0.2, 0.2, 0], [0, 2, 0]]}\n",
            "must be convex"},
        Bad{"bent",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, polygon: [[0, 0, 0], "
            "[1, 0, 0], [1, 1, 0.5], [0, 1, 0]]}\n",
            "must be flat"},
        Bad{"index",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, mesh: {vertices: [[0, 0, 0], "
            "[1, 0, 0], [1, 1, 0]], faces: [[0, 1, 3]]}}\n",
            "within 0 and 2"},
        Bad{"singular",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, sphere: {radius: 1}, "
            "scale: [1, 0, 1]}\n",
            "scale must not be 0"},
        Bad{"wavelengths", "spectra:\n  s: {wavelengths: [500, 400], values: [1, 2]}\n",
            "must increase"},
        Bad{"counts", "spectra:\n  s: {wavelengths: [500], values: [1, 2]}\n",
            "as many values as wavelengths"},
        Bad{"falloff", "lights:\n  - point: {position: [0, 0, 0], intensity: 1, falloff: [0, 0]}\n",
            "not both 0"},
        Bad{"cone",
            "lights:\n  - spot: {position: [0, 0, 0], intensity: 1, inner_angle: 50, "
            "outer_angle: 40}\n",
            "must be less than outer_angle"},
        Bad{"direction", "lights:\n  - directional: {irradiance: 1, direction: [0, 0, 0]}\n",
            "must not be zero"},
        Bad{"unit", "unit: candela\n", "expected one of: nit, watt"}),
    [](const auto& bad) { return bad.param.name; });

TEST_F(YamlScenes, HazardsEndInErrorsNotInMemory) {
  EXPECT_NE(error("objects: " + std::string(100000, '[') + "\n").find("scene.yaml:"),
            std::string::npos);
  EXPECT_NE(error("objects: " + std::string(80, '[') + std::string(80, ']') + "\n")
                .find("nested deeper than 64"),
            std::string::npos);
  std::string bomb = "description: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += "k" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += last + (k < 9 ? ", " : "]\n");
  }
  EXPECT_NE(error(bomb).find("more than 2000000 values"), std::string::npos);
  Model model;
  EXPECT_THROW(read_yaml(model, folder_ / "none.yaml", {}), Error);
  write("empty.yaml", "");
  EXPECT_THROW(read_yaml(model, folder_ / "empty.yaml", {}), Error);
  write("other.yaml", "unit: nit\n");
  EXPECT_THROW(read_yaml(model, folder_ / "other.yaml", {}), Error);  // no version
}

TEST_F(YamlScenes, AliasesAreCopies) {
  const Model model = read("materials:\n  a: &m {body: 0.25}\n  b: *m\n");
  EXPECT_EQ(number(*material_named(model, "b").body_reflectance), 0.25);
}

}  // namespace
}  // namespace atrium::scene
