#include "radiosity/form_factor.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace atrium::radiosity {
namespace {

using Polygon = std::vector<Vec3d>;

Polygon square_at(double z, bool up) {
  Polygon p{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
  if (!up) std::swap(p[1], p[3]);
  return p;
}

// VERIFICATION 3.1, computed in double precision from the closed form; last digit rounded.
TEST(FormFactor, ParallelUnitSquares) {
  const std::pair<double, double> table[] = {{0.1, 0.826994522}, {0.5, 0.415253284},
                                             {1, 0.199824896},   {2, 0.068589589},
                                             {5, 0.012403977},   {10, 0.003162057}};
  for (const auto& [distance, f] : table) {
    SCOPED_TRACE(distance);
    EXPECT_NEAR(parallel_rectangles(1, 1, distance), f, 1e-9);
    EXPECT_NEAR(polygon_exchange_area(square_at(0, true), square_at(distance, false)), f, 2e-6 * f);
  }
}

TEST(FormFactor, PerpendicularRectanglesWithCommonEdge) {
  struct Case {
    double h, w, f;
  };
  for (const auto& [h, w, f] :
       {Case{1, 1, 0.200043776}, Case{1, 2, 0.116426301}, Case{2, 1, 0.232852603},
        Case{0.5, 1, 0.146186679}, Case{1, 0.1, 0.432513694}}) {
    SCOPED_TRACE(testing::Message() << h << " x " << w);
    EXPECT_NEAR(perpendicular_rectangles(w, h, 1), f, 1e-9);
    const Polygon floor{{0, 0, 0}, {w, 0, 0}, {w, 1, 0}, {0, 1, 0}};
    const Polygon wall{{0, 0, 0}, {0, 1, 0}, {0, 1, h}, {0, 0, h}};
    EXPECT_NEAR(polygon_exchange_area(floor, wall), f * w, 1e-6 * f * w);
    EXPECT_NEAR(polygon_exchange_area(wall, floor), f * w, 1e-6 * f * w);
  }
}

// The six faces of a cube see each other completely.
TEST(FormFactor, CubeClosure) {
  EXPECT_NEAR(parallel_rectangles(1, 1, 1) + 4 * perpendicular_rectangles(1, 1, 1), 1.0, 1e-12);
}

// A surface above the centre of a square of edge 2 a at height a: four times the corner formula
// F = (1 / 2 pi) (2 x / sqrt(1 + x^2)) atan(x / sqrt(1 + x^2)) with x = 1.
TEST(FormFactor, PointOverSquare) {
  const Polygon square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const double x = 1 / std::numbers::sqrt2;
  const double exact = 4 * (2 * x * std::atan(x)) / (2 * std::numbers::pi);
  EXPECT_NEAR(point_to_polygon({0, 0, 1}, {0, 0, -1}, square), exact, 1e-12);
  EXPECT_EQ(point_to_polygon({0, 0, 1}, {0, 0, 1}, square), 0.0);
}

// Half of a symmetric polygon is below the horizon of a surface at right angles to it.
TEST(FormFactor, HorizonCutsPolygon) {
  const Polygon wide{{-1e5, -1e5, 0}, {1e5, -1e5, 0}, {1e5, 1e5, 0}, {-1e5, 1e5, 0}};
  EXPECT_NEAR(point_to_polygon({0, 0, 1}, {1, 0, 0}, wide), 0.5, 1e-4);
}

// Only the part of b in front of a counts, whatever the rest does.
TEST(FormFactor, PolygonThroughTheOthersPlane) {
  const Polygon floor{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Polygon above{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const Polygon through{{0, 0, -3}, {0, 1, -3}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(polygon_exchange_area(floor, through), polygon_exchange_area(floor, above), 1e-12);
}

TEST(FormFactor, CoplanarAndBackToBackExchangeNothing) {
  const Polygon a = square_at(0, true);
  Polygon b = a;
  for (Vec3d& v : b) v.x() += 1.0;
  EXPECT_EQ(polygon_exchange_area(a, b), 0.0);
  EXPECT_EQ(polygon_exchange_area(square_at(0, false), square_at(1, true)), 0.0);
}

}  // namespace
}  // namespace atrium::radiosity
