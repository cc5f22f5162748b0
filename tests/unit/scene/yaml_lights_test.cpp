// Lights, cameras and the air in scene files.
#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

TEST_F(YamlScenes, Lights) {
  write("lamp.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 180\n0\n100 100\n");
  const Model model = read(
      "lights:\n"
      "  - {name: p, point: {position: [1, 2, 3], flux: 100, falloff: [0.5, 2]}}\n"
      "  - {spot: {position: [0, 3, 0], target: [0, 3, -5], intensity: [10, 20, 30],\n"
      "     inner_angle: 10, outer_angle: 30}}\n"
      "  - {directional: {direction: [0, -2, 0], irradiance: 50000, angular_diameter: 0.53}}\n"
      "  - {ies: {file: lamp.ies, position: [0, 2, 0], flux: 1000}}\n"
      "  - {rectangle: {center: [0, 2.5, 0], size: [1, 2], radiance: 500}, "
      "repeat: {count: 2, step: [3, 0, 0]}}\n"
      "environment: {radiance: [1, 2, 3], rotate: 90}\n");
  ASSERT_EQ(model.lights.size(), 4u);
  const auto& point = std::get<PointLight>(model.lights[0].kind);
  EXPECT_NEAR(number(point.intensity), 100.0 / (4.0 * kPi), 1e-12);
  EXPECT_EQ(point.falloff.c1, 0.5);
  EXPECT_EQ(point.falloff.c2, 2.0);
  EXPECT_EQ(model.lights[0].to_scene.translation(), Vec3d(1, 2, 3));
  const auto axis = [&](std::size_t i) {
    return (model.lights[i].to_scene.linear() * Vec3d(0, 0, -1)).eval();
  };
  EXPECT_TRUE(axis(1).isApprox(Vec3d(0, 0, -1), 1e-12));
  EXPECT_NEAR(std::get<SpotLight>(model.lights[1].kind).outer_angle, kPi / 6.0, 1e-6);
  EXPECT_TRUE(axis(2).isApprox(Vec3d(0, -1, 0), 1e-12));
  EXPECT_NEAR(std::get<DirectionalLight>(model.lights[2].kind).angular_radius, 0.265 * kPi / 180.0,
              1e-8);
  EXPECT_TRUE(axis(3).isApprox(Vec3d(0, -1, 0), 1e-12));
  const auto& profile = std::get<ProfileLight>(model.lights[3].kind);
  EXPECT_NEAR(number(profile.scale) * profile.profile.flux(), 1000.0, 1e-9);
  // Phi = 0 lies along x for a luminaire that looks down.
  EXPECT_TRUE((model.lights[3].to_scene.linear() * Vec3d(1, 0, 0)).isApprox(Vec3d(1, 0, 0), 1e-12));
  ASSERT_EQ(model.nodes.size(), 2u);
  const MeshData& mesh = model.meshes[model.nodes[0].mesh.value];
  const Triangle& t = mesh.triangles[0];
  const auto corner = [&](std::size_t i) -> Vec3d {
    return model.nodes[1].to_world * mesh.positions[t[i]];
  };
  const Vec3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  EXPECT_TRUE(normal.isApprox(Vec3d(0, -1, 0), 1e-12)) << "lights the floor, not the ceiling";
  EXPECT_NEAR(area_of(mesh), 2.0, 1e-12);
  EXPECT_TRUE(model.nodes[1].to_world.translation().isApprox(Vec3d(3, 2.5, 0), 1e-12));
  ASSERT_TRUE(model.environment);
  EXPECT_EQ(std::get<Rgb>(model.environment->radiance), make_rgb(1, 2, 3));
}

// A scene in watts takes a luminaire's candela at 179 lm/W.
TEST_F(YamlScenes, WattsAndLumens) {
  write("lamp.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 180\n0\n100 100\n");
  const Model model =
      read("unit: watt\nlights:\n  - {ies: {file: lamp.ies, position: [0, 2, 0]}}\n");
  EXPECT_EQ(model.unit, RadianceUnit::Watt);
  EXPECT_NEAR(number(std::get<ProfileLight>(model.lights[0].kind).scale), 1.0 / 179.0, 1e-12);
}

TEST_F(YamlScenes, Cameras) {
  const Model model = read(
      "cameras:\n"
      "  - {name: a, perspective: {eye: [1, 2, 3], target: [1, 2, 9], yfov: 45, aspect: 1.5}}\n"
      "  - {name: b, orthographic: {eye: [0, 9, 0], direction: [0, -1, 0], height: 4}}\n"
      "  - {panorama: {eye: [0, 1, 0], direction: [1, 0, 0]}}\n");
  ASSERT_EQ(model.cameras.size(), 3u);
  EXPECT_NEAR(model.cameras[0].yfov, kPi / 4.0, 1e-12);
  EXPECT_EQ(model.cameras[0].aspect, 1.5);
  const auto middle = [&](std::size_t i) {
    return model.cameras[i].ray({0.5, 0.5}, 1.0).direction;
  };
  EXPECT_TRUE(middle(0).isApprox(Vec3f(0, 0, 1), 1e-6f));
  // Looking along +z with y up, the right side of the picture is at -x.
  EXPECT_LT(model.cameras[0].ray({1.0, 0.5}, 1.0).direction.x(), -0.1f);
  EXPECT_EQ(model.cameras[1].kind, Camera::Kind::Orthographic);
  EXPECT_TRUE(middle(1).isApprox(Vec3f(0, -1, 0), 1e-6f));
  EXPECT_TRUE(middle(2).isApprox(Vec3f(1, 0, 0), 1e-6f));
}

TEST_F(YamlScenes, MediumIsTheExtinctionOfTheAir) {
  EXPECT_EQ(std::get<double>(read("objects: []\n").medium_extinction), 0.0);
  const Model model = read("medium: {extinction: [0.1, 0.2, 0.3]}\n");
  EXPECT_EQ(std::get<Rgb>(model.medium_extinction), make_rgb(0.1, 0.2, 0.3));
  EXPECT_NE(error("medium: {extinction: -1}\n"), "");
  EXPECT_NE(error("medium: {density: 1}\n").find("extinction"), std::string::npos);
  EXPECT_NE(error("medium: {}\n"), "");
}

}  // namespace
}  // namespace atrium::scene
