// What small files cannot ask for: scene/limits.h. Nothing here may take memory before it is
// refused; the tests' own limit on memory is that of the machine, so a regression shows as a killed
// process.
#include "scene/limits.h"

#include <functional>

#include <gtest/gtest.h>

#include "import_files.h"
#include "material/error.h"
#include "scene/image_io.h"
#include "scene/mesh_io.h"
#include "scene/scene_io.h"
#include "scene/solution_io.h"
#include "scene/weather.h"

namespace {

using namespace atrium;
using namespace atrium::scene;
using test::Bytes;
using test::TempDir;

/// The message of the Error, or "none".
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "none";
}
std::string reading(const std::filesystem::path& file) {
  return message_of([&] { static_cast<void>(read_model({file})); });
}
#define EXPECT_SAYS(text, words) \
  EXPECT_PRED_FORMAT2(testing::IsSubstring, std::string(words), text)

// ---- YAML ----

const std::string kHead = "atrium: 1\nmaterials: {a: {body: 0.5}}\n";

std::string repeated(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

// Every level names the one below: 60 levels each, together far deeper than a reader may recurse.
TEST(SceneFileLimits, DepthWithinAliasesCounts) {
  const TempDir folder;
  std::string text = kHead + "spectra:\n  s0: &a0 [1]\n";
  for (int i = 1; i < 300; ++i)
    text += "  s" + std::to_string(i) + ": &a" + std::to_string(i) + " " + repeated("[", 40) +
            "*a" + std::to_string(i - 1) + repeated("]", 40) + "\n";
  EXPECT_SAYS(reading(folder.write("a.yaml", text)), "nested deeper than 64 levels");
}

// Anchors within anchors are kept once per level: 50 copies of a long list.
TEST(SceneFileLimits, CopiesForAnchorsCount) {
  const TempDir folder;
  std::string text = "description: ";
  for (int i = 0; i < 50; ++i) text += "&a" + std::to_string(i) + " [";
  text += "[" + repeated("1,", 60000) + "1]" + repeated("]", 50) + "\n" + kHead;
  EXPECT_SAYS(reading(folder.write("a.yaml", text)), "more than 2000000 values");
}

TEST(SceneFileLimits, LongTextsCountWhenTheyAreNamedAgain) {
  const TempDir folder;
  const std::string text =
      "description: [&a " + repeated("x", 1000000) + repeated(", *a", 1000) + "]\n" + kHead;
  EXPECT_SAYS(reading(folder.write("a.yaml", text)), "more than 2000000 values");
}

// Groups of groups: each line repeats what the one above it holds.
TEST(SceneFileLimits, ObjectsOfGroupsCount) {
  const TempDir folder;
  std::string text =
      kHead + "groups:\n  g0:\n    - {box: {min: [0, 0, 0], max: [1, 1, 1]}, material: a}\n";
  for (int i = 1; i < 100; ++i)
    text += "  g" + std::to_string(i) + ":\n    - {use: g" + std::to_string(i - 1) +
            ", repeat: {count: 300, step: [2, 0, 0]}}\n";
  EXPECT_SAYS(reading(folder.write("a.yaml", text)), "more than 2000000 objects");
}

TEST(SceneFileLimits, VerticesOfShapesCount) {
  const TempDir folder;
  const std::string lathe = "objects:\n  - {cage: {lathe: {sides: 256, profile: [" +
                            repeated("[1, 1],", 20000) + "[1, 2]]}}, material: a}\n";
  EXPECT_SAYS(reading(folder.write("lathe.yaml", kHead + lathe)), "vertices");
}

// One mesh, many copies: what is computed per triangle of a scene is not shared.
TEST(SceneFileLimits, TrianglesOfCopiesCount) {
  const TempDir folder;
  const std::string text = kHead +
                           "objects:\n  - {sphere: {center: [0, 0, 0], radius: 1, segments: 512}, "
                           "material: a, repeat: {count: 2000, step: [3, 0, 0]}}\n";
  Model model = read_model({folder.write("a.yaml", text)});
  EXPECT_SAYS(message_of([&] { static_cast<void>(build_scene(std::move(model))); }),
              "more than 268435456 triangles");
}

TEST(SceneFileLimits, CornersOfACageCount) {
  const TempDir folder;
  std::string vertices = "[0, 0, 0]";
  std::string face = "0";
  for (int i = 1; i <= 1000; ++i) {
    vertices += ", [" + std::to_string(i) + ", " + std::to_string(i * i) + ", 0]";
    face += ", " + std::to_string(i);
  }
  const std::string text = kHead + "objects:\n  - {cage: {mesh: {vertices: [" + vertices +
                           "], faces: [[" + face + "]]}}, material: a}\n";
  Model model = read_model({folder.write("a.yaml", text)});
  EXPECT_SAYS(message_of([&] { static_cast<void>(build_scene(std::move(model))); }),
              "more than 1000 corners");
}

// ---- glTF ----

// The only data are 36 bytes; the accessor claims elements without any.
TEST(GltfLimits, ElementsWithoutDataCount) {
  const TempDir folder;
  const Bytes buffer = Bytes().pad(36);
  const auto file = [&](const std::string& count) {
    return folder.write(
        "a.gltf", test::gltf_json(buffer, R"({"buffer":0,"byteLength":36})",
                                  R"({"componentType":5126,"type":"VEC3","count":)" + count + "}",
                                  R"("attributes":{"POSITION":0})"));
  };
  EXPECT_SAYS(reading(file("2000000")), "elements without data");
  EXPECT_SAYS(reading(file("40000000")), "elements without data");
  EXPECT_SAYS(reading(file("4000000000000000000")), "elements without data");
}

// 6000 primitives of 1000 vertices, all from the same 12 kB: 72 MB by 300 kB of JSON, and so on.
TEST(GltfLimits, ReadingTheSameBytesCounts) {
  const TempDir folder;
  const Bytes buffer = Bytes().pad(12000);
  const std::string primitive = R"("attributes":{"POSITION":0}},{)";
  const std::string json =
      test::gltf_json(buffer, R"({"buffer":0,"byteLength":12000})",
                      R"({"bufferView":0,"componentType":5126,"count":1000,"type":"VEC3"})",
                      repeated(primitive, 6000) + R"("attributes":{"POSITION":0})");
  EXPECT_SAYS(reading(folder.write("a.gltf", json)), "read the same buffers");
}

// Primitives that share vertices keep those they use, in their order, with the right corners.
TEST(GltfLimits, PrimitivesKeepTheVerticesThatTheyUse) {
  const TempDir folder;
  Bytes buffer;
  for (int i = 0; i < 90; ++i)
    buffer.add<float>({static_cast<float>(i), static_cast<float>(i % 7), 0});
  buffer.add<std::uint16_t>({80, 7, 33});
  const auto json = test::gltf_json(
      buffer, R"({"buffer":0,"byteLength":1080},{"buffer":0,"byteOffset":1080,"byteLength":6})",
      R"({"bufferView":0,"componentType":5126,"count":90,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"})",
      R"("attributes":{"POSITION":0},"indices":1)");
  const Model model = read_model({folder.write("a.gltf", json)});
  ASSERT_EQ(model.meshes.size(), 1u);
  const MeshData& mesh = model.meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{7, 0, 0}, {33, 5, 0}, {80, 3, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(GltfLimits, BuffersThatWouldBeCopiesOfTheBinaryChunkCount) {
  const TempDir folder;
  const std::string json = R"({"asset":{"version":"2.0"},"buffers":[)" +
                           repeated(R"({"byteLength":1000000},)", 2000) +
                           R"({"byteLength":1000000}]})";
  EXPECT_SAYS(reading(folder.write("a.glb", test::glb(json, std::string(1000000, 'x')))),
              "2001 buffers");
}

// The parser would read eight bytes behind the file.
TEST(GltfLimits, ABinaryChunkEndsWithTheFile) {
  const TempDir folder;
  std::string file =
      test::glb(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8}]})", std::string(8, 'x'));
  const std::size_t length = file.size() - 8 - 8;  // of the binary chunk
  file[length] = 16;
  EXPECT_SAYS(reading(folder.write("a.glb", file)), "truncated");
}

// ---- images ----

std::string png_head(std::uint32_t width, std::uint32_t height) {
  const auto word = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16),
                       static_cast<char>(v >> 8), static_cast<char>(v)};
  };
  // No checksum is asked for: sizes are refused by the head alone or the file for its damage.
  return "\x89PNG\r\n\x1a\n" + word(13) + "IHDR" + word(width) + word(height) +
         std::string("\x08\x02\0\0\0", 5) + word(0);
}

TEST(ImageLimits, OnlyKnownFormatsReachTheirParser) {
  for (const char* magic : {"DDS 23456789012345678901234567890", "GIF89a...........",
                            "SIMPLE  =", "8BPS............", "DDS ...........", "P6 1 1 255 abc"}) {
    const std::string text = magic;
    EXPECT_SAYS(message_of([&] {
                  static_cast<void>(decode_texture({text.begin(), text.end()}, "image"));
                }),
                "PNG, JPEG, EXR, HDR, TIFF, BMP, TGA");
  }
}

// Complete but for its pixels; libpng checks the head's checksum, which is computed here.
std::string png(std::uint32_t width, std::uint32_t height) {
  std::string file = png_head(width, height);
  file.resize(file.size() - 4);
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 12; i < file.size(); ++i) {
    crc ^= static_cast<unsigned char>(file[i]);
    for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  crc = ~crc;
  for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>(crc >> shift);
  return file + std::string("\0\0\0\0IDAT", 8);
}

TEST(ImageLimits, SizesThatTheFileCannotHoldAreRefusedBeforeAnyPixel) {
  for (const auto& [width, height] : {std::pair{60000u, 60000u}, {16000u, 5000u}, {2000u, 2000u}}) {
    const std::string file = png(width, height);
    EXPECT_SAYS(message_of([&] {
                  static_cast<void>(decode_texture({file.begin(), file.end()}, "image"));
                }),
                "is larger than can be read");
  }
}

// ---- the rest ----

TEST(FileLimits, WhatIsNoFileIsNotReadWithoutEnd) {
  for (const char* name : {"/dev/zero", "/dev/null", "/"}) {
    const std::filesystem::path file = name;
    EXPECT_NE(message_of([&] { static_cast<void>(read_solution(file)); }), "none") << name;
    EXPECT_NE(message_of([&] { static_cast<void>(read_epw(file, 1, 1, 1)); }), "none") << name;
    EXPECT_NE(message_of([&] { static_cast<void>(read_texture(file)); }), "none") << name;
  }
}

#ifdef ATRIUM_WITH_VTK
TEST(MeshFileLimits, AnnouncedNumbersAreComparedWithTheSizeOfTheFile) {
  const TempDir folder;
  const auto vtp = [](const std::string& points) {
    return "<VTKFile type=\"PolyData\" version=\"1.0\" "
           "byte_order=\"LittleEndian\"><PolyData><Piece "
           "NumberOfPoints=\"" +
           points + "\" NumberOfPolys=\"1\"></Piece></PolyData></VTKFile>\n";
  };
  for (const char* points : {"100000000000", "99999999999999999999999999"})
    EXPECT_SAYS(message_of([&] {
                  static_cast<void>(summarise_mesh_file(folder.write("a.vtp", vtp(points))));
                }),
                "announces");
}
#endif

// ---- --memory-limit ----

TEST(MemoryLimit, IsHonouredWhileReadingAndBuilding) {
  const TempDir folder;
  const std::string text =
      kHead +
      "objects:\n  - {sphere: {center: [0, 0, 0], radius: 1, segments: 256}, material: a}\n";
  const auto file = folder.write("a.yaml", text);
  // 33k vertices of 44 bytes and 65k triangles of 12: 2.2 MB, and as much again while building.
  EXPECT_THROW(static_cast<void>(read_model({file}, {.memory_limit = 300'000})), RuntimeFailure);
  Model model = read_model({file}, {.memory_limit = 3'000'000});
  BuildOptions options;
  options.memory_limit = 3'000'000;
  EXPECT_THROW(static_cast<void>(build_scene(model, options)), RuntimeFailure);
  options.memory_limit = 8'000'000;
  EXPECT_NO_THROW(static_cast<void>(build_scene(model, options)));
}

TEST(Messages, AreOneLineWhateverAFileHolds) {
  EXPECT_STREQ(Error("a\nb\tc\x1b[31md").what(), "a b c?[31md");
  EXPECT_STREQ(RuntimeFailure("a\r\nb").what(), "a  b");
}

}  // namespace
