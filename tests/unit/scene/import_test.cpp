// OBJ, PLY and STL, and the models in their original formats.

#include <nlohmann/json.hpp>

#include "import_files.h"
#include "material/error.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

using material::Material;
using test::TempDir;

bool warns(const Model& model, const std::string& part) {
  for (const std::string& w : model.warnings) {
    if (w.find(part) != std::string::npos) return true;
  }
  return false;
}

struct Measures {
  std::size_t triangles = 0;
  double area = 0.0;
  Bounds bounds;
};

Measures measure(const Model& model) {
  Measures m;
  for (const Model::Node& node : model.nodes) {
    const MeshData& mesh = model.meshes[node.mesh.value];
    for (const Triangle& t : mesh.triangles) {
      const Vec3d a = node.to_world * mesh.positions[t[0]];
      const Vec3d b = node.to_world * mesh.positions[t[1]];
      const Vec3d c = node.to_world * mesh.positions[t[2]];
      m.area += 0.5 * (b - a).cross(c - a).norm();
      for (const Vec3d& p : {a, b, c}) m.bounds.extend(p);
      ++m.triangles;
    }
  }
  return m;
}

// Triangle counts, areas and boxes from an independent reader.
TEST(OriginalModels, AgreeWithAnIndependentReader) {
  const auto folder = test::shared_folder() / "models";
  std::ifstream in(folder / "expected.json");
  if (!in) GTEST_SKIP() << "no shared models beside the project";
  const nlohmann::json expected = nlohmann::json::parse(in);
  for (const auto& [name, want] : expected.at("files").items()) {
    SCOPED_TRACE(name);
    const Model model = read_model({folder / name});
    const Measures got = measure(model);
    EXPECT_EQ(got.triangles, want.at("triangles").get<std::size_t>());
    const double area = want.contains("area_polygon") ? want["area_polygon"].get<double>()
                                                      : want.at("area").get<double>();
    EXPECT_NEAR(got.area, area, 2e-6 + 2e-5 * area);  // the file gives 6 decimals
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(got.bounds.min()[k], want["bbox"][0][static_cast<std::size_t>(k)].get<double>(),
                  1e-5);
      EXPECT_NEAR(got.bounds.max()[k], want["bbox"][1][static_cast<std::size_t>(k)].get<double>(),
                  1e-5);
    }
    bool uv = false;
    bool normals = false;
    for (const MeshData& mesh : model.meshes) {
      uv = uv || !mesh.uvs.empty();
      normals = normals || !mesh.normals.empty();
    }
    EXPECT_EQ(uv, want.value("uv", uv));
    EXPECT_EQ(normals, want.value("normals", normals));
  }
}

TEST(OriginalModels, MissingMaterialLibraryIsSaidAndTheTextureBesideFound) {
  const auto file = test::shared_folder() / "models/obj/building.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared models beside the project";
  const Model model = read_model({file});
  EXPECT_TRUE(warns(model, "material file left out"));
  // Either the image beside the model is its colour, or (built without images) that is said.
  EXPECT_TRUE(warns(model, "building.png"));
}

TEST(OriginalModels, SeparateBufferEqualsTheBinaryScene) {
  const auto text = test::shared_folder() / "models/gltf/lbl_office.gltf";
  const auto binary = test::shared_folder() / "scenes/lbl_office.glb";
  if (!std::filesystem::exists(text)) GTEST_SKIP() << "no shared models beside the project";
  const Measures a = measure(read_model({text}));
  const Measures b = measure(read_model({binary}));
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.area, b.area);
}

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST(Obj, RelativeIndicesAndSlashes) {
  const TempDir folder;
  const Model model = read_model({folder.write("a.obj",
                                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvn 0 0 1\nf "
                                               "-3/-1/-1 -2/-1/-1 -1/-1/-1\nf 1//1 2//1 3//1\n")});
  ASSERT_EQ(model.meshes.size(), 1u);
  EXPECT_EQ(model.meshes[0].triangles.size(), 2u);
  EXPECT_EQ(model.meshes[0].uvs[0], Vec2f(0.0f, 0.75f));  // v is measured from the top here
  EXPECT_EQ(model.meshes[0].normals[0], Vec3f(0, 0, 1));
}

TEST(Obj, BadIndicesAreErrors) {
  const TempDir folder;
  for (const char* face :
       {"f 1 2 5", "f 0 1 2", "f 1 2 -9", "f 1/7 2/7 3/7", "f a b c", "f 1//2 2//2 3//2"}) {
    SCOPED_TRACE(face);
    const auto file =
        folder.write("a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n") + face + "\n");
    EXPECT_THROW(static_cast<void>(read_model({file})), Error);
  }
  EXPECT_THROW(static_cast<void>(read_model({folder.write("empty.obj", "")})), Error);
  EXPECT_THROW(static_cast<void>(read_model({folder.write("none.obj", "v 0 0 0\n")})), Error);
  EXPECT_THROW(static_cast<void>(read_model({folder.write("bin.obj", std::string("v\0f", 3))})),
               Error);
}

TEST(Obj, CoordinatesAreReadInDoublePrecision) {
  const TempDir folder;
  const Model model = read_model({folder.write(
      "a.obj",
      "v 1000000.000001 0 0\nv 1000000.000002 0 0\nv 1000000.000001 0.000001 0\nf 1 2 3\n")});
  const MeshData& mesh = model.meshes.at(0);
  EXPECT_NEAR(mesh.positions[1].x() - mesh.positions[0].x(), 1e-6, 1e-9);
}

TEST(Obj, ConcavePolygonsKeepTheirArea) {
  // A U of area 7: 3 x 3 without the notch of 1 x 2. A fan from the first corner would cover more.
  const TempDir folder;
  const Model model = read_model({folder.write("u.obj",
                                               "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 "
                                               "0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8\n")});
  EXPECT_EQ(model.meshes.at(0).triangles.size(), 6u);
  EXPECT_NEAR(measure(model).area, 7.0, 1e-12);
  for (const Triangle& t : model.meshes[0].triangles) {
    const auto& p = model.meshes[0].positions;
    EXPECT_GT((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).z(), 0.0);
  }
}

TEST(Obj, MaterialsByTheirParameters) {
  const TempDir folder;
  static_cast<void>(folder.write("m.mtl",
                                 "newmtl dull paint\nKd 0.6 0.6 0.6\nillum 1\n"
                                 "newmtl gloss\nKd 0.5 0.2 0.1\nKs 0.04 0.04 0.04\nNs 98\nillum 2\n"
                                 "newmtl mirror\nKd 0 0 0\nKs 0.9 0.9 0.9\nillum 3\n"
                                 "newmtl glass\nKd 0.1 0.1 0.1\nNi 1.52\nd 0.25\nillum 4\n"
                                 "newmtl lamp\nKd 0 0 0\nKe 10 20 30\n"));
  std::string text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* name : {"dull paint", "gloss", "mirror", "glass", "lamp", "unknown"}) {
    text += std::string("usemtl ") + name + "\nf 1 2 3\n";
  }
  const Model model = read_model({folder.write("a.obj", text)});
  ASSERT_EQ(model.nodes.size(), 6u);
  const auto at = [&](std::size_t i) -> const Material& {
    return model.materials[model.nodes[i].material.value];
  };
  EXPECT_EQ(at(0).name, "dull paint");
  EXPECT_EQ(at(0).k_rg, 0.0);
  EXPECT_NEAR(std::get<double>(at(0).body_reflectance.value()), 0.6, 1e-7);
  EXPECT_EQ(at(1).combination, Material::Combination::Coupled);
  EXPECT_NEAR(std::get<double>(at(1).n), 1.5, 1e-6);  // F(0) = 0.04
  EXPECT_NEAR(at(1).c, std::sqrt(50.0), 1e-12);       // m^2 = 2 / (Ns + 2)
  EXPECT_EQ(at(2).k_df, 0.0);
  EXPECT_TRUE(at(2).smooth());
  EXPECT_EQ(at(3).medium, Material::Medium::Pane);
  EXPECT_EQ(std::get<double>(at(3).transmission_tint), 0.75);
  EXPECT_EQ(std::get<double>(at(3).n), 1.52);
  EXPECT_EQ(std::get<Rgb>(at(4).emission), make_rgb(10, 20, 30));
  EXPECT_EQ(std::get<double>(at(5).body_reflectance.value()), 0.5);
  EXPECT_TRUE(warns(model, "'unknown' is unknown"));
}

TEST(Obj, LinesAndPointsAreIgnoredAndSaid) {
  const TempDir folder;
  const Model model =
      read_model({folder.write("a.obj", std::string(kTetrahedron) + "l 1 2\np 3\nf 1 2\n")});
  EXPECT_EQ(measure(model).triangles, 4u);
  EXPECT_TRUE(warns(model, "2 lines and points"));
  EXPECT_TRUE(warns(model, "1 faces with fewer than three corners"));
}

TEST(Obj, VertexColours) {
  const TempDir folder;
  const Model model =
      read_model({folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nf 1 2 3\n")});
  ASSERT_EQ(model.meshes.at(0).colors.size(), 3u);
  EXPECT_EQ(model.meshes[0].colors[0], Vec3f(1, 0, 0));
  EXPECT_EQ(model.meshes[0].colors[1], Vec3f(0, 0.5f, 0));
  EXPECT_EQ(model.meshes[0].colors[2], Vec3f(1, 1, 1));
}

TEST(MeshFile, BrokenFilesAreErrors) {
  const TempDir folder;
  for (const char* name : {"a.ply", "a.stl"}) {
    SCOPED_TRACE(name);
    EXPECT_THROW(static_cast<void>(read_model({folder.write(name, "")})), Error);
    EXPECT_THROW(static_cast<void>(read_model({folder.write(name, "no such format")})), Error);
  }
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(measure(read_model({folder.write("good.ply", header + "3 0 1 2\n")})).area, 0.5);
  EXPECT_THROW(static_cast<void>(read_model({folder.write("bad.ply", header + "3 0 1 9\n")})),
               Error);
}

TEST(MeshFile, StlCornersBecomeSharedVertices) {
  const TempDir folder;
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
  };
  const Model model =
      read_model({folder.write("a.stl", "solid s\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                            facet("1 0 0", "1 1 0", "0 1 0") + "endsolid s\n")});
  EXPECT_EQ(model.meshes.at(0).positions.size(), 4u);
  EXPECT_EQ(model.meshes[0].triangles.size(), 2u);
  EXPECT_EQ(std::get<double>(model.materials.at(0).body_reflectance.value()), 0.5);
}

// Each solid is an object; text is read in double precision: at 1e7 m a float has steps of a metre.
TEST(MeshFile, StlTextFarAwayKeepsItsShape) {
  const TempDir folder;
  const std::string facet =
      "  facet normal 0 0 1\r\n outer loop vertex 1e7 -0.25 +1 vertex 10000000.5 -.25 1 vertex 1e7 "
      "0.25 1 endloop endfacet\n";
  const Model model = read_model({folder.write(
      "a.stl", "solid one  two \r\n" + facet + "endsolid one\nsolid\n" + facet + "endsolid")});
  ASSERT_EQ(model.nodes.size(), 2u);
  EXPECT_EQ(model.nodes[0].name, "one  two");
  EXPECT_EQ(model.nodes[1].name, "a");
  EXPECT_EQ(model.meshes[0].positions,
            (std::vector<Vec3d>{{1e7, -0.25, 1}, {1e7 + 0.5, -0.25, 1}, {1e7, 0.25, 1}}));
  EXPECT_TRUE(model.warnings.empty());
}

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "taken";
}

TEST(MeshFile, DamagedStlTextIsAnErrorWithItsLine) {
  const TempDir folder;
  const auto said = [&](const std::string& text) {
    return message_of([&] { static_cast<void>(read_model({folder.write("a.stl", text)})); });
  };
  const std::string begin = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  EXPECT_NE(said(begin + "endloop\n").find("a.stl:6: 'endloop' stands where 'vertex' is due"),
            std::string::npos);
  EXPECT_NE(said(begin + "vertex 0 1 x\n").find("a.stl:6: 'x' is no number"), std::string::npos);
  EXPECT_NE(said(begin + "vertex 0 1 0\n").find("the file ends within a solid"), std::string::npos);
  EXPECT_NE(said("solid s\nendsolid s\n").find("has no triangles"), std::string::npos);
}

// A head that says 'solid' does not make text of a binary file; bytes behind the facets do not
// matter; a head that announces more than there is does.
TEST(MeshFile, BinaryStl) {
  const TempDir folder;
  const auto file = [](std::uint32_t announced, std::size_t facets, std::size_t more) {
    std::string bytes = "solid by a program";
    bytes.resize(80, ' ');
    bytes.append(reinterpret_cast<const char*>(&announced), sizeof announced);
    const std::array<float, 12> facet = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::size_t i = 0; i < facets; ++i) {
      bytes.append(reinterpret_cast<const char*>(facet.data()), sizeof facet);
      bytes.append(2, '\0');
    }
    return bytes + std::string(more, '\0');
  };
  EXPECT_EQ(measure(read_model({folder.write("a.stl", file(2, 2, 0))})).area, 1.0);
  EXPECT_EQ(measure(read_model({folder.write("b.stl", file(2, 2, 7))})).area, 1.0);
  const std::string said =
      message_of([&] { static_cast<void>(read_model({folder.write("c.stl", file(3, 2, 7))})); });
  EXPECT_NE(said.find("3 facets are more than the file's size holds"), std::string::npos) << said;
}

}  // namespace
}  // namespace atrium::scene
