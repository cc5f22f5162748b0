#include <numbers>

#include "import_files.h"
#include "material/error.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

using test::Bytes;
using test::TempDir;

Model read_text(const std::string& text, const std::string& name = "test.gltf") {
  const TempDir folder;
  return read_model({folder.write(name, text)});
}

/// The message of the error that reading throws; empty if none.
std::string error_of(const std::string& text, const std::string& name = "test.gltf") {
  try {
    static_cast<void>(read_text(text, name));
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  return {};
}

void expect_error(const std::string& text, const std::string& part,
                  const std::string& name = "test.gltf") {
  const std::string message = error_of(text, name);
  EXPECT_NE(message.find(part), std::string::npos) << "message: '" << message << "'";
}

bool warns(const Model& model, const std::string& part) {
  for (const std::string& w : model.warnings) {
    if (w.find(part) != std::string::npos) return true;
  }
  return false;
}

void expect_unit_triangle(const Model& model) {
  ASSERT_EQ(model.meshes.size(), 1u);
  const MeshData& mesh = model.meshes[0];
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions[mesh.triangles[0][0]], Vec3d(0, 0, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[0][1]], Vec3d(1, 0, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[0][2]], Vec3d(0, 1, 0));
}

constexpr const char* kVec3 = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";

TEST(GltfAccessor, NonIndexedTriangleFromADataUri) {
  expect_unit_triangle(read_text(test::triangle_gltf()));
}

TEST(GltfAccessor, BinaryContainer) {
  const Bytes bin = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string json = test::triangle_gltf();
  const std::string uri = R"(,"uri":")" + bin.uri() + "\"";
  json.erase(json.find(uri), uri.size());
  expect_unit_triangle(read_text(test::glb(json, bin.str()), "test.glb"));
  // The format is told by the content, the ending only picks the reader.
  expect_unit_triangle(read_text(test::glb(json, bin.str()), "test.gltf"));
}

TEST(GltfAccessor, ExternalBufferWithPercentEncodedName) {
  const Bytes bin = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string json = test::triangle_gltf();
  json.replace(json.find(bin.uri()), bin.uri().size(), "my%20data%2eBIN");
  const TempDir folder;
  static_cast<void>(folder.write("my data.BIN", bin.str()));
  expect_unit_triangle(read_model({folder.write("a.gltf", json)}));
}

TEST(GltfAccessor, IndicesOfEveryWidth) {
  const auto indexed = [](const Bytes& buffer, int type, std::size_t bytes) {
    return test::gltf_json(
        buffer,
        R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":)" +
            std::to_string(bytes) + "}",
        std::string(kVec3) + R"(,{"bufferView":1,"componentType":)" + std::to_string(type) +
            R"(,"count":3,"type":"SCALAR"})",
        R"("attributes":{"POSITION":0},"indices":1)");
  };
  const Bytes xyz = Bytes().add<float>({0, 1, 0, 0, 0, 0, 1, 0, 0});
  expect_unit_triangle(read_text(indexed(Bytes(xyz).add<std::uint8_t>({1, 2, 0}), 5121, 3)));
  expect_unit_triangle(read_text(indexed(Bytes(xyz).add<std::uint16_t>({1, 2, 0}), 5123, 6)));
  expect_unit_triangle(read_text(indexed(Bytes(xyz).add<std::uint32_t>({1, 2, 0}), 5125, 12)));
  expect_error(indexed(Bytes(xyz).add<std::uint16_t>({1, 2, 3}), 5123, 6),
               "accessor 1: index 3 is out of range");
  expect_error(indexed(Bytes(xyz).add<std::uint32_t>({1, 2, 0xFFFFFFFFu}), 5125, 12),
               "out of range");
  expect_error(indexed(Bytes(xyz).add<float>({1, 2, 0}), 5126, 12), "unsigned");
}

// Positions and normals interleaved, with a gap: stride 28.
TEST(GltfAccessor, StridesAndOffsets) {
  const Bytes buffer = Bytes()
                           .pad(4)
                           .add<float>({0, 0, 0, 0, 0, 1, 9})
                           .add<float>({1, 0, 0, 0, 0, 1, 9})
                           .add<float>({0, 1, 0, 0, 0, 1, 9});
  const Model model = read_text(test::gltf_json(
      buffer, R"({"buffer":0,"byteOffset":4,"byteLength":84,"byteStride":28})",
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":0,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC3"})",
      R"("attributes":{"POSITION":0,"NORMAL":1})"));
  expect_unit_triangle(model);
  ASSERT_EQ(model.meshes[0].normals.size(), 3u);
  for (const Vec3f& n : model.meshes[0].normals) EXPECT_EQ(n, Vec3f(0, 0, 1));
}

// glTF 2.0, 3.11: c / 255, c / 65535, max(c / 127, -1), max(c / 32767, -1).
TEST(GltfAccessor, NormalisedIntegers) {
  const Bytes buffer =
      Bytes()
          .add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0})
          .add<std::uint8_t>({255, 0, 51, 0, 0, 255, 0, 0, 0, 0, 255, 0})     // colours, 4 apart
          .add<std::uint16_t>({65535, 0, 13107, 65535, 0, 0})                 // uv
          .add<std::int8_t>({127, -128, 0, 0, -127, 0, 0, 0, 0, 0, 127, 0});  // normals
  const Model model = read_text(test::gltf_json(
      buffer,
      R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12,"byteStride":4},)"
      R"({"buffer":0,"byteOffset":48,"byteLength":12},{"buffer":0,"byteOffset":60,"byteLength":12,"byteStride":4})",
      std::string(kVec3) +
          R"(,{"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"},)"
          R"({"bufferView":2,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"},)"
          R"({"bufferView":3,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"})",
      R"("attributes":{"POSITION":0,"COLOR_0":1,"TEXCOORD_0":2,"NORMAL":3})"));
  const MeshData& mesh = model.meshes.at(0);
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0], Vec3f(1.0f, 0.0f, 0.2f));
  EXPECT_EQ(mesh.colors[1], Vec3f(0.0f, 1.0f, 0.0f));
  ASSERT_EQ(mesh.uvs.size(), 3u);
  EXPECT_EQ(mesh.uvs[0], Vec2f(1.0f, 0.0f));
  EXPECT_EQ(mesh.uvs[1], Vec2f(0.2f, 1.0f));
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[0], Vec3f(1.0f, -1.0f, 0.0f));
  EXPECT_EQ(mesh.normals[1], Vec3f(-1.0f, 0.0f, 0.0f));
}

// Quantised positions (KHR_mesh_quantization): plain short integers, scaled by the node.
TEST(GltfAccessor, QuantisedPositions) {
  const Bytes buffer = Bytes().add<std::int16_t>({0, 0, 0, 0, 1000, 0, 0, 0, 0, 1000, 0, 0});
  const Model model = read_text(test::gltf_json(
      buffer, R"({"buffer":0,"byteLength":24,"byteStride":8})",
      R"({"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"})",
      R"("attributes":{"POSITION":0})",
      R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])",
      R"("mesh":0,"scale":[0.001,0.001,0.001])"));
  ASSERT_EQ(model.nodes.size(), 1u);
  EXPECT_LT((model.nodes[0].to_world * model.meshes[0].positions[1] - Vec3d(1, 0, 0)).norm(),
            1e-15);
  EXPECT_TRUE(model.warnings.size() == 1u && warns(model, "without a material"));
}

TEST(GltfAccessor, SparseOnDataAndOnZeros) {
  const Bytes buffer = Bytes()
                           .add<float>({0, 0, 0, 5, 5, 5, 0, 1, 0})
                           .add<std::uint16_t>({1, 2})
                           .add<float>({1, 0, 0, 0, 1, 0});
  const std::string views =
      R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":4},{"buffer":0,"byteOffset":40,"byteLength":24})";
  const auto accessor = [](const std::string& base, int count) {
    return "{" + base + R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":)" +
           std::to_string(count) +
           R"(,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}})";
  };
  const std::string primitive = R"("attributes":{"POSITION":0})";
  expect_unit_triangle(
      read_text(test::gltf_json(buffer, views, accessor(R"("bufferView":0,)", 1), primitive)));
  expect_unit_triangle(read_text(test::gltf_json(buffer, views, accessor("", 2), primitive)));
  expect_error(test::gltf_json(buffer, views, accessor("", 4), primitive), "accessor 0");
  expect_error(test::gltf_json(buffer, views, accessor("", 3), primitive), "do not fit");
}

TEST(GltfAccessor, RangesAreChecked) {
  const Bytes buffer = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string primitive = R"("attributes":{"POSITION":0})";
  const std::string view = R"({"buffer":0,"byteLength":36})";
  const auto count = [](const std::string& n) {
    return R"({"bufferView":0,"componentType":5126,"count":)" + n + R"(,"type":"VEC3"})";
  };
  expect_error(test::gltf_json(buffer, view, count("4"), primitive),
               "accessor 0: 4 elements do not fit");
  expect_error(test::gltf_json(buffer, view, count("4000000000"), primitive), "do not fit");
  expect_error(test::gltf_json(buffer, view, count("18446744073709551615"), primitive),
               "do not fit");
  expect_error(test::gltf_json(buffer, R"({"buffer":0,"byteLength":37})", count("3"), primitive),
               "reaches beyond");
  expect_error(
      test::gltf_json(buffer, R"({"buffer":0,"byteOffset":18446744073709551612,"byteLength":36})",
                      count("3"), primitive),
      "reaches beyond");
  expect_error(test::gltf_json(buffer, R"({"buffer":7,"byteLength":36})", count("3"), primitive),
               "buffer 7");
  expect_error(test::gltf_json(buffer, view,
                               R"({"bufferView":9,"componentType":5126,"count":3,"type":"VEC3"})",
                               primitive),
               "bufferView 9 does not exist");
  expect_error(
      test::gltf_json(buffer, view, R"({"componentType":5126,"count":4000000000,"type":"VEC3"})",
                      primitive),
      "without data");
  expect_error(test::gltf_json(buffer, view, count("3"), R"("attributes":{"POSITION":5})"),
               "accessor 5 does not exist");
  expect_error(test::gltf_json(buffer, view,
                               R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"})",
                               primitive),
               "components");
}

TEST(GltfPrimitive, StripsAndFansKeepTheWinding) {
  // A unit square: as a strip 0 1 2 3 in z order, as a fan in ring order. Both face +z.
  const auto square = [](const Bytes& buffer, int mode) {
    return read_text(
        test::gltf_json(buffer, R"({"buffer":0,"byteLength":48})",
                        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})",
                        R"("attributes":{"POSITION":0},"mode":)" + std::to_string(mode)));
  };
  const Model strip = square(Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), 5);
  const Model fan = square(Bytes().add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 6);
  for (const Model* model : {&strip, &fan}) {
    const MeshData& mesh = model->meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (const Triangle& t : mesh.triangles) {
      const Vec3d cross = (mesh.positions[t[1]] - mesh.positions[t[0]])
                              .cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
      EXPECT_EQ(cross, Vec3d(0, 0, 1));
    }
  }
  EXPECT_TRUE(warns(square(Bytes().add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 1),
                    "lines are ignored"));
}

TEST(GltfNodes, ChainsMultiplyInDoublePrecision) {
  // 1e6 m east in the parent, the millimetres in the child: single precision would lose them.
  const std::string nodes =
      R"("translation":[1000000.0,0,0],"children":[1]},{"mesh":0,"translation":[0.001,0,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,2,2])";
  const Model model = read_text(test::triangle_gltf("", "", nodes));
  ASSERT_EQ(model.nodes.size(), 1u);
  const Vec3d p = model.nodes[0].to_world * Vec3d(1, 0, 0);  // scaled, turned to +y, moved
  EXPECT_LT((p - Vec3d(1000000.001, 2, 0)).norm(), 1e-9);
}

TEST(GltfNodes, MatrixIsColumnMajor) {
  const Model model = read_text(
      test::triangle_gltf("", "", R"("mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,6,7,1])"));
  EXPECT_EQ(Vec3d(model.nodes.at(0).to_world * Vec3d(1, 0, 0)), Vec3d(5, 7, 7));
}

TEST(GltfNodes, MeshesAreReadOnceHoweverOftenShown) {
  const Model model = read_text(test::triangle_gltf(
      "", "", R"("children":[1,2,3]},{"mesh":0},{"mesh":0,"translation":[1,0,0]},{"mesh":0)"));
  EXPECT_EQ(model.meshes.size(), 1u);
  EXPECT_EQ(model.nodes.size(), 3u);
}

TEST(GltfNodes, CyclesAndSharedChildrenAreRefused) {
  expect_error(test::triangle_gltf("", "", R"("children":[1]},{"mesh":0,"children":[0])"),
               "reached twice");
  expect_error(test::triangle_gltf("", "", R"("children":[0],"mesh":0)"),
               "node 0 is reached twice");
  expect_error(test::triangle_gltf(
                   "", "", R"("children":[1,2]},{"children":[3]},{"children":[3]},{"mesh":0)"),
               "node 3 is reached twice");
  expect_error(test::triangle_gltf("", "", R"("children":[17],"mesh":0)"),
               "node 17 does not exist");
  expect_error(test::triangle_gltf("", "", R"("mesh":3)"), "mesh 3 does not exist");
}

TEST(GltfNodes, DeepChainsNeedNoStack) {
  std::string nodes = R"("translation":[1,0,0],"children":[1])";
  for (int i = 2; i <= 20000; ++i) {
    nodes += R"(},{"translation":[1,0,0],"children":[)" + std::to_string(i) + "]";
  }
  nodes += R"(},{"mesh":0)";
  const Model model = read_text(test::triangle_gltf("", "", nodes));
  EXPECT_EQ(model.nodes.at(0).to_world.translation(), Vec3d(20000, 0, 0));
}

TEST(GltfNodes, CamerasIgnoreScale) {
  const std::string camera =
      R"(,"cameras":[{"name":"a","type":"perspective","perspective":{"yfov":0.7,"aspectRatio":1.5,"znear":0.1}},)"
      R"({"type":"orthographic","orthographic":{"xmag":4,"ymag":2,"znear":0,"zfar":9}}])";
  const Model model = read_text(test::triangle_gltf(
      camera, "",
      R"("mesh":0,"children":[1,2]},{"camera":0,"scale":[3,3,-3],"translation":[1,2,3]},{"name":"plan","camera":1)"));
  ASSERT_EQ(model.cameras.size(), 2u);
  EXPECT_EQ(model.cameras[0].name, "a");
  EXPECT_EQ(model.cameras[0].yfov, 0.7);
  EXPECT_EQ(model.cameras[0].aspect, 1.5);
  EXPECT_EQ(model.cameras[0].to_scene.translation(), Vec3d(1, 2, 3));
  EXPECT_NEAR(model.cameras[0].to_scene.linear().determinant(), 1.0, 1e-15);
  EXPECT_EQ(model.cameras[1].kind, Camera::Kind::Orthographic);
  EXPECT_EQ(model.cameras[1].height, 4.0);
  EXPECT_EQ(model.cameras[1].aspect, 2.0);
  EXPECT_EQ(model.cameras[1].name, "plan");
  expect_error(test::triangle_gltf(
                   R"(,"cameras":[{"type":"perspective","perspective":{"yfov":-1,"znear":0.1}}])",
                   "", R"("mesh":0,"camera":0)"),
               "yfov");
}

TEST(GltfNodes, PunctualLights) {
  const std::string lights =
      R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
      R"({"type":"point","intensity":100,"color":[1,0.5,0.25]},)"
      R"({"type":"spot","intensity":7,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.4}},)"
      R"({"type":"directional","intensity":1000}]}})";
  const auto node = [](int i) {
    return R"({"extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(i) + "}}}";
  };
  const Model model =
      read_text(test::triangle_gltf(lights, "",
                                    R"("mesh":0,"children":[1,2,3]},)" + node(0) + "," + node(1) +
                                        "," + node(2).substr(0, node(2).size() - 1)));
  ASSERT_EQ(model.lights.size(), 3u);
  const Rgb intensity = std::get<Rgb>(std::get<PointLight>(model.lights[0].kind).intensity);
  EXPECT_EQ(intensity, make_rgb(100, 50, 25));
  const auto& spot = std::get<SpotLight>(model.lights[1].kind);
  EXPECT_EQ(std::get<double>(spot.intensity), 7.0);
  EXPECT_FLOAT_EQ(static_cast<float>(spot.inner_angle), 0.1f);
  EXPECT_FLOAT_EQ(static_cast<float>(spot.outer_angle), 0.4f);
  EXPECT_EQ(std::get<double>(std::get<DirectionalLight>(model.lights[2].kind).irradiance), 1000.0);
}

TEST(GltfFile, BrokenFilesSayWhatIsWrong) {
  expect_error("", "empty");
  expect_error("{", "");
  EXPECT_FALSE(error_of("{").empty());
  EXPECT_FALSE(error_of("[]").empty());
  EXPECT_FALSE(error_of("hello, world").empty());
  EXPECT_FALSE(
      error_of(R"({"asset":{"version":"2.0"},"meshes":7,"nodes":"x","scenes":[{"nodes":[0]}]})")
          .empty());
  expect_error(R"({"asset":{"version":"1.0"}})", "version");
  expect_error(std::string(5000, '['), "nested");
  const std::string whole = test::glb(test::triangle_gltf(), "1234");
  for (const std::size_t size :
       {std::size_t{4}, std::size_t{12}, std::size_t{19}, std::size_t{100}, whole.size() - 5}) {
    SCOPED_TRACE(size);
    EXPECT_FALSE(error_of(whole.substr(0, size), "test.glb").empty());
  }
  expect_error("glTF" + Bytes().add<std::uint32_t>({1, 20, 0, 0}).str(), "version 1", "test.glb");
}

TEST(GltfFile, MissingThings) {
  EXPECT_THROW(static_cast<void>(read_model({"does/not/exist.glb"})), Error);
  std::string json = test::triangle_gltf();
  const std::string uri = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).uri();
  json.replace(json.find(uri), uri.size(), "missing.bin");
  expect_error(json, "missing.bin");
  const TempDir folder;
  EXPECT_THROW(static_cast<void>(read_model({folder.write("a.fbx", "x")})), Error);
  EXPECT_THROW(static_cast<void>(read_model({folder.path()})), Error);
  expect_error(test::triangle_gltf(R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"),
               "draco");
}

TEST(GltfFile, TruncationsAndFlippedBytesNeverCrash) {
  const std::string whole = test::glb(test::triangle_gltf(), std::string(64, 'x'));
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x15);
    const TempDir folder;
    try {
      static_cast<void>(read_model({folder.write("test.glb", bytes)}));
    } catch (const Error&) {
    }
  }
}

// ---- materials ----

material::Material material_of(const std::string& json) {
  const Model model = read_text(test::material_gltf(json));
  EXPECT_EQ(model.materials.size(), 1u);
  return model.materials.at(0);
}

using material::Material;

TEST(GltfMaterial, WhiteDiffuse) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.8,0.8,0.8,1],"metallicFactor":0},"extensions":{"KHR_materials_specular":{"specularFactor":0}})");
  EXPECT_EQ(m.medium, Material::Medium::Opaque);
  EXPECT_EQ(m.combination, Material::Combination::Convex);
  EXPECT_EQ(m.k_df, 1.0);
  EXPECT_EQ(m.k_rg, 0.0);
  EXPECT_NEAR(std::get<double>(m.body_reflectance.value()), 0.8, 1e-7);
  EXPECT_FALSE(m.emissive());
}

// F(0) = ((n-1)^2 + k^2)/((n+1)^2 + k^2) must be the base colour (MATERIAL_MODEL 2).
TEST(GltfMaterial, MetalHasTheBaseColourAsItsReflectanceAtNormalIncidence) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.95,0.5,0.02,1],"metallicFactor":1,"roughnessFactor":0.5})");
  EXPECT_EQ(m.k_rg, 1.0);
  EXPECT_EQ(m.k_df, 0.0);
  EXPECT_DOUBLE_EQ(m.c, 4.0);  // c = 1 / roughness^2
  const double expected[] = {0.95, 0.5, 0.02};
  for (int i = 0; i < 3; ++i) {
    const double n = static_cast<double>(std::get<Rgb>(m.n)[i]);
    const double k = n * static_cast<double>(std::get<Rgb>(m.kappa)[i]);
    const double f0 = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    EXPECT_NEAR(f0, expected[i], 1e-6);
  }
}

TEST(GltfMaterial, PerfectMirrorStaysFinite) {
  const Material m =
      material_of(R"("pbrMetallicRoughness":{"metallicFactor":1,"roughnessFactor":0})");
  EXPECT_TRUE(m.smooth());
  EXPECT_TRUE(std::get<Rgb>(m.kappa).is_finite());
  EXPECT_GT(std::get<Rgb>(m.n).min(), 0.0f);
}

TEST(GltfMaterial, DielectricIsABodyUnderAnInterface) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.2,0.3,0.4,1],"metallicFactor":0,"roughnessFactor":0.2},"extensions":{"KHR_materials_ior":{"ior":1.4},"KHR_materials_specular":{"specularFactor":0.5}})");
  EXPECT_EQ(m.combination, Material::Combination::Coupled);
  EXPECT_EQ(std::get<double>(m.n), 1.4);
  EXPECT_EQ(m.k_rg, 0.5);
  EXPECT_EQ(m.k_df, 1.0);
  EXPECT_NEAR(m.c, 25.0, 1e-12);
  EXPECT_EQ(std::get<Rgb>(m.body_reflectance.value()), make_rgb(0.2, 0.3, 0.4));
}

TEST(GltfMaterial, PartialMetalKeepsTheMixOfF0) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.1,1],"metallicFactor":0.25,"roughnessFactor":0})");
  const double base[] = {0.8, 0.4, 0.1};
  for (int i = 0; i < 3; ++i) {
    const double n = static_cast<double>(std::get<Rgb>(m.n)[i]);
    EXPECT_NEAR(std::pow((n - 1) / (n + 1), 2), 0.75 * 0.04 + 0.25 * base[i], 1e-6);
    EXPECT_NEAR(static_cast<double>(std::get<Rgb>(m.body_reflectance.value())[i]), 0.75 * base[i],
                1e-6);
  }
}

TEST(GltfMaterial, PaneWithoutVolume) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,1],"metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.52}})");
  EXPECT_EQ(m.medium, Material::Medium::Pane);
  EXPECT_EQ(std::get<double>(m.n), 1.52);
  EXPECT_EQ(m.pane_thickness, 0.004);
  EXPECT_EQ(std::get<double>(m.extinction), 0.0);
  EXPECT_EQ(std::get<Rgb>(m.transmission_tint), make_rgb(1, 0.5, 1));
  EXPECT_EQ(m.k_tp_rg, 1.0);
  EXPECT_EQ(m.k_rg, 1.0);
}

// Through the attenuation distance the attenuation colour is left: exp(-K d) = colour. Entering and
// leaving the body multiply to the base colour.
TEST(GltfMaterial, SolidGlassWithVolume) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.25,0.25,0.25,1],"metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":1,"attenuationColor":[0.5,0.9,1],"attenuationDistance":0.2}})");
  EXPECT_EQ(m.medium, Material::Medium::Solid);
  EXPECT_EQ(std::get<double>(m.n), 1.5);
  EXPECT_NEAR(std::get<double>(m.transmission_tint), 0.5, 1e-7);
  const Rgb left = exp_minus(std::get<Rgb>(m.extinction), 0.2f);
  EXPECT_NEAR(static_cast<double>(left[0]), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(left[1]), 0.9, 1e-6);
  EXPECT_EQ(left[2], 1.0f);
}

// A body that transmits in part is the linear mix of glass and a Lambertian surface.
TEST(GltfMaterial, PartlyTransmittingSolid) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.6,0.6,0.6,1],"metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.75},"KHR_materials_volume":{"thicknessFactor":1}})");
  EXPECT_EQ(m.k_rg, 0.75);
  EXPECT_EQ(m.k_tp_rg, 0.75);
  EXPECT_EQ(m.k_df, 0.25);
  EXPECT_EQ(m.k_tp_df, 0.25);
  EXPECT_EQ(std::get<double>(m.body_transmittance.value()), 0.0);
  EXPECT_NEAR(std::get<double>(m.body_reflectance.value()), 0.6, 1e-7);
  material::validate(m, "test");
}

// Thin sheets: above one half a pane with the share in its tint, below a translucent sheet.
TEST(GltfMaterial, PartlyTransmittingSheet) {
  const auto sheet = [](const std::string& t) {
    return material_of(
        R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":)" +
        t + "}}");
  };
  const Material clear = sheet("0.75");
  EXPECT_EQ(clear.medium, Material::Medium::Pane);
  EXPECT_EQ(std::get<double>(clear.transmission_tint), 0.375);
  material::validate(clear, "test");
  const Material dull = sheet("0.25");
  EXPECT_EQ(dull.medium, Material::Medium::Opaque);
  EXPECT_EQ(std::get<double>(dull.body_reflectance.value()), 0.375);
  EXPECT_EQ(std::get<double>(dull.body_transmittance.value()), 0.125);
  material::validate(dull, "test");
}

TEST(GltfMaterial, Emission) {
  const std::string json =
      R"("pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":0},"emissiveFactor":[1,0.5,0.25],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":40}})";
  const Material m = material_of(json);
  EXPECT_EQ(std::get<Rgb>(m.emission), make_rgb(40, 20, 10));
  EXPECT_FALSE(m.emits_both_sides);
  EXPECT_TRUE(material_of(json + R"(,"doubleSided":true)").emits_both_sides);
  const TempDir folder;
  const Model scaled = read_model({folder.write("a.gltf", test::material_gltf(json))},
                                  {.emissive_nits_per_unit = 179.0});
  EXPECT_EQ(std::get<Rgb>(scaled.materials.at(0).emission), make_rgb(40 * 179, 20 * 179, 10 * 179));
}

TEST(GltfMaterial, UnlitEmitsItsColourAndReflectsNothing) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1]},"extensions":{"KHR_materials_unlit":{}})");
  EXPECT_EQ(std::get<Rgb>(m.emission), make_rgb(0.1, 0.2, 0.3));
  EXPECT_EQ(std::get<double>(m.body_reflectance.value()), 0.0);
  EXPECT_EQ(m.k_rg, 0.0);
}

TEST(GltfMaterial, BlendWithConstantAlphaBecomesASheet) {
  const Material m = material_of(
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,0.25],"metallicFactor":0},"alphaMode":"BLEND")");
  EXPECT_EQ(m.medium, Material::Medium::Pane);
  EXPECT_EQ(std::get<double>(m.transmission_tint), 0.75);
}

TEST(GltfMaterial, MissingTextureLeavesTheFactor) {
  const Model model = read_text(test::triangle_gltf(
      R"(,"images":[{"uri":"none.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.3,0.3,0.3,1],"metallicFactor":0,"baseColorTexture":{"index":0}},"extensions":{"KHR_materials_specular":{"specularFactor":0}}}])",
      R"(,"material":0)"));
  EXPECT_FALSE(model.materials.at(0).body_texture.texture.valid());
  EXPECT_NEAR(std::get<double>(model.materials[0].body_reflectance.value()), 0.3, 1e-7);
  EXPECT_TRUE(warns(model, "texture 0 left out"));
}

// A file that is not there tells whether anybody looked for it.
TEST(GltfMaterial, ImagesOfMaterialsThatNothingHasAreNotRead) {
  const std::string materials =
      R"(,"images":[{"uri":"none.png"}],"textures":[{"source":0}],"materials":[{"name":"plain"},{"name":"painted","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  const Model unused = read_text(test::triangle_gltf(materials, R"(,"material":0)"));
  EXPECT_EQ(unused.materials.size(), 2U);
  EXPECT_FALSE(warns(unused, "texture 0 left out"));
  EXPECT_TRUE(warns(read_text(test::triangle_gltf(materials, R"(,"material":1)")),
                    "texture 0 left out"));
}

TEST(GltfMaterial, NothingGivenIsGreyNotAWhiteMetal) {
  const Model model = read_text(test::triangle_gltf());
  EXPECT_EQ(std::get<double>(model.materials.at(0).body_reflectance.value()), 0.5);
  EXPECT_TRUE(warns(model, "without a material"));
}

}  // namespace
}  // namespace atrium::scene
