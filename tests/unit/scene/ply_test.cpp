#include <gtest/gtest.h>

#include "import_files.h"
#include "material/error.h"
#include "scene/scene_io.h"

namespace {

using namespace atrium;
using namespace atrium::scene;
using test::Bytes;
using test::TempDir;

std::string head(const std::string& format, const std::string& vertices, const std::string& faces,
                 const std::string& list = "uchar int vertex_indices") {
  return "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty "
         "uchar "
         "green\nproperty uchar blue\nelement face " +
         faces + "\nproperty list " + list + "\nproperty uchar flags\nend_header\n";
}
std::string message(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_model({file}));
  } catch (const Error& e) {
    return e.what();
  }
  return "none";
}

template <class T>
std::string reversed(T value) {
  std::string bytes = Bytes().add<T>({value}).str();
  return {bytes.rbegin(), bytes.rend()};
}

// The same square three ways.
TEST(Ply, TextAndBothByteOrdersAgree) {
  const TempDir folder;
  const std::string text =
      head("ascii", "4", "1") +
      "0 0 0 255 0 51\r\n2 0 0 255 0 51\n2 3 0 255 0 51\n0 3 0 255 0 51\n4 0 1 2 3 7\n";
  std::string little = head("binary_little_endian", "4", "1");
  std::string big = head("binary_big_endian", "4", "1");
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {2.0f, 0.0f}, {2.0f, 3.0f}, {0.0f, 3.0f}}) {
    little += Bytes().add<float>({x, y, 0}).add<std::uint8_t>({255, 0, 51}).str();
    big +=
        reversed(x) + reversed(y) + reversed(0.0f) + Bytes().add<std::uint8_t>({255, 0, 51}).str();
  }
  little +=
      Bytes().add<std::uint8_t>({4}).add<std::int32_t>({0, 1, 2, 3}).add<std::uint8_t>({7}).str();
  big += '\4' + reversed(0) + reversed(1) + reversed(2) + reversed(3) + '\7';
  for (const std::string& file : {text, little, big}) {
    const Model model = read_model({folder.write("a.ply", file)});
    ASSERT_EQ(model.meshes.size(), 1u);
    const MeshData& mesh = model.meshes[0];
    EXPECT_EQ(mesh.name, "a");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}));
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.colors.size(), 4u);
    EXPECT_EQ(mesh.colors[3], Vec3f(1.0f, 0.0f, 0.2f));
    EXPECT_TRUE(mesh.normals.empty());
  }
}

TEST(Ply, CountsThatTheFileCannotHoldAreErrorsBeforeAnyAllocation) {
  const TempDir folder;
  for (const char* format : {"ascii", "binary_little_endian"}) {
    EXPECT_NE(message(folder.write("a.ply", head(format, "4294967295", "1"))).find("more than the"),
              std::string::npos);
    EXPECT_NE(message(folder.write("a.ply", head(format, "99999999999999999999999", "1")))
                  .find("is no number of elements"),
              std::string::npos);
    EXPECT_NE(message(folder.write("a.ply", head(format, "0", "4000000000"))).find("more than the"),
              std::string::npos);
  }
  const std::string lists = head("binary_little_endian", "0", "1", "uint int vertex_indices");
  EXPECT_NE(message(folder.write("a.ply", lists + std::string("\xff\xff\xff\xff\0\0\0\0\0", 9)))
                .find("is longer than the file"),
            std::string::npos);
  EXPECT_NE(message(folder.write("a.ply", head("ascii", "0", "1") + "4000000000 1 2 3 4"))
                .find("is longer than the file"),
            std::string::npos);
}

TEST(Ply, WhatIsNoPlyIsAnErrorWithItsLine) {
  const TempDir folder;
  EXPECT_NE(message(folder.write("a.ply", "plyx\n")).find("a.ply:1:"), std::string::npos);
  EXPECT_NE(message(folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex\n")).find(":3:"),
            std::string::npos);
  EXPECT_NE(message(folder.write("a.ply", "ply\nformat ascii 1.0\n")).find("within the header"),
            std::string::npos);
  const std::string vertices = "0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n";
  EXPECT_NE(message(folder.write("a.ply", head("ascii", "3", "1") + vertices + "3 0 1 -1 0\n"))
                .find("is no vertex index"),
            std::string::npos);
  EXPECT_NE(message(folder.write("a.ply", head("ascii", "3", "1") + vertices + "3 0 1 3 0\n"))
                .find("out of range"),
            std::string::npos);
  EXPECT_NE(message(folder.write("a.ply", head("ascii", "3", "1") + vertices + "3 0 x 2 0\n"))
                .find("'x' is no number"),
            std::string::npos);
}

}  // namespace
