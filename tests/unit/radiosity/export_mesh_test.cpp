#include <algorithm>

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "unit/radiosity/box_scene.h"

namespace atrium::radiosity {
namespace {

const scene::PolygonMesh::Array* find(const std::vector<scene::PolygonMesh::Array>& arrays,
                                      const std::string& name) {
  const auto it =
      std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
  return it == arrays.end() ? nullptr : &*it;
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
  EXPECT_EQ(mesh.field_data.at("unit"), "W/m^2");
}

}  // namespace
}  // namespace atrium::radiosity
