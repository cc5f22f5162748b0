// Where a model's own words can reach: files beside it and below, nothing else.
#include <gtest/gtest.h>

#include "import_files.h"
#include "material/error.h"
#include "scene/scene_io.h"

namespace {

using namespace atrium;
using namespace atrium::scene;
using test::Bytes;
using test::TempDir;

const std::vector<std::string> kElsewhere = {
    "../secret.bin",      "sub/../../secret.bin",     "/etc/passwd",
    "file:///etc/passwd", "http://example.org/a.bin", "C:\\secret.bin",
    "..\\secret.bin",     "%2e%2e/secret.bin",        "%2Fetc%2Fpasswd"};

std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\\' ? "\\\\" : std::string(1, c);
  return out;
}

bool warns(const Model& model, const std::string& words) {
  for (const std::string& warning : model.warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

TEST(FilesElsewhere, BuffersAreRefused) {
  const TempDir folder;
  std::filesystem::create_directories(folder.path() / "model" / "sub");
  const std::string data = Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).str();
  static_cast<void>(folder.write("secret.bin", data));
  static_cast<void>(folder.write("model/sub/own.bin", data));
  const auto file = [&](const std::string& uri) {
    return folder.write(
        "model/a.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
        R"({"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36,"uri":")" +
            quoted(uri) +
            R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[)"
            R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})");
  };
  for (const std::string& uri : kElsewhere) {
    SCOPED_TRACE(uri);
    try {
      static_cast<void>(read_model({file(uri)}));
      FAIL();
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("beside the model or below"), std::string::npos)
          << e.what();
    }
  }
  EXPECT_EQ(read_model({file("sub/own.bin")}).meshes.size(), 1u);
  EXPECT_EQ(read_model({file("./sub/own.bin")}).meshes.size(), 1u);
}

TEST(FilesElsewhere, TexturesAreLeftOutWithAWarning) {
  const TempDir folder;
  for (const std::string& uri : kElsewhere) {
    SCOPED_TRACE(uri);
    const std::string material =
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],)"
        R"("images":[{"uri":")" +
        quoted(uri) + R"("}],"samplers":[{)";
    const Model model = read_model({folder.write("a.gltf", test::material_gltf(material))});
    EXPECT_EQ(model.textures.size(), 0u);
    EXPECT_TRUE(warns(model, "beside the model or below"));
  }
}

TEST(FilesElsewhere, OfObjAreLeftOutWithAWarning) {
  const TempDir folder;
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  for (const char* name : {"../a.mtl", "/etc/passwd", "sub/../../a.mtl", "C:\\a.mtl"}) {
    SCOPED_TRACE(name);
    const Model model =
        read_model({folder.write("a.obj", std::string("mtllib ") + name + "\n" + faces)});
    EXPECT_EQ(model.meshes.size(), 1u);
    EXPECT_TRUE(warns(model, "beside the model or below"));
  }
  for (const char* name : {"../a.png", "/dev/zero", "..\\a.png"}) {
    SCOPED_TRACE(name);
    static_cast<void>(
        folder.write("m.mtl", std::string("newmtl a\nKd 1 1 1\nmap_Kd ") + name + "\n"));
    const Model model = read_model({folder.write("a.obj", "mtllib m.mtl\n" + faces)});
    EXPECT_EQ(model.textures.size(), 0u);
    EXPECT_TRUE(warns(model, "beside the model or below"));
  }
}

}  // namespace
