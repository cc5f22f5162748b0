#include <algorithm>
#include <optional>

#include "import_files.h"
#include "material/error.h"
#include "scene/image_io.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

using material::Material;
using test::TempDir;

Material diffuse() {
  Material m;
  m.name = "grey";
  m.body_reflectance = 0.5;
  return m;
}

MeshData box(const Vec3d& low, const Vec3d& high) {
  MeshData mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                                (i & 4) ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Model model_of(MeshData mesh, const Material& material = diffuse(),
               const Eigen::Affine3d& to_world = Eigen::Affine3d::Identity()) {
  Model model;
  model.meshes.push_back(std::move(mesh));
  model.materials.push_back(material);
  Model::Node node;
  node.mesh = MeshId(std::size_t{0});
  node.material = MaterialId(std::size_t{0});
  node.to_world = to_world;
  model.nodes.push_back(node);
  return model;
}

/// Grid of n x n squares over the unit square in the xy plane, facing +z.
MeshData grid(int n) {
  MeshData mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i)
      mesh.positions.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0);
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

double signed_volume(const Scene& scene, ObjectId id) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t) {
    const auto c = scene.corners(id, t);
    sum += c[0].cast<double>().dot(c[1].cast<double>().cross(c[2].cast<double>())) / 6.0;
  }
  return sum;
}

const ObjectId kFirst(std::size_t{0});

TEST(BuildScene, ABoxStaysABoxRoundTheOrigin) {
  const Scene scene = build_scene(model_of(box({10, 0, 0}, {12, 2, 2})));
  ASSERT_EQ(scene.objects.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(mesh.closed);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_EQ(scene.report.meshes_closed, 1u);
  EXPECT_EQ(scene.report.normals_made, 1u);
  EXPECT_EQ(scene.report.triangles_read, 12u);
  EXPECT_EQ(scene.report.triangles_flipped + scene.report.degenerate_dropped +
                scene.report.duplicate_dropped,
            0u);
  EXPECT_NEAR(signed_volume(scene, kFirst), 8.0, 1e-6);
  EXPECT_LT(scene.bounds.center().norm(), 0.25);
  EXPECT_LT((scene.bounds.min() + scene.origin - Vec3d(10, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(scene.triangle_count(), 12u);
}

// A cube of 1 m a million metres away, placed by the node: in single precision its corners would
// snap to 6 cm; after rebasing they are right to a millionth of its size.
TEST(BuildScene, FarFromTheOriginPrecisionIsKept) {
  const Vec3d far(1.0e6 + 0.123456789, -2.0e6 + 0.000123, 3.3e6 + 0.7654321);
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  t.translate(far);
  t.rotate(Eigen::AngleAxisd(0.3, Vec3d(1, 2, 3).normalized()));
  const MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  const Scene scene = build_scene(model_of(mesh, diffuse(), t));
  ASSERT_EQ(scene.meshes[0].positions.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    // The exact difference to the origin, without ever adding the large offset to a small number.
    const Vec3d expected = t.linear() * mesh.positions[i] + (far - scene.origin);
    EXPECT_LT((scene.meshes[0].positions[i].cast<double>() - expected).norm(), 1e-6);
  }
  EXPECT_LT(scene.meshes[0].positions[0].norm(), 3.0f);
}

TEST(BuildScene, FarFromTheOriginInATextFile) {
  const TempDir folder;
  std::string text;
  for (int i = 0; i < 4; ++i) {
    text += "v " + std::to_string(1000000 + (i & 1)) + ".1234567 " + std::to_string(i / 2) +
            ".25 5000000.5\n";
  }
  const Scene scene = build_scene(read_model({folder.write("a.obj", text + "f 1 2 4 3\n")}));
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_NEAR(static_cast<double>(mesh.positions[0].x()) + (scene.origin.x() - 1000000.0),
              0.1234567, 1e-6);
  EXPECT_NEAR(static_cast<double>(mesh.positions[1].x() - mesh.positions[0].x()), 1.0, 1e-6);
}

TEST(BuildScene, LightsAndCamerasMoveWithTheGeometry) {
  Model model = model_of(box({100, 0, 0}, {102, 2, 2}));
  Light light;
  light.to_scene.translate(Vec3d(101, 1.5, 1));
  model.lights.push_back(light);
  Camera camera;
  camera.to_scene.translate(Vec3d(100.5, 1, 1));
  model.cameras.push_back(camera);
  const Scene scene = build_scene(std::move(model));
  EXPECT_EQ(Vec3d(scene.lights[0].to_scene.translation() + scene.origin), Vec3d(101, 1.5, 1));
  EXPECT_EQ(Vec3d(scene.cameras[0].to_scene.translation() + scene.origin), Vec3d(100.5, 1, 1));
}

TEST(Repair, DegenerateAndDuplicateTriangles) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.triangles.push_back({0, 0, 1});             // two corners equal
  mesh.positions.emplace_back(0.5, 0, 0);          // 8: on the edge 0-1
  mesh.triangles.push_back({0, 1, 8});             // collinear
  mesh.positions.emplace_back(mesh.positions[1]);  // 9: a copy of corner 1
  mesh.triangles.push_back({0, 2, 9});             // the first triangle again
  mesh.triangles.push_back({0, 1, 2});             // and from behind
  const Scene scene = build_scene(model_of(mesh));
  EXPECT_EQ(scene.report.degenerate_dropped, 2u);
  EXPECT_EQ(scene.report.duplicate_dropped, 2u);
  EXPECT_EQ(scene.report.vertices_welded, 1u);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 12u);
  EXPECT_TRUE(scene.meshes[0].closed);
}

TEST(Repair, ThinTrianglesAreKept) {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(build_scene(model_of(mesh)).report.degenerate_dropped, 0u);
}

// Both windings of a face light both sides: dropping one would halve the light.
TEST(Repair, TwinsWithOppositeWindingStayOnOneSidedEmitters) {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};
  Material lamp = diffuse();
  lamp.emission = 10.0;
  EXPECT_EQ(build_scene(model_of(mesh, lamp)).meshes[0].triangles.size(), 2u);
  EXPECT_EQ(build_scene(model_of(mesh, diffuse())).meshes[0].triangles.size(), 1u);
}

TEST(Repair, NonFiniteVerticesAreDropped) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.positions[7].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.positions.emplace_back(0, std::numeric_limits<double>::infinity(), 0);
  mesh.triangles.push_back({0, 1, 8});
  const Scene scene = build_scene(model_of(mesh));
  EXPECT_EQ(scene.report.non_finite_dropped, 2u);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 12u - 3u);  // corner 7 is used by three triangles
  for (const Vec3f& p : scene.meshes[0].positions) EXPECT_TRUE(p.allFinite());
  EXPECT_TRUE(scene.bounds.min().allFinite() && scene.bounds.max().allFinite());
}

TEST(Repair, InconsistentClosedPartsAreWoundOutwards) {
  for (const unsigned pattern : {0b1u, 0b101010101010u, 0b111111111110u}) {
    SCOPED_TRACE(pattern);
    MeshData mesh = box({0, 0, 0}, {1, 1, 1});
    unsigned turned = 0;
    for (unsigned i = 0; i < 12; ++i) {
      if ((pattern >> i & 1u) == 0) continue;
      std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
      ++turned;
    }
    const Scene scene = build_scene(model_of(mesh));
    EXPECT_EQ(scene.report.triangles_flipped, turned);
    EXPECT_TRUE(scene.meshes[0].closed);
    EXPECT_NEAR(signed_volume(scene, kFirst), 1.0, 1e-6);
  }
}

TEST(Repair, ConsistentlyInsideOutIsTheAuthorsChoiceExceptForSolids) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(signed_volume(build_scene(model_of(mesh)), kFirst), -1.0, 1e-6);
  Material glass;
  glass.medium = Material::Medium::Solid;
  glass.k_df = 0.0;
  glass.k_rg = glass.k_tp_rg = 1.0;
  const Scene scene = build_scene(model_of(mesh, glass));
  EXPECT_NEAR(signed_volume(scene, kFirst), 1.0, 1e-6);
  EXPECT_EQ(scene.report.triangles_flipped, 12u);
}

TEST(Repair, OpenAndNonManifoldMeshesAreCounted) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.positions.emplace_back(0.5, -1, -1);  // a fin on the edge 0-1
  mesh.triangles.push_back({0, 1, 8});
  const Scene scene = build_scene(model_of(mesh));
  EXPECT_EQ(scene.report.non_manifold_edges, 1u);
  EXPECT_FALSE(scene.meshes[0].closed);
  EXPECT_EQ(scene.report.meshes_closed, 0u);
  EXPECT_FALSE(build_scene(model_of(grid(2))).meshes[0].closed);
}

TEST(Repair, TJunctionsAreCounted) {
  // One large triangle over the lower edge of two small ones that meet in its middle.
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 0, 0}, {0.5, 1, 0}, {1.5, 1, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 4}, {3, 1, 5}};
  EXPECT_EQ(build_scene(model_of(mesh)).report.t_junctions, 1u);
  EXPECT_EQ(build_scene(model_of(grid(8))).report.t_junctions, 0u);
}

TEST(Repair, BrokenNormalsBecomeGeometric) {
  MeshData mesh = grid(1);
  mesh.normals = {Vec3f(0, 0, 5), Vec3f::Zero(),
                  Vec3f(0, 0, std::numeric_limits<float>::quiet_NaN()), Vec3f(0, 1e-12f, 0)};
  const Scene scene = build_scene(model_of(mesh));
  const std::vector<Vec3f>& n = scene.meshes[0].normals;
  ASSERT_EQ(n.size(), 4u);
  EXPECT_EQ(n[0], Vec3f(0, 0, 1));
  EXPECT_EQ(n[1], Vec3f(0, 0, 1));
  EXPECT_EQ(n[2], Vec3f(0, 0, 1));
  EXPECT_LT((n[3] - Vec3f(0, 1, 0)).norm(), 1e-6f);
  EXPECT_EQ(scene.report.normals_made, 0u);
}

TEST(Repair, SwitchedOffItOnlyRemovesWhatRaysCannotStand) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.positions.emplace_back(std::numeric_limits<double>::infinity(), 0, 0);
  mesh.triangles.push_back({0, 1, 8});
  BuildOptions options;
  options.repair = false;
  const Scene scene = build_scene(model_of(mesh), options);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 13u);
  EXPECT_EQ(scene.report.non_finite_dropped, 1u);
  EXPECT_EQ(scene.report.duplicate_dropped, 0u);
}

// A mirrored node shows the author's front: the winding turns, so that the volume stays positive
// and the normals still agree with it.
TEST(Instances, MirroredNodesKeepTheirFront) {
  MeshData mesh = box({0, 0, 0}, {1, 1, 1});
  for (const Vec3d& p : mesh.positions)
    mesh.normals.push_back((p - Vec3d(0.5, 0.5, 0.5)).normalized().cast<float>());
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear().diagonal() = Vec3d(-2, 1, 1);
  const Scene scene = build_scene(model_of(mesh, diffuse(), mirror));
  EXPECT_NEAR(signed_volume(scene, kFirst), 2.0, 1e-6);
  const Mesh& out = scene.meshes[0];
  for (const Triangle& t : out.triangles) {
    const Vec3f ng = (out.positions[t[1]] - out.positions[t[0]])
                         .cross(out.positions[t[2]] - out.positions[t[0]]);
    for (const std::uint32_t v : t) EXPECT_GT(ng.dot(out.normals[v]), 0.0f);
  }
}

TEST(Instances, LargeMeshesAreSharedSmallOnesCopied) {
  for (const int n : {4, 8}) {
    Model model = model_of(grid(n));
    model.nodes.push_back(model.nodes[0]);
    model.nodes.push_back(model.nodes[0]);
    model.nodes[1].to_world.translate(Vec3d(0, 0, 2));
    model.nodes[2].to_world.scale(Vec3d(1, 1, -1)).translate(Vec3d(0, 0, 3));
    const Scene scene = build_scene(std::move(model));
    ASSERT_EQ(scene.objects.size(), 3u);
    const std::uint64_t triangles = static_cast<std::uint64_t>(2 * n * n);
    EXPECT_EQ(scene.triangle_count(), 3 * triangles);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(scene.objects[i].first_triangle, i * triangles);
    const bool shared = n == 8;  // 128 triangles; 32 are copied
    EXPECT_EQ(scene.objects[0].instanced, shared);
    EXPECT_EQ(scene.objects[0].mesh == scene.objects[1].mesh, shared);
    EXPECT_EQ(scene.report.meshes_shared, shared ? 1u : 0u);
    const double heights[] = {0.0, 2.0, -3.0};
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t h = 0; h < 3; ++h) {
        const auto c = scene.corners(ObjectId(i), 5);
        if (std::abs(static_cast<double>(c[0].z()) + scene.origin.z() - heights[h]) > 1e-6)
          continue;
        ++found;
        const float up = (c[1] - c[0]).cross(c[2] - c[0]).z();
        EXPECT_TRUE(h == 2 ? up < 0.0f : up > 0.0f);  // the mirrored one shows its front downwards
      }
    }
    EXPECT_EQ(found, 3u);
  }
}

TEST(Instances, SharedMeshesFarAwayKeepTheirPrecision) {
  MeshData mesh = grid(8);
  for (Vec3d& p : mesh.positions) p += Vec3d(1e6, 0, 0);
  Model model = model_of(mesh);
  model.nodes.push_back(model.nodes[0]);
  model.nodes[1].to_world.translate(Vec3d(0, 0, 4));
  const Scene scene = build_scene(std::move(model));
  ASSERT_TRUE(scene.objects[0].instanced);
  const auto c = scene.corners(kFirst, 0);
  EXPECT_NEAR(static_cast<double>(c[1].x() - c[0].x()), 0.125, 1e-7);
}

TEST(BuildScene, TwinsInOtherObjectsStayAndAreCounted) {
  Model model = model_of(grid(2));
  model.nodes.push_back(model.nodes[0]);
  const Scene scene = build_scene(std::move(model));
  EXPECT_EQ(scene.triangle_count(), 16u);
  EXPECT_EQ(scene.report.coplanar_twins, 8u);
  EXPECT_EQ(scene.report.duplicate_dropped, 0u);
}

TEST(BuildScene, WhatCannotBeAScene) {
  EXPECT_THROW(static_cast<void>(build_scene({})), Error);
  MeshData flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_THROW(static_cast<void>(build_scene(model_of(flat))), Error);
  MeshData wrong = grid(1);
  wrong.triangles[0][0] = 77;
  EXPECT_THROW(static_cast<void>(build_scene(model_of(wrong))), Error);
  Material bad = diffuse();
  bad.k_df = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(build_scene(model_of(grid(1), bad))), Error);
}

// Every real model loads. Exact counts where the models' own list of faults counts the same thing
// (it welds at 1e-7 of the diagonal, we only drop what is exactly double or without area).
TEST(RealModels, LoadWithTheirCounts) {
  struct Expected {
    const char* name;
    std::uint64_t triangles;
    std::optional<std::uint64_t> degenerate;
    std::optional<std::uint64_t> duplicate;  ///< within an object or in another one
  };
  const std::vector<Expected> all = {
      {"lbl_office", 24892, 2464, 0},         {"soda_shoppe", 66148, 7200, 0},
      {"modern_hall", 31087, 2432, 0},        {"veach_ajar", 382690, {}, {}},
      {"wooden_staircase", 262663, {}, {}},   {"breakfast_room", 269542, {}, 0},
      {"grey_white_room", 143169, {}, 0},     {"duplex_apartment", 39018, 0, 2184},
      {"openarena_oa_shouse", 20341, 236, 0}, {"contemporary_bathroom", 592188, {}, 95}};
  const auto folder = test::shared_folder() / "scenes";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no shared scenes beside the project";
  for (const Expected& want : all) {
    SCOPED_TRACE(want.name);
    BuildOptions options;
    options.pane_detection = false;
    const Scene scene =
        build_scene(read_model({folder / (std::string(want.name) + ".glb")}), options);
    const LoadReport& r = scene.report;
    EXPECT_EQ(r.triangles_read, want.triangles);
    if (want.degenerate) {
      EXPECT_EQ(r.degenerate_dropped, *want.degenerate);
    }
    if (want.duplicate) {
      EXPECT_EQ(r.duplicate_dropped + r.coplanar_twins, *want.duplicate);
    }
    EXPECT_EQ(scene.triangle_count() + r.degenerate_dropped + r.duplicate_dropped,
              r.triangles_read);
    EXPECT_EQ(r.non_finite_dropped, 0u);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "main");
    EXPECT_TRUE(r.warnings.empty() || !image_io_available());
    for (const Mesh& mesh : scene.meshes) {
      for (const Triangle& t : mesh.triangles) {
        ASSERT_LT(*std::max_element(t.begin(), t.end()), mesh.positions.size());
      }
    }
  }
}

}  // namespace
}  // namespace atrium::scene
