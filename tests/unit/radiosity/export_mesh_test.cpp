#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "radiosity/export_mesh.h"
#include "radiosity/solve.h"
#include "unit/radiosity/sampled_wall.h"

namespace atrium::radiosity {
namespace {

const scene::PolygonMesh::Array* find(const std::vector<scene::PolygonMesh::Array>& arrays,
                                      const std::string& name) {
  const auto it =
      std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
  return it == arrays.end() ? nullptr : &*it;
}

using PlaceKey = std::array<double, 3>;
PlaceKey key(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

/// Calls f(polygon, its points).
template <class F>
void for_polygons(const scene::PolygonMesh& mesh, F&& f) {
  std::size_t first = 0;
  for (std::size_t k = 0; k < mesh.polygon_sizes.size(); first += mesh.polygon_sizes[k++])
    f(k, std::span(mesh.polygon_points).subspan(first, mesh.polygon_sizes[k]));
}

double area_of(const scene::PolygonMesh& mesh, std::span<const std::uint32_t> points) {
  Vec3d twice = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    twice += (mesh.points[points[i]] - mesh.points[points[0]])
                 .cross(mesh.points[points[i + 1]] - mesh.points[points[0]]);
  return 0.5 * twice.norm();
}

/// Length of the edges that no polygon passes the other way [m].
double open_edges(const scene::PolygonMesh& mesh) {
  std::map<std::pair<PlaceKey, PlaceKey>, int> uses;
  for_polygons(mesh, [&](std::size_t, std::span<const std::uint32_t> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PlaceKey a = key(mesh.points[points[i]]);
      const PlaceKey b = key(mesh.points[points[(i + 1) % points.size()]]);
      ++uses[{a, b}];
      --uses[{b, a}];
    }
  });
  double length = 0.0;
  for (const auto& [edge, balance] : uses)
    if (balance > 0)
      length += balance * (Vec3d(edge.first.data()) - Vec3d(edge.second.data())).norm();
  return length;
}

std::size_t place_count(const scene::PolygonMesh& mesh) {
  std::set<PlaceKey> places;
  for (const Vec3d& p : mesh.points) places.insert(key(p));
  return places.size();
}

Elements divided(const scene::Scene& scene, double size, int rounds) {
  Elements e = make_elements(scene, {.element_size = size});
  std::mt19937 random(4);
  for (int i = 0; i < rounds; ++i)
    e = refine(scene, e, test::random_marks(e, 0.2, random)).elements;
  return e;
}

/// A field with a value per element, valid on the front.
scene::SurfaceField numbered(const Elements& e) {
  scene::SurfaceField field = e.layout;
  field.lanes = 1;
  field.unit = "W/m^2";
  for (std::size_t i = 0; i < field.element_count(); ++i) {
    field.irradiance.direct.insert(field.irradiance.direct.end(),
                                   {1.0f + 0.01f * static_cast<float>(i), 0.0f});
    field.valid.insert(field.valid.end(), {1, 0});
    field.standard_error.insert(field.standard_error.end(), {0.0f, 0.0f});
  }
  return field;
}

scene::PolygonMesh exported(const scene::Scene& scene, const Elements& e) {
  return to_polygon_mesh(scene, e, numbered(e), material::SpectralBasis::grey());
}

scene::Scene ball(bool smooth) {
  test::SceneMaker maker;
  maker.sphere(maker.material(test::diffuse(0.5)), 1.0f, 3, false);
  scene::Scene scene = maker.take();
  if (smooth)
    for (const Vec3f& p : scene.meshes[0].positions)
      scene.meshes[0].normals.push_back(p.normalized());
  return scene;
}

// The wall's outline, 4 x 3 m with a notch, is as long as that of the rectangle.
TEST(ToPolygonMesh, HasNoCracksInAWall) {
  const scene::Scene scene = test::wall_with_notch();
  for (const int rounds : {0, 3}) {
    SCOPED_TRACE(rounds);
    const Elements e = divided(scene, 0.5, rounds);
    const scene::PolygonMesh mesh = exported(scene, e);
    EXPECT_NEAR(open_edges(mesh), 14.0, 1e-4);
    EXPECT_EQ(mesh.points.size(), place_count(mesh));
    std::uint32_t largest = 0;
    for (const std::uint32_t n : mesh.polygon_sizes) largest = std::max(largest, n);
    if (rounds > 0) {
      EXPECT_GT(largest, 4U);  // hanging corners
    }
  }
}

// Also between facets, whose grids do not match; and where the input has T-junctions.
TEST(ToPolygonMesh, HasNoCracksInABall) {
  const scene::Scene scene = ball(false);
  EXPECT_NEAR(open_edges(exported(scene, divided(scene, 0.2, 2))), 0.0, 1e-12);
}

TEST(ToPolygonMesh, HasNoCracksAtTJunctions) {
  test::SceneMaker maker;
  maker.object(maker.material(test::diffuse(0.5)),
               {{0, 0, 0},
                {3, 0, 0},
                {3, 1, 0},
                {0, 1, 0},
                {1.1f, 1, 0},
                {0, 2, 0},
                {1.1f, 2, 0},
                {3, 2, 0}},
               {{0, 1, 2}, {0, 2, 3}, {3, 4, 6}, {3, 6, 5}, {4, 2, 7}, {4, 7, 6}});
  const scene::Scene scene = maker.take();
  EXPECT_NEAR(open_edges(exported(scene, divided(scene, 0.4, 1))), 10.0, 1e-4);
}

// Smooth normals: facets share their points and so the values. Flat: they do not.
TEST(ToPolygonMesh, SharesPointsAcrossFacetsOfSmoothSurfacesOnly) {
  const scene::Scene smooth = ball(true);
  const Elements e = divided(smooth, 0.2, 1);
  ASSERT_GT(e.layout.facets.size(), 20U);
  const scene::PolygonMesh mesh = exported(smooth, e);
  EXPECT_EQ(mesh.points.size(), place_count(mesh));
  const scene::Scene flat = ball(false);
  const scene::PolygonMesh creased = exported(flat, divided(flat, 0.2, 1));
  EXPECT_EQ(place_count(creased), place_count(mesh));
  EXPECT_GT(creased.points.size(), mesh.points.size() + 500);
}

// A cube of one object: three points at each corner, also with normals that are smooth.
TEST(ToPolygonMesh, KeepsSharpEdges) {
  test::SceneMaker maker;
  std::vector<Vec3f> p;
  for (int i = 0; i < 8; ++i)
    p.emplace_back(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                   static_cast<float>(i >> 2));
  maker.object(maker.material(test::diffuse(0.5)), p,
               {{0, 2, 3},
                {0, 3, 1},
                {4, 5, 7},
                {4, 7, 6},
                {0, 1, 5},
                {0, 5, 4},
                {2, 6, 7},
                {2, 7, 3},
                {0, 4, 6},
                {0, 6, 2},
                {1, 3, 7},
                {1, 7, 5}});
  scene::Scene scene = maker.take();
  for (const Vec3f& q : scene.meshes[0].positions)
    scene.meshes[0].normals.push_back((q - Vec3f::Constant(0.5f)).normalized());
  const scene::PolygonMesh mesh = exported(scene, make_elements(scene, {.element_size = 1.0}));
  EXPECT_EQ(place_count(mesh), 8U);
  EXPECT_EQ(mesh.points.size(), 24U);
}

TEST(ToPolygonMesh, KeepsFluxAndLevels) {
  for (const scene::Scene& scene : test::refinable_scenes()) {
    const Elements e = divided(scene, 0.5, 3);
    const scene::SurfaceField field = numbered(e);
    const scene::PolygonMesh mesh =
        to_polygon_mesh(scene, e, field, material::SpectralBasis::grey());
    const auto& values = find(mesh.cell_arrays, "irradiance")->values;
    const auto& level = find(mesh.cell_arrays, "level")->values;
    const auto& element = find(mesh.cell_arrays, "element_id")->values;
    double flux = 0.0;
    for_polygons(mesh, [&](std::size_t k, std::span<const std::uint32_t> points) {
      flux += area_of(mesh, points) * static_cast<double>(values[3 * k]);
      EXPECT_EQ(level[k], e.layout.element_level[static_cast<std::size_t>(element[k])]);
    });
    double expected = 0.0;
    for (std::size_t i = 0; i < field.element_count(); ++i)
      expected += static_cast<double>(field.element_area[i] * field.irradiance.direct[2 * i]);
    EXPECT_NEAR(flux, expected, 2e-5 * expected);
  }
}

TEST(ToPolygonMesh, PointsMeetALinearFunctionToTheRim) {
  const scene::Scene scene = test::square_wall();
  const Elements e = test::graded(scene, 0.5, 2, 4);
  const auto f = [](double x, double y) { return 5.0 + x - 0.5 * y; };
  test::Sampled sampled(scene, e, f);
  scene::SurfaceField& field = sampled.field();
  field.standard_error.assign(field.valid.size(), 0.0f);
  const scene::PolygonMesh mesh = to_polygon_mesh(scene, e, field, material::SpectralBasis::grey());
  const auto& values = find(mesh.point_arrays, "irradiance_direct")->values;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    EXPECT_NEAR(values[3 * i], f(mesh.points[i].x(), mesh.points[i].y()), 2e-5);
}

TEST(ToPolygonMesh, HoldsTheDocumentedArraysInWorldCoordinates) {
  test::SceneMaker maker;
  maker.room({0, 0, 0}, {2, 2, 2}, maker.material(test::diffuse(0.5)));
  maker.point_light({1, 1, 1}, 10.0);
  scene::Scene scene = maker.take();
  scene.origin = Vec3d(1000, 0, 0);
  const scene::RayQuery query(scene);
  const auto basis = material::SpectralBasis::grey();
  const SolveResult result = solve(query, basis, {.element_size = 0.5});
  const scene::PolygonMesh mesh = to_polygon_mesh(scene, result.elements, result.field, basis);

  ASSERT_EQ(mesh.polygon_sizes.size(), result.elements.pieces.size());
  for (const Vec3d& p : mesh.points) EXPECT_TRUE(p.x() > 999.9 && p.x() < 1002.1);
  for (const char* name :
       {"irradiance_direct", "irradiance_caustic", "irradiance_indirect", "irradiance",
        "irradiance_back", "radiosity", "reflectance", "emission"}) {
    SCOPED_TRACE(name);
    const auto* a = find(mesh.cell_arrays, name);
    ASSERT_NE(a, nullptr);
    EXPECT_EQ(a->components, 3);
    EXPECT_EQ(a->values.size(), 3 * mesh.polygon_sizes.size());
  }
  for (const char* name : {"stderr", "illuminance_lux", "element_id", "level", "material_id",
                           "object_id", "front_valid"}) {
    SCOPED_TRACE(name);
    const auto* a = find(mesh.cell_arrays, name);
    ASSERT_NE(a, nullptr);
    EXPECT_EQ(a->values.size(), mesh.polygon_sizes.size());
  }
  const auto* point = find(mesh.point_arrays, "irradiance");
  ASSERT_NE(point, nullptr);
  EXPECT_EQ(point->values.size(), 3 * mesh.points.size());

  // B = rho E on a surface that does not emit; W to lux by 179 lm/W.
  const auto& e = find(mesh.cell_arrays, "irradiance")->values;
  const auto& b = find(mesh.cell_arrays, "radiosity")->values;
  const auto& lux = find(mesh.cell_arrays, "illuminance_lux")->values;
  for (std::size_t i = 0; i < e.size(); ++i) EXPECT_NEAR(b[i], 0.5f * e[i], 1e-5f * e[i]);
  for (std::size_t i = 0; i < lux.size(); ++i)
    EXPECT_NEAR(lux[i], 179.0f * e[3 * i], 1e-3f * lux[i]);
  EXPECT_EQ(mesh.field_data.at("unit"), std::vector<std::string>{"W/m^2"});
  EXPECT_EQ(mesh.field_data.at("illuminance_unit"), std::vector<std::string>{"lx"});
  EXPECT_EQ(mesh.field_data.at("length_unit"), std::vector<std::string>{"m"});
}

}  // namespace
}  // namespace atrium::radiosity
