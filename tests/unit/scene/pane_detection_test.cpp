#include "import_files.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

using material::Material;

Material glass() {
  Material m;
  m.name = "glass";
  m.medium = Material::Medium::Solid;
  m.k_df = 0.0;
  m.k_rg = m.k_tp_rg = 1.0;
  m.transmission_tint = 0.9;
  return m;
}

/// A closed strip of `columns` cells along a curve in the xz plane, 1 m deep, with a thickness.
/// bend: radius of the curve; 0 is straight.
MeshData slab(double width, double thickness, double bend = 0.0, int columns = 1) {
  MeshData mesh;
  for (int i = 0; i <= columns; ++i) {
    const double s = width * i / columns;
    for (int side = 0; side < 2; ++side) {
      const double h = side == 0 ? 0.0 : thickness;
      for (int k = 0; k < 2; ++k) {
        if (bend > 0.0) {
          mesh.positions.emplace_back((bend + h) * std::sin(s / bend), k,
                                      (bend + h) * std::cos(s / bend) - bend);
        } else {
          mesh.positions.emplace_back(s, k, h);
        }
      }
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
    const std::uint32_t p = 4 * i;
    quad(p, p + 1, p + 5, p + 4);      // lower, facing -z
    quad(p + 2, p + 6, p + 7, p + 3);  // upper
    quad(p, p + 4, p + 6, p + 2);      // front rim
    quad(p + 1, p + 3, p + 7, p + 5);  // back rim
  }
  const std::uint32_t e = 4 * static_cast<std::uint32_t>(columns);
  quad(0, 2, 3, 1);
  quad(e, e + 1, e + 3, e + 2);
  return mesh;
}

Model model_of(MeshData mesh) {
  Model model;
  model.meshes.push_back(std::move(mesh));
  model.materials.push_back(glass());
  Model::Node node;
  node.mesh = MeshId(std::size_t{0});
  node.material = MaterialId(std::size_t{0});
  model.nodes.push_back(node);
  return model;
}

TEST(PaneDetection, AThinSlabBecomesASheetInItsMiddle) {
  const Scene scene = build_scene(model_of(slab(2.0, 0.006)));
  EXPECT_EQ(scene.report.panes_recognised, 1u);
  ASSERT_EQ(scene.objects.size(), 1u);
  const Material& m = scene.material_of(ObjectId(std::size_t{0}));
  EXPECT_EQ(m.medium, Material::Medium::Pane);
  EXPECT_NEAR(m.pane_thickness, 0.006, 1e-7);
  EXPECT_NEAR(std::get<double>(m.transmission_tint), 0.81, 1e-12);  // two crossings of the body
  const Mesh& mesh = scene.meshes[scene.objects[0].mesh.value];
  ASSERT_EQ(mesh.triangles.size(), 2u);
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    area += 0.5 * static_cast<double>((mesh.positions[t[1]] - mesh.positions[t[0]])
                                          .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                                          .norm());
  }
  EXPECT_NEAR(area, 2.0, 1e-6);
  for (const Vec3f& p : mesh.positions)
    EXPECT_NEAR(static_cast<double>(p.z()) + scene.origin.z(), 0.003, 1e-6);
}

TEST(PaneDetection, CanBeSwitchedOff) {
  BuildOptions options;
  options.pane_detection = false;
  const Scene scene = build_scene(model_of(slab(2.0, 0.006)), options);
  EXPECT_EQ(scene.report.panes_recognised, 0u);
  EXPECT_EQ(scene.materials[0].medium, Material::Medium::Solid);
  EXPECT_EQ(scene.triangle_count(), 12u);
}

TEST(PaneDetection, BlocksAndBentSheetsStaySolid) {
  EXPECT_EQ(build_scene(model_of(slab(2.0, 0.06))).report.panes_recognised, 0u);  // too thick
  EXPECT_EQ(build_scene(model_of(slab(0.2, 0.04))).report.panes_recognised, 0u);  // a bar
  EXPECT_EQ(build_scene(model_of(slab(2.0, 0.006, 3.0, 16))).report.panes_recognised, 0u);  // bent
  EXPECT_EQ(build_scene(model_of(slab(2.0, 0.006, 0.0, 16))).report.panes_recognised,
            1u);  // the same, straight
}

TEST(PaneDetection, SlabsAreTakenOutOfAMeshThatHoldsMore) {
  MeshData mesh = slab(2.0, 0.006);
  const MeshData block = slab(1.0, 0.5);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3d& p : block.positions) mesh.positions.push_back(p + Vec3d(0, 0, 3));
  for (const Triangle& t : block.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Scene scene = build_scene(model_of(mesh));
  EXPECT_EQ(scene.report.panes_recognised, 1u);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.triangle_count(), 2u + 12u);
  EXPECT_NEAR(scene.bounds.sizes().z(), 3.5 - 0.003, 1e-5);
}

TEST(PaneDetection, TheWindowsOfARealBuilding) {
  const auto file = test::shared_folder() / "scenes/duplex_apartment.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared scenes beside the project";
  const Scene scene = build_scene(read_model({file}));
  std::size_t panes = 0;
  std::size_t solids = 0;
  for (const Object& object : scene.objects) {
    const Material::Medium medium = scene.materials[object.material.value].medium;
    if (medium == Material::Medium::Pane) ++panes;
    if (medium == Material::Medium::Solid) ++solids;
  }
  EXPECT_EQ(panes, scene.report.panes_recognised);
  EXPECT_GT(panes, 10u);
  EXPECT_EQ(solids, 0u);
}

}  // namespace
}  // namespace atrium::scene
