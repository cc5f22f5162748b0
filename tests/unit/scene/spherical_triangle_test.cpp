#include "scene/spherical_triangle.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace atrium::scene {
namespace {

using Corners = std::array<Vec3d, 3>;

// Integral of the direction over a triangle seen from the origin: half the sum of the angles of its
// edges times the normals of their planes (Lambert 1760; Arvo 1994, The Irradiance Jacobian).
Vec3d vector_irradiance(const Corners& corners) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d a = corners[i].normalized(), b = corners[(i + 1) % 3].normalized();
    const Vec3d n = a.cross(b);
    sum += 0.5 * std::atan2(n.norm(), a.dot(b)) * n.normalized();
  }
  return sum;
}

// Small, large, obtuse, as long as half of the sky, wound either way.
const std::vector<Corners> kTriangles{
    {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},       {Vec3d{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {Vec3d{0, 0, 1}, {0.02, 0, 1}, {0, 0.03, 1}}, {Vec3d{9, 0, 1}, {-9, 1, 1}, {0, 9, 1}},
    {Vec3d{0, 1, 2}, {5, 1.1, 2}, {-5, 1.2, 2}},  {Vec3d{-50, 1, 1}, {50, 1, 1}, {0, 1.5, 1}}};

TEST(SphericalTriangle, SamplesAreUniformInSolidAngle) {
  constexpr int kEdge = 400;
  for (const Corners& corners : kTriangles) {
    const SphericalTriangle triangle(corners, Vec3d(Vec3d::Zero()));
    ASSERT_TRUE(triangle.usable());
    const double turn =
        corners[0].dot(corners[1].cross(corners[2])) > 0.0 ? 1.0 : -1.0;  // of the winding
    Vec3d mean = Vec3d::Zero();
    double outermost = 1.0;
    for (int i = 0; i < kEdge; ++i)
      for (int j = 0; j < kEdge; ++j) {
        const Vec2f u((static_cast<float>(i) + 0.5f) / kEdge,
                      (static_cast<float>(j) + 0.5f) / kEdge);
        const Vec3d w = triangle.sample(u);
        EXPECT_NEAR(w.norm(), 1.0, 1e-9);
        for (std::size_t k = 0; k < 3; ++k)
          outermost = std::min(
              outermost,
              turn * w.dot(corners[k].normalized().cross(corners[(k + 1) % 3].normalized())));
        mean += w / (kEdge * kEdge);
      }
    EXPECT_GT(outermost, -1e-9);
    const Vec3d expected = turn * vector_irradiance(corners) / triangle.solid_angle();
    EXPECT_LT((mean - expected).norm(), 1e-4);
  }
}

TEST(SphericalTriangle, AnOctantIsHalfPi) {
  EXPECT_NEAR(SphericalTriangle(kTriangles[0], Vec3d(Vec3d::Zero())).solid_angle(),
              std::numbers::pi / 2.0, 1e-14);
}

}  // namespace
}  // namespace atrium::scene
