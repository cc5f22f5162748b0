#include "scene/mesh_io.h"

#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "material/error.h"
#include "support/temp_folder.h"

namespace {

using atrium::Error;
using atrium::Vec3d;
using atrium::scene::PolygonMesh;
using atrium::scene::write_polygon_mesh;
using atrium::test::TempFolder;

#define ATRIUM_NEEDS_MODULE() \
  if (!atrium::scene::mesh_io_available()) GTEST_SKIP() << "built without VTK"

/// A square and a triangle beside it.
PolygonMesh sample_mesh() {
  PolygonMesh mesh;
  mesh.points = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0), Vec3d(2, 0.5, 0)};
  mesh.polygon_sizes = {4, 3};
  mesh.polygon_points = {0, 1, 2, 3, 1, 4, 2};
  mesh.cell_arrays = {{"irradiance", 3, {1, 2, 3, 4, 5, 6}}, {"level", 1, {0, 1}}};
  mesh.point_arrays = {{"irradiance", 1, {1, 2, 3, 4, 5}}};
  mesh.field_data = {{"unit", {"lx"}}};
  return mesh;
}

TEST(MeshIo, WritesBothFormatsComplete) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  for (const char* name : {"a.vtp", "a.vtu"}) {
    write_polygon_mesh(sample_mesh(), folder / name);
    std::ifstream in(folder / name, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(content.find("compressor=\"vtkLZ4DataCompressor\""), std::string::npos);
    EXPECT_NE(content.find("Name=\"irradiance\""), std::string::npos);
    EXPECT_NE(content.find("Name=\"unit\""), std::string::npos);
    EXPECT_NE(content.find("</VTKFile>"), std::string::npos);
  }
  EXPECT_EQ(folder.file_count(), 2);
}

TEST(MeshIo, RefusesUnknownEndingsMissingFoldersAndMeshesThatDoNotFit) {
  const TempFolder folder;
  EXPECT_THROW(write_polygon_mesh(sample_mesh(), folder / "a.obj"), Error);
  EXPECT_THROW(write_polygon_mesh(sample_mesh(), folder / "none/a.vtp"), Error);
  PolygonMesh mesh = sample_mesh();
  mesh.polygon_points[0] = 5;
  EXPECT_THROW(write_polygon_mesh(mesh, folder / "a.vtp"), std::invalid_argument);
  mesh = sample_mesh();
  mesh.cell_arrays[1].values.pop_back();
  EXPECT_THROW(write_polygon_mesh(mesh, folder / "a.vtp"), std::invalid_argument);
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
