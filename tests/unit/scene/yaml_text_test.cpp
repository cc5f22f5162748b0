// How the text of a scene file is read: what YAML allows beside the plain form.
#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

TEST_F(YamlScenes, TextMayBeWrittenAsYamlAllows) {
  const Model model = read(
      "# a comment\r\n"
      "materials: {\"pa\\u0069nt: 1\": &white {body: 8.0e-1,   # in a flow\r\n"
      "    c: +10}, 'it''s': {body: .5}, again: *white,\r\n"
      "    changed: &white {body: 0.25}, last: *white}\r\n"
      "cameras:\r\n"
      "- name: >-\r\n"
      "    two\r\n"
      "    lines\r\n"
      "  perspective: {eye: [0, 0, 5], target: !!seq [\r\n"
      "    0, 0,\r\n"
      "    0], yfov: !!float 60}\r\n"
      "objects:\r\n"
      "- {material: 'paint: 1', box: {size: [1, 1, 1]}}\r\n"
      "- {material: it's, box: {size: [1, 1, 1]}}\r\n"
      "- {material: again, box: {size: [1, 1, 1]}}\r\n"
      "- {material: last, box: {size: [1, 1, 1]}}\r\n"
      "...\r\n");
  EXPECT_EQ(number(*material_named(model, "paint: 1").body_reflectance), 0.8);
  EXPECT_EQ(number(*material_named(model, "it's").body_reflectance), 0.5);
  EXPECT_EQ(number(*material_named(model, "again").body_reflectance), 0.8);
  EXPECT_EQ(number(*material_named(model, "last").body_reflectance), 0.25)
      << "the anchor before it counts";
  ASSERT_EQ(model.cameras.size(), 1u);
  EXPECT_EQ(model.cameras[0].name, "two lines");
}

TEST_F(YamlScenes, NothingIsNoTextUnlessItIsQuoted) {
  for (const char* nothing : {"", " ~", " null", " Null", " NULL"}) {
    const std::string message =
        error("materials:\n  a: {body: 0}\ncameras:\n- name:" + std::string(nothing) +
              "\n  panorama: {eye: [0, 0, 0], target: [1, 0, 0]}\n");
    EXPECT_NE(message.find("expected a word"), std::string::npos) << nothing << message;
  }
  const Model model =
      read("cameras:\n- name: 'null'\n  panorama: {eye: [0, 0, 0], target: [1, 0, 0]}\n");
  EXPECT_EQ(model.cameras.at(0).name, "null");
}

// The last one that began before the alias, be it within a value of the same name.
TEST_F(YamlScenes, AnchorsMayBeNamedAgain) {
  const Model model = read(
      "materials: &a {one: &a {body: 0.1}, two: *a, three: {body: &a 0.3}}\n"
      "cameras:\n- {name: c, perspective: {eye: [0, 0, 1], target: [0, *a, 0], yfov: 60}}\n"
      "objects:\n- {material: one, box: {size: [1, 1, 1]}}\n"
      "- {material: two, box: {size: [1, 1, 1]}}\n");
  EXPECT_EQ(number(*material_named(model, "two").body_reflectance), 0.1);
  ASSERT_EQ(model.cameras.size(), 1u);
}

// An UTF-8 mark at the beginning, as some editors write it.
TEST_F(YamlScenes, ByteOrderMarksAreNoText) {
  write("scene.yaml",
        "\xEF\xBB\xBF"
        "atrium: 1\ncameras: [{name: \xC3\xA4, panorama: {eye: [0, 0, 0], target: [1, 0, 0]}}]\n");
  Model model;
  read_yaml(model, folder_ / "scene.yaml", {});
  EXPECT_EQ(model.cameras.at(0).name, "\xC3\xA4");
}

TEST_F(YamlScenes, ErrorsOfTheTextSayWhere) {
  EXPECT_TRUE(error("cameras: [{name: a}\nunit: nit\n").starts_with("scene.yaml:3:"))
      << error("cameras: [{name: a}\nunit: nit\n");
  EXPECT_TRUE(error("unit: nit\n cameras: []\n").starts_with("scene.yaml:3:"));
  write("scene.yaml", "");
  Model model;
  EXPECT_THROW(read_yaml(model, folder_ / "scene.yaml", {}), Error);
  write("scene.yaml", "# nothing but a comment\n");
  EXPECT_THROW(read_yaml(model, folder_ / "scene.yaml", {}), Error);
}

}  // namespace
}  // namespace atrium::scene
