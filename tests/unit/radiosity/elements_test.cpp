#include "radiosity/elements.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "problem.h"
#include "unit/radiosity/refined_scenes.h"

namespace atrium::radiosity {
namespace {

using scene::ObjectId;
using scene::Scene;
using test::area_of;
using test::expect_lookup_agrees;
using test::SceneMaker;

TEST(Elements, RectangleIsCutIntoWholeCells) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.quad(m, {0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0});
  const Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 0.5});
  ASSERT_EQ(e.layout.facets.size(), 1U);
  EXPECT_EQ(e.layout.element_count(), 48U);
  for (const float a : e.layout.element_area) EXPECT_NEAR(a, 0.25f, 1e-5f);
  expect_lookup_agrees(scene, e);
}

// One long edge against three short ones: within a plane that is a matter of triangulation, across
// a bend it stays a border.
TEST(Elements, FacetsGrowOverTJunctionsWithinAPlane) {
  for (const float rise : {0.0f, 0.05f}) {
    SCOPED_TRACE(rise);
    SceneMaker maker;
    maker.object(
        maker.material(test::diffuse(0.5)),
        {{0, 0, 0},
         {3, 0, 0},
         {3, 1, 0},
         {0, 1, 0},
         {1, 1, 0},
         {2, 1, 0},
         {0, 2, rise},
         {1, 2, rise},
         {2, 2, rise},
         {3, 2, rise}},
        {{0, 1, 2}, {0, 2, 3}, {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}, {5, 2, 9}, {5, 9, 8}});
    const Scene scene = maker.take();
    const Elements e = make_elements(scene, {.element_size = 0.5});
    EXPECT_EQ(e.layout.facets.size(), rise == 0.0f ? 1U : 2U);
    if (rise == 0.0f) {
      EXPECT_EQ(e.layout.element_count(), 24U);
    }
    expect_lookup_agrees(scene, e);
  }
}

// Coordinates along this wall are up to 0.03 m from where they should be, those across it are
// exact: points lie all over its width. They once kept a quarter of a metre away from every edge.
TEST(Elements, PointsOfALongWallCoverItsWidth) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.quad(m, {-5e5f, 0, 0}, {5e5f, 0, 0}, {5e5f, 1, 0}, {-5e5f, 1, 0});
  const Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 1000.0});
  const ElementPoints points(scene, e);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  constexpr int kPoints = 20000;
  double from_middle = 0.0, least = 1.0;
  for (int i = 0; i < kPoints; ++i) {
    const auto element = static_cast<std::uint32_t>(random() % e.layout.element_count());
    const float a = u(random), b = u(random);
    const double y = static_cast<double>(points.spot(element, a, b).position.y());
    from_middle += std::abs(y - 0.5) / kPoints;
    least = std::min(least, y);
  }
  // |y - 1/2| of uniform points has the mean 1/4 and the standard deviation 1 / sqrt(48).
  EXPECT_NEAR(from_middle, 0.25, 4.0 / std::sqrt(48.0 * kPoints));
  EXPECT_GT(least, 0.0);
}

TEST(Elements, TriangulationDoesNotMatter) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> inside(0.5f, 2.5f);
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  // A fan around a random inner point.
  const Vec3f centre(inside(random), inside(random), 0);
  maker.object(m, {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, centre},
               {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 0.3});
  EXPECT_EQ(e.layout.facets.size(), 1U);
  EXPECT_EQ(e.layout.element_count(), 100U);
  EXPECT_NEAR(area_of(e), 9.0, 1e-4);
  expect_lookup_agrees(scene, e);
}

TEST(Elements, SphereClustersTrianglesAndKeepsItsArea) {
  SceneMaker maker;
  maker.sphere(maker.material(test::diffuse(0.5)), 1.0f, 5, false);
  const Scene scene = maker.take();
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto c = scene.corners(ObjectId(0U), t);
    area += 0.5 * static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
  }
  const Elements e = make_elements(scene, {.element_size = 0.5});
  EXPECT_LT(e.layout.facets.size(), scene.triangle_count() / 20);
  EXPECT_NEAR(area_of(e), area, 1e-4 * area);
  for (const std::uint32_t f : e.layout.triangle_facet) EXPECT_NE(f, scene::SurfaceField::kNone);
  expect_lookup_agrees(scene, e);
}

TEST(Elements, BudgetIsKept) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.room({0, 0, 0}, {6, 4, 3}, m);
  maker.quad(m, {-1000, -1000, -1}, {1000, -1000, -1}, {1000, 1000, -1}, {-1000, 1000, -1});
  const Elements e = make_elements(maker.take(), {.max_elements = 8000});
  EXPECT_GT(e.layout.element_count(), 5000U);
  EXPECT_LT(e.layout.element_count(), 10000U);
  // The plane of 4 km^2 gets at most a quarter; the room of 108 m^2 keeps small elements.
  std::size_t room = 0;
  for (const float a : e.layout.element_area) room += a < 1.0f ? 1U : 0U;
  EXPECT_GT(room, 4000U);
}

TEST(Elements, ThousandsOfSeparateScrapsAreGathered) {
  const Scene scene = test::scraps(20000);
  const Elements e = make_elements(scene, {.max_elements = 2000});
  EXPECT_LE(e.layout.element_count(), 2000U);
  EXPECT_EQ(e.pieces.size(), 20000U);
}

// Both surfaces have their most elements at some size, and no more at smaller ones.
TEST(Elements, FineTriangulationsKeepTheBudget) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.sphere(m, 2.0f, 5, true);
  maker.sphere(m, 1.0f, 5, false);
  const Scene scene = maker.take();
  ASSERT_GT(scene.triangle_count(), 5000U);
  EXPECT_LT(make_elements(scene, {.max_elements = 1000}).layout.element_count(), 2000U);
}

// They have an element each, which may not leave a room around them with one for a wall.
TEST(Elements, WallsAroundManySmallThingsKeepTheirs) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.room({0, 0, 0}, {6, 4, 3}, m);
  for (int i = 0; i < 400; ++i) {
    const int row = i / 20;
    const auto x = static_cast<float>(i % 20), y = static_cast<float>(row);
    maker.quad(m, {0.2f * x + 1, 0.1f * y + 1, 1}, {0.2f * x + 1.1f, 0.1f * y + 1, 1},
               {0.2f * x + 1.1f, 0.1f * y + 1.05f, 1}, {0.2f * x + 1, 0.1f * y + 1.05f, 1});
  }
  const Elements e = make_elements(maker.take(), {.max_elements = 300});
  std::size_t room = 0;
  for (const float a : e.layout.element_area) room += a > 0.1f ? 1U : 0U;
  EXPECT_GT(room, 100U);
  EXPECT_LT(e.layout.element_count(), 600U);
}

// Zero area, repeated and non-finite corners, three triangles on an edge, a flipped neighbour.
TEST(Elements, DegenerateInputIsSurvived) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  SceneMaker maker;
  maker.object(maker.material(test::diffuse(0.5)),
               {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0.5f, 0, 1}, {2, 0, 0}, {nan, 0, 0}},
               {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {0, 0, 1}, {0, 1, 6}, {0, 1, 2}});
  const Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 0.25});
  // Four proper triangles (one of them twice): 0.5 m^2 each.
  EXPECT_NEAR(area_of(e), 2.0, 1e-4);
  for (const int t : {3, 4, 5})
    EXPECT_EQ(e.layout.triangle_facet[static_cast<std::size_t>(t)], scene::SurfaceField::kNone);
}

TEST(Elements, LongSliverFillsCellsAlongItsWay) {
  SceneMaker maker;
  maker.object(maker.material(test::diffuse(0.5)), {{0, 0, 0}, {100, 0, 0}, {100, 0.001f, 0}},
               {{0, 1, 2}});
  const Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 1.0});
  EXPECT_EQ(e.layout.element_count(), 100U);
  EXPECT_NEAR(area_of(e), 0.05, 1e-6);
}

TEST(Elements, SurfacesThatAreNotDiffuseGetNone) {
  SceneMaker maker;
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  maker.quad(maker.material(mirror), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  EXPECT_TRUE(make_elements(maker.take()).layout.empty());
}

TEST(Elements, InstancesAreCutWhereTheyStand) {
  SceneMaker maker;
  maker.quad(maker.material(test::diffuse(0.5)), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  Scene scene = maker.take();
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].first_triangle = 2;
  for (scene::Object& o : scene.objects) o.instanced = true;
  scene.objects[1].to_scene = Eigen::Translation3f(5, 0, 0) * Eigen::Scaling(2.0f);
  const Elements e = make_elements(scene, {.element_size = 0.5});
  EXPECT_EQ(e.layout.element_count(), 4U + 16U);
  EXPECT_NEAR(area_of(e), 5.0, 1e-5);
  expect_lookup_agrees(scene, e);
}

}  // namespace
}  // namespace atrium::radiosity
