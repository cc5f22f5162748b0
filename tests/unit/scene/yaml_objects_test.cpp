// Shapes, groups, cages and model files in scene files.
#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

TEST_F(YamlScenes, ShapesHaveTheirVolumes) {
  const Model model = read(
      "materials: {a: {body: 0.5}}\n"
      "objects:\n"
      "  - {material: a, box: {min: [1, 2, 3], max: [2, 4, 6]}}\n"
      "  - {material: a, sphere: {center: [1, 2, 3], radius: 2, segments: 256}}\n"
      "  - {material: a, cylinder: {from: [0, 0, 0], to: [3, 4, 0], radius: 0.5, segments: 256}}\n"
      "  - {material: a, mesh: {vertices: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],\n"
      "     faces: [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}}\n"
      "  - {material: a, box: {size: [1, 1, 1], inside: true}}\n"
      "  - {material: a, cylinder: {from: [0, 1, 0], to: [0, 0, 0], radius: 1, open: true}}\n");
  ASSERT_EQ(model.nodes.size(), 6u);
  const auto mesh = [&](std::size_t i) -> const MeshData& {
    return model.meshes[model.nodes[i].mesh.value];
  };
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(open_edges(mesh(i)), 0u) << i;
  EXPECT_GT(open_edges(mesh(5)), 0u);
  EXPECT_NEAR(volume_of(mesh(0)), 6.0, 1e-12);
  // n segments lack a share of about (2 pi / n)^2 / 2 = 3e-4 of the ball's volume.
  EXPECT_NEAR(volume_of(mesh(1)) / (4.0 / 3.0 * kPi * 8.0), 1.0, 4e-4);
  EXPECT_NEAR(volume_of(mesh(2)) / (kPi * 0.25 * 5.0), 1.0, 2e-4);
  EXPECT_NEAR(volume_of(mesh(3)), 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(volume_of(mesh(4)), -1.0, 1e-12);
  for (std::size_t i = 0; i < mesh(1).positions.size(); ++i) {
    const Vec3d n = (mesh(1).positions[i] - Vec3d(1, 2, 3)) / 2.0;
    EXPECT_GT(n.dot(mesh(1).normals[i].cast<double>()), 1.0 - 1e-6);
  }
  EXPECT_NEAR(area_of(mesh(5)) / (2.0 * kPi), 1.0, 1e-3);
}

TEST_F(YamlScenes, BoxSidesTakeTheirOwnMaterials) {
  const Model model = read(
      "materials: {a: {body: 0.5}, b: {body: 0.1}, c: {body: 0.2}}\n"
      "objects:\n"
      "  - {material: a, materials: {bottom: b, top: c}, box: {size: [2, 3, 4], omit: [front]}}\n");
  std::map<std::string, double> area;
  for (const Model::Node& node : model.nodes) {
    area[model.materials[node.material.value].name] += area_of(model.meshes[node.mesh.value]);
  }
  EXPECT_NEAR(area["a"], 12.0 + 12.0 + 6.0, 1e-12);  // left, right, back
  EXPECT_NEAR(area["b"], 8.0, 1e-12);
  EXPECT_NEAR(area["c"], 8.0, 1e-12);
  EXPECT_NE(
      error("materials: {a: {body: 0.5}}\nobjects:\n  - {material: a, materials: {frontt: a}, "
            "box: {size: [2, 3, 4]}}\n")
          .find("has no part 'frontt'"),
      std::string::npos);
}

TEST_F(YamlScenes, GroupsPlaceTheirParts) {
  const Model model = read(
      "materials: {a: {body: 0.5}, b: {body: 0.1}}\n"
      "groups:\n"
      "  pair:\n"
      "    - {name: cube, material: a, box: {size: [1, 1, 1]}, repeat: {count: 2, step: [0, 0, "
      "3]}}\n"
      "    - {light: {point: {position: [0, 1, 0], intensity: 5}}}\n"
      "objects:\n"
      "  - {use: pair, translate: [10, 0, 0], rotate: 90, repeat: {count: [2, 1, 3], step: [100, "
      "7, 50]}}\n"
      "  - {use: pair, at: [[1, 2, 3], [4, 5, 6, 180]], materials: {a: b}}\n"
      "  - {group: [{use: pair}], scale: 2, translate: [0, 9, 0]}\n");
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.nodes.size(), 12u + 4u + 2u);
  ASSERT_EQ(model.lights.size(), 6u + 2u + 1u);
  // Rotation by 90 degrees about y takes +z to +x.
  EXPECT_TRUE(model.nodes[1].to_world.translation().isApprox(Vec3d(13, 0, 0), 1e-12));
  EXPECT_TRUE(model.nodes[11].to_world.translation().isApprox(Vec3d(113, 0, 100), 1e-12));
  EXPECT_TRUE(model.nodes[15].to_world.translation().isApprox(Vec3d(4, 5, 3), 1e-12));
  EXPECT_EQ(model.materials[model.nodes[15].material.value].name, "b");
  EXPECT_TRUE(model.lights[8].to_scene.translation().isApprox(Vec3d(0, 11, 0), 1e-12));
  EXPECT_NEAR(model.lights[8].to_scene.linear().determinant(), 1.0, 1e-12) << "no size to scale";
}

TEST_F(YamlScenes, MatrixAndTransformExcludeEachOther) {
  const std::string start =
      "materials: {a: {body: 0.5}}\nobjects:\n"
      "  - {material: a, box: {size: [1, 1, 1]}, ";
  EXPECT_NE(
      error(start + "scale: 2, matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0]}\n").find("give a matrix or"),
      std::string::npos);
  const Model model = read(start + "matrix: [0,0,1,5, 0,1,0,6, -1,0,0,7]}\n");
  EXPECT_TRUE((model.nodes[0].to_world * Vec3d(1, 0, 0)).isApprox(Vec3d(5, 6, 6), 1e-12));
}

TEST_F(YamlScenes, CagesAreClosedAndKeepTheirPolygons) {
  write("house.obj",
        "# a pentagonal prism\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.5 0\nv 0 1 0\n"
        "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0.5 1.5 1\nv 0 1 1\n"
        "f 5 4 3 2 1\nf 6/1 7/1 8/1 9/1 10/1\nf 1 2 -4 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\nf 5 1 "
        "6 10\n");
  const Model model = read(
      "materials: {a: {body: 0.5}}\n"
      "objects:\n"
      "  - {material: a, cage: {box: {size: [1, 2, 3], divide: [2, 3, 4]}, sharpness: 1.5}}\n"
      "  - {material: a, cage: {lathe: {sides: 6, profile: [[0, 0], [1, 0], [1, 1], [0, 1]]}}}\n"
      "  - {material: a, cage: {file: house.obj, creases: [[0, 1, sharp], [1, 2, 0.5]]}}\n"
      "  - {material: a, cage: {scheme: loop, mesh: {vertices: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],\n"
      "     faces: [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}, sharp_boundary: false}}\n");
  ASSERT_EQ(model.meshes.size(), 4u);
  for (const MeshData& mesh : model.meshes) {
    ASSERT_TRUE(mesh.cage);
    EXPECT_EQ(open_edges(mesh), 0u);
  }
  const SubdivisionCage& box = *model.meshes[0].cage;
  EXPECT_EQ(box.face_sizes.size(), 2u * (2 * 3 + 3 * 4 + 4 * 2));
  // Euler: V - E + F = 2, with E = 2 F for quadrilaterals.
  EXPECT_EQ(model.meshes[0].positions.size(), box.face_sizes.size() + 2);
  EXPECT_EQ(box.creases.size(), 2 * box.face_sizes.size()) << "every edge once";
  EXPECT_EQ(model.meshes[1].positions.size(), 14u);
  const SubdivisionCage& house = *model.meshes[2].cage;
  EXPECT_EQ(house.face_sizes[0], 5u);
  ASSERT_EQ(house.creases.size(), 2u);
  EXPECT_TRUE(std::isinf(house.creases[0].sharpness));
  EXPECT_EQ(model.meshes[3].cage->scheme, SubdivisionCage::Scheme::Loop);
  EXPECT_FALSE(model.meshes[3].cage->sharp_boundary);
  // Outward: the volume of the fans from the origin is positive.
  for (const MeshData& mesh : model.meshes) {
    double volume = 0.0;
    std::size_t begin = 0;
    for (const std::uint32_t n : mesh.cage->face_sizes) {
      const auto p = [&](std::size_t i) {
        return mesh.positions[mesh.cage->face_indices[begin + i]];
      };
      for (std::uint32_t i = 2; i < n; ++i) volume += p(0).dot(p(i - 1).cross(p(i))) / 6.0;
      begin += n;
    }
    EXPECT_GT(volume, 0.0) << mesh.cage->face_sizes.size();
  }
}

TEST_F(YamlScenes, ModelFilesAreReadOnceAndRecoloured) {
  write("part.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const Model model = read(
      "materials: {red: {body: [0.5, 0.1, 0.1]}}\n"
      "objects:\n"
      "  - {file: part.obj, material: red, translate: [5, 0, 0]}\n"
      "  - {file: part.obj, repeat: {count: 3, step: [1, 0, 0]}}\n");
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.nodes.size(), 4u);
  EXPECT_EQ(model.materials[model.nodes[0].material.value].name, "red");
  EXPECT_NE(model.materials[model.nodes[1].material.value].name, "red");
  EXPECT_TRUE(model.nodes[3].to_world.translation().isApprox(Vec3d(2, 0, 0), 1e-12));
}

}  // namespace
}  // namespace atrium::scene
