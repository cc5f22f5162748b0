#include "subdivision.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "material/error.h"

namespace atrium::scene {
namespace {

const Eigen::Affine3d kIdentity = Eigen::Affine3d::Identity();

MeshData cube_cage() {
  MeshData mesh;
  mesh.name = "cube";
  for (const double z : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double x : {-0.5, 0.5}) mesh.positions.emplace_back(x, y, z);
  mesh.cage.emplace();
  mesh.cage->face_sizes.assign(6, 4);
  mesh.cage->face_indices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                             2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  return mesh;
}

double area_of(const MeshData& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[t[0]];
    area += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  return area;
}

double volume_of(const MeshData& mesh) {
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
  }
  return volume;
}

using Point = std::tuple<double, double, double>;
Point key(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

// Directed edges without an opposite one, by exact positions: 0 for a watertight, consistently
// wound surface.
std::size_t open_edges(const MeshData& mesh) {
  std::map<std::pair<Point, Point>, int> count;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point a = key(mesh.positions[t[i]]);
      const Point b = key(mesh.positions[t[(i + 1) % 3]]);
      ++count[{a, b}];
      --count[{b, a}];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, n] : count) open += n > 0 ? static_cast<std::size_t>(n) : 0;
  return open;
}

#ifdef ATRIUM_WITH_OPENSUBDIV

// Catmull-Clark by hand: after one step the centre (z = 1/2) of a face has edge points at z = 3/8
// and corner points at z = 5/18; the limit is (16 * 1/2 + 4 * 4 * 3/8 + 4 * 5/18) / 36.
TEST(Subdivision, CubeFaceCentreIsTheLimitPoint) {
  const MeshData mesh = tessellate(cube_cage(), 1e-3, kIdentity, std::nullopt);
  const double expected = (8.0 + 6.0 + 10.0 / 9.0) / 36.0;
  EXPECT_NEAR(expected, 0.419753, 1e-6);
  double top = 0.0;
  for (const Vec3d& p : mesh.positions) top = std::max(top, p.z());
  EXPECT_NEAR(top, expected, 1e-12);
}

TEST(Subdivision, CubeIsWatertightAndKeepsItsWinding) {
  for (const double error : {3e-2, 3e-3, 3e-4}) {
    SCOPED_TRACE(error);
    const MeshData mesh = tessellate(cube_cage(), error, kIdentity, std::nullopt);
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_GT(volume_of(mesh), 0.0);
  }
}

// The chord error shrinks with the square of the edge length, and so does the missing area.
TEST(Subdivision, AreaConvergesWithTheErrorAskedFor) {
  const double reference = area_of(tessellate(cube_cage(), 1e-5, kIdentity, std::nullopt));
  double previous = std::numeric_limits<double>::infinity();
  for (const double error : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(error);
    const double missing =
        std::abs(reference - area_of(tessellate(cube_cage(), error, kIdentity, std::nullopt)));
    EXPECT_LT(missing, 0.5 * previous);
    // A ball of radius r whose facets are e too deep lacks at most the share 2 e / r of its area;
    // here e = error * sqrt(3) and the smallest radius of curvature is about 0.3.
    EXPECT_LT(missing / reference, 2.0 * error * std::sqrt(3.0) / 0.3);
    previous = missing;
  }
}

// No point of the limit surface is farther from the triangles than asked: fine vertices against
// the planes of the coarse triangles they lie over.
TEST(Subdivision, ChordErrorHolds) {
  const double error = 4e-3;
  const MeshData coarse = tessellate(cube_cage(), error, kIdentity, std::nullopt);
  const MeshData fine = tessellate(cube_cage(), 1e-4, kIdentity, std::nullopt);
  double worst = 0.0;
  for (const Vec3d& p : fine.positions) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : coarse.triangles) {
      // The surface is convex: the ray from the centre through p meets one triangle.
      const Vec3d& a = coarse.positions[t[0]];
      Eigen::Matrix3d m;
      m << a, coarse.positions[t[1]], coarse.positions[t[2]];
      const Vec3d weight = m.inverse() * p;
      if (weight.minCoeff() < -1e-9) continue;
      const Vec3d normal = (coarse.positions[t[1]] - a).cross(coarse.positions[t[2]] - a);
      nearest = std::min(nearest, std::abs((p - a).dot(normal.normalized())));
    }
    worst = std::max(worst, nearest);
  }
  EXPECT_LT(worst, error * std::sqrt(3.0));
  EXPECT_GT(worst, 0.02 * error * std::sqrt(3.0)) << "far finer than asked for";
}

// Limit normals against central differences: the normal of a fine triangle's corner differs from
// the triangle's own by at most its angular size.
TEST(Subdivision, NormalsAgreeWithTheTriangles) {
  const MeshData mesh = tessellate(cube_cage(), 1e-4, kIdentity, std::nullopt);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[t[0]];
    const Vec3d flat = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
    for (const std::uint32_t corner : t) {
      EXPECT_NEAR(mesh.normals[corner].norm(), 1.0f, 1e-5f);
      EXPECT_GT(mesh.normals[corner].cast<double>().dot(flat), std::cos(0.12));
    }
  }
  // At the middle of a face and at a corner symmetry says what the normal is.
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d& p = mesh.positions[i];
    if (std::abs(p.x()) < 1e-12 && std::abs(p.y()) < 1e-12 && p.z() > 0) {
      EXPECT_GT(mesh.normals[i].z(), 0.999999f);
    }
  }
}

TEST(Subdivision, SharpCreasesOnEveryEdgeGiveTheCubeBack) {
  MeshData cage = cube_cage();
  for (const auto& [a, b] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1},
                                                                                 {1, 3},
                                                                                 {3, 2},
                                                                                 {2, 0},
                                                                                 {4, 5},
                                                                                 {5, 7},
                                                                                 {7, 6},
                                                                                 {6, 4},
                                                                                 {0, 4},
                                                                                 {1, 5},
                                                                                 {2, 6},
                                                                                 {3, 7}}) {
    cage.cage->creases.push_back({a, b, std::numeric_limits<float>::infinity()});
  }
  const MeshData mesh = tessellate(cage, 1e-3, kIdentity, std::nullopt);
  EXPECT_NEAR(area_of(mesh), 6.0, 1e-9);
  EXPECT_NEAR(volume_of(mesh), 1.0, 1e-9);
  EXPECT_EQ(mesh.triangles.size(), 12u) << "flat faces need no refinement";
  EXPECT_EQ(mesh.positions.size(), 24u) << "each side of a crease has its own normals";
  EXPECT_EQ(open_edges(mesh), 0u);
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1.0f, 1e-6f);
}

TEST(Subdivision, SemiSharpCreasesLieBetween) {
  MeshData cage = cube_cage();
  const double smooth = volume_of(tessellate(cage, 1e-3, kIdentity, std::nullopt));
  cage.cage->creases = {{4, 5, 1.5f}, {5, 7, 1.5f}, {7, 6, 1.5f}, {6, 4, 1.5f}};
  const MeshData mesh = tessellate(cage, 1e-3, kIdentity, std::nullopt);
  EXPECT_GT(volume_of(mesh), smooth);
  EXPECT_LT(volume_of(mesh), 1.0);
  EXPECT_EQ(open_edges(mesh), 0u);
}

// A flat grid with a sharp boundary keeps its corners and edges, so its area is exact. Without
// them the corners are rounded.
TEST(Subdivision, BoundaryIsInterpolated) {
  MeshData mesh;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) mesh.positions.emplace_back(i, j, 0.0);
  mesh.cage.emplace();
  mesh.cage->face_sizes.assign(4, 4);
  mesh.cage->face_indices = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
  EXPECT_NEAR(area_of(tessellate(mesh, 1e-3, kIdentity, std::nullopt)), 4.0, 1e-9);
  mesh.cage->sharp_boundary = false;
  const double rounded = area_of(tessellate(mesh, 1e-3, kIdentity, std::nullopt));
  EXPECT_LT(rounded, 3.99);
  EXPECT_GT(rounded, 3.0);
}

// n-gons next to quads at rates that differ from face to face, seen from one side.
MeshData mixed_cage() {
  MeshData mesh;  // a hexagonal prism with a raised roof point
  for (const double y : {0.0, 1.0}) {
    for (int i = 0; i < 6; ++i) {
      const double angle = i * std::numbers::pi / 3.0;
      mesh.positions.emplace_back(std::cos(angle), y, std::sin(angle));
    }
  }
  mesh.positions.emplace_back(0.0, 1.8, 0.0);
  mesh.cage.emplace();
  mesh.cage->face_sizes.push_back(6);
  for (std::uint32_t i = 0; i < 6; ++i) mesh.cage->face_indices.push_back(i);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.cage->face_sizes.push_back(4);
    for (const std::uint32_t k : {i, i + 6, next + 6, next}) mesh.cage->face_indices.push_back(k);
    mesh.cage->face_sizes.push_back(3);
    for (const std::uint32_t k : {i + 6, 12u, next + 6}) mesh.cage->face_indices.push_back(k);
  }
  return mesh;
}

TEST(Subdivision, RatesThatDifferDoNotCrack) {
  const MeshData cage = mixed_cage();
  Camera camera;
  camera.to_scene.translation() = Vec3d(1.4, 0.6, 0.0);  // close to one side
  const MeshData near_side = tessellate(cage, 2e-3, kIdentity, camera);
  EXPECT_EQ(open_edges(near_side), 0u);
  EXPECT_GT(volume_of(near_side), 0.0);
  camera.to_scene.translation() = Vec3d(40.0, 0.6, 0.0);
  const MeshData far_away = tessellate(cage, 2e-3, kIdentity, camera);
  EXPECT_EQ(open_edges(far_away), 0u);
  EXPECT_LT(far_away.triangles.size() * 4, near_side.triangles.size());
}

TEST(Subdivision, ScaleOfTheWorldCounts) {
  const MeshData cage = cube_cage();
  Camera camera;
  camera.to_scene.translation() = Vec3d(0.0, 0.0, 10.0);
  Eigen::Affine3d large = kIdentity;
  large.scale(8.0);
  const std::size_t small_count = tessellate(cage, 1e-3, kIdentity, camera).triangles.size();
  const MeshData big = tessellate(cage, 1e-3, large, camera);
  EXPECT_GT(big.triangles.size(), 3 * small_count);
  double top = 0.0;  // the result stays in local coordinates
  for (const Vec3d& p : big.positions) top = std::max(top, p.z());
  EXPECT_NEAR(top, 0.419753, 1e-6);
}

// Loop on an octahedron: closed, inside the cage, and uvs carried along.
TEST(Subdivision, LoopSchemeAndVertexData) {
  MeshData mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const Vec3d& p : mesh.positions) mesh.uvs.emplace_back(p.head<2>().cast<float>());
  mesh.cage.emplace();
  mesh.cage->scheme = SubdivisionCage::Scheme::Loop;
  mesh.cage->face_sizes.assign(8, 3);
  mesh.cage->face_indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                             2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const MeshData limit = tessellate(mesh, 1e-3, kIdentity, std::nullopt);
  EXPECT_EQ(open_edges(limit), 0u);
  EXPECT_GT(volume_of(limit), 0.1);
  EXPECT_LT(volume_of(limit), 4.0 / 3.0);
  ASSERT_EQ(limit.uvs.size(), limit.positions.size());
  // Linear data inside its own range; the corners keep theirs.
  float largest = 0.0f;
  for (const Vec2f& uv : limit.uvs) largest = std::max(largest, uv.cwiseAbs().sum());
  EXPECT_NEAR(largest, 1.0f, 1e-5f);
  mesh.cage->face_sizes.assign(6, 4);
  EXPECT_THROW((void)tessellate(mesh, 1e-3, kIdentity, std::nullopt), Error);
}

#else

TEST(Subdivision, WithoutOpenSubdivSaysSo) {
  EXPECT_THROW((void)tessellate(cube_cage(), 1e-3, kIdentity, std::nullopt), Error);
}

#endif

TEST(Subdivision, BrokenCagesAreErrors) {
  MeshData cage = cube_cage();
  cage.cage->face_indices[5] = 77;
  EXPECT_THROW((void)tessellate(cage, 1e-3, kIdentity, std::nullopt), Error);
  cage = cube_cage();
  cage.cage->face_sizes[0] = 2;
  EXPECT_THROW((void)tessellate(cage, 1e-3, kIdentity, std::nullopt), Error);
  cage = cube_cage();
  cage.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)tessellate(cage, 1e-3, kIdentity, std::nullopt), Error);
  cage = cube_cage();
  cage.cage->creases.push_back({0, 99, 1.0f});
  EXPECT_THROW((void)tessellate(cage, 1e-3, kIdentity, std::nullopt), Error);
}

TEST(Subdivision, MeshWithoutCageIsUntouched) {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const MeshData same = tessellate(mesh, 1e-3, kIdentity, std::nullopt);
  EXPECT_EQ(same.triangles, mesh.triangles);
}

}  // namespace
}  // namespace atrium::scene
