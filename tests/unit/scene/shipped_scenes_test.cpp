// The scenes that come with the project.
#include "scene/ray_query.h"

#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

struct Shipped {
  const char* file;
  std::size_t fewest_nodes;
  bool has_cage;
};
class ShippedScenes : public testing::TestWithParam<Shipped> {};
TEST_P(ShippedScenes, Load) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes" / GetParam().file, {});
  EXPECT_GE(model.nodes.size(), GetParam().fewest_nodes);
  EXPECT_FALSE(model.cameras.empty());
  EXPECT_TRUE(model.warnings.empty());
  bool cage = false;
  for (const MeshData& mesh : model.meshes) cage = cage || mesh.cage.has_value();
  EXPECT_EQ(cage, GetParam().has_cage);
  bool light = model.environment.has_value() || !model.lights.empty();
  for (const material::Material& m : model.materials) light = light || m.emissive();
  EXPECT_TRUE(light);
  const Scene scene = build_scene(std::move(model));
  EXPECT_EQ(scene.report.non_finite_dropped, 0u);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScenes,
                         testing::Values(Shipped{"cornell/cornell.yaml", 8, false},
                                         Shipped{"furnace/furnace.yaml", 3, false},
                                         Shipped{"glass_and_mirror/glass_and_mirror.yaml", 10,
                                                 false},
                                         Shipped{"office/office.yaml", 300, true},
                                         Shipped{"lounge/lounge.yaml", 40, true},
                                         Shipped{"paper/paper.yaml", 8, false}));

// Spot checks against the published tables (400, 528, 700 nm), and the balance that makes the
// red wall red.
TEST(ShippedScenes, CornellSpectraAreThePublishedOnes) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes/cornell/cornell.yaml", {});
  const auto value = [&](const char* name, double nm) {
    return std::get<SampledSpectrum>(*material_named(model, name).body_reflectance).at(nm);
  };
  EXPECT_DOUBLE_EQ(value("white", 400), 0.343);
  EXPECT_DOUBLE_EQ(value("white", 456), 0.777);
  EXPECT_DOUBLE_EQ(value("white", 700), 0.737);
  EXPECT_DOUBLE_EQ(value("green", 528), 0.481);
  EXPECT_DOUBLE_EQ(value("green", 700), 0.159);
  EXPECT_DOUBLE_EQ(value("red", 400), 0.040);
  EXPECT_DOUBLE_EQ(value("red", 688), 0.657);
  EXPECT_NEAR(luminance_of(material_named(model, "lamp").emission), 12000.0, 1e-2);
}

// The office stands on 130 m x 120 m of ground: the view is chosen inside it, standing, level, and
// the same every time.
TEST(ShippedScenes, InteriorViewOfTheOfficeIsInTheRoom) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes/office/office.yaml", {});
  const Scene scene = build_scene(std::move(model));
  const RayQuery query(scene);
  const Camera camera = choose_interior_view(scene, query);
  const Vec3d eye = camera.to_scene.translation() + scene.origin;
  const Bounds room(Vec3d(0.3, 1.0, 0.3), Vec3d(12.9, 2.0, 6.9));
  EXPECT_TRUE(room.contains(eye)) << eye.transpose();
  EXPECT_NEAR(camera.to_scene.linear().col(2).y(), 0.0, 1e-9);
  EXPECT_TRUE(choose_interior_view(scene, query).to_scene.isApprox(camera.to_scene, 0.0));
}

}  // namespace
}  // namespace atrium::scene
