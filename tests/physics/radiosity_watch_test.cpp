// Snapshots of a solve while it goes on, and the elements of a field without its solve.
#include <gtest/gtest.h>

#include "physics/radiosity_support.h"
#include "radiosity/export_mesh.h"

namespace {

using namespace atrium;

/// A room with two lamps; a wall on the floor and a block divide its facets.
scene::Scene divided_room() {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  const auto lamp = maker.material(test::emitter(20.0, 0.5));
  maker.room({0, 0, 0}, {4, 3, 3}, {wall, wall, wall, wall, wall, wall});
  maker.quad(lamp, {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.quad(wall, {2.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 0.0f}, {2.0f, 2.0f, 3.0f}, {2.0f, 0.0f, 3.0f});
  maker.point_light({3.0, 1.0, 1.5}, 5.0);
  return maker.take();
}

radiosity::SolveOptions options() {
  radiosity::SolveOptions o;
  o.max_elements = 1500;
  o.mesh_error = 0.005;  // so that elements are divided
  o.light_groups = scene::Grouping::ByName;
  return o;
}

double mean_irradiance(const scene::SurfaceField& f) {
  double sum = 0.0, area = 0.0;
  for (std::size_t e = 0; e < f.element_count(); ++e) {
    const auto a = static_cast<double>(f.element_area[e]);
    sum += a * static_cast<double>(f.irradiance.direct[2 * e] + f.irradiance.indirect[2 * e]);
    area += a;
  }
  return sum / area;
}

struct Seen {
  double mean, direct_mean, error;
  std::size_t groups;
};

std::vector<Seen> watch(const scene::Scene& s, radiosity::SolveOptions o,
                        radiosity::SolveResult& result) {
  std::vector<Seen> seen;
  o.watch = [&](const radiosity::Snapshot& snapshot) {
    EXPECT_EQ(snapshot.elements.layout.element_count(), snapshot.field.element_count());
    EXPECT_EQ(snapshot.field.irradiance.indirect.size(), 2 * snapshot.field.element_count());
    scene::SurfaceField direct = snapshot.field;
    std::fill(direct.irradiance.indirect.begin(), direct.irradiance.indirect.end(), 0.0f);
    seen.push_back({mean_irradiance(snapshot.field), mean_irradiance(direct),
                    snapshot.error_estimate, snapshot.groups.size()});
  };
  const scene::RayQuery query(s);
  result = radiosity::solve(query, material::SpectralBasis::grey(), o);
  return seen;
}

TEST(Watch, EveryStateIsCompleteAndChangesNoBit) {
  const scene::Scene s = divided_room();
  radiosity::SolveResult watched;
  const std::vector<Seen> seen = watch(s, options(), watched);
  ASSERT_GE(seen.size(), 4u);
  const test::Solved alone(divided_room(), options());
  EXPECT_EQ(watched.field.irradiance.direct, alone.result.field.irradiance.direct);
  EXPECT_EQ(watched.field.irradiance.indirect, alone.result.field.irradiance.indirect);
  EXPECT_EQ(watched.field.standard_error, alone.result.field.standard_error);
  EXPECT_EQ(seen.back().mean, mean_irradiance(watched.field));
  EXPECT_EQ(seen.back().error, watched.error_estimate);
  for (const Seen& x : seen) EXPECT_EQ(x.groups, watched.groups.size());
}

// Light on its way, spread evenly, is far nearer to the answer than none.
TEST(Watch, AmbientLightAnticipatesWhatIsToCome) {
  const scene::Scene s = divided_room();
  for (const radiosity::Solver solver : {radiosity::Solver::Rows, radiosity::Solver::Shooting}) {
    radiosity::SolveOptions o = options();
    o.solver = solver;
    if (solver == radiosity::Solver::Shooting) {
      o.light_groups = scene::Grouping::One;
      o.max_elements = 300;
    }
    radiosity::SolveResult result;
    const std::vector<Seen> seen = watch(s, o, result);
    ASSERT_GE(seen.size(), 2u);
    const double answer = mean_irradiance(result.field);
    EXPECT_LT(std::abs(seen.front().mean - answer),
              0.5 * std::abs(seen.front().direct_mean - answer))
        << seen.front().mean << " of " << answer;
  }
}

TEST(Watch, RoundsTowardsAnErrorAreSeen) {
  const scene::Scene s = divided_room();
  radiosity::SolveOptions o = options();
  o.error = 0.03;
  radiosity::SolveResult result;
  const std::vector<Seen> seen = watch(s, o, result);
  ASSERT_GE(seen.size(), 4u);
  EXPECT_EQ(seen.front().error, 0.0);
  EXPECT_LE(seen.back().error, 0.03);
  EXPECT_GT(seen[seen.size() - 2].error, seen.back().error);
}

// The pieces of walls' facets, of divided elements: every element's area, in every triangle.
TEST(StoredElements, AreThoseThatWereSolved) {
  const test::Solved s(divided_room(), options());
  const auto has_divided = [](const scene::SurfaceField& f) {
    return std::any_of(f.element_level.begin(), f.element_level.end(),
                       [](std::uint8_t level) { return level > 0; });
  };
  ASSERT_TRUE(has_divided(s.result.field));
  ASSERT_FALSE(s.result.field.cuts.empty());
  const radiosity::Elements restored = radiosity::elements_of_field(s.scene, s.result.field);
  ASSERT_EQ(restored.first_piece.size(), s.result.elements.first_piece.size());
  for (std::size_t e = 0; e < s.count(); ++e) {
    double area = 0.0;
    for (std::size_t p = restored.first_piece[e]; p < restored.first_piece[e + 1]; ++p) {
      area += static_cast<double>(restored.pieces[p].area);
      EXPECT_EQ(restored.pieces[p].object.value, s.object(e));
    }
    EXPECT_NEAR(area, s.area(e), 1e-4 * s.area(e) + 1e-6) << e;
  }
}

TEST(StoredElements, MakeTheSameMesh) {
  const test::Solved s(divided_room(), options());
  const auto basis = material::SpectralBasis::grey();
  const auto solved = radiosity::to_polygon_mesh(s.scene, s.result.elements, s.result.field, basis);
  const auto restored = radiosity::to_polygon_mesh(
      s.scene, radiosity::elements_of_field(s.scene, s.result.field), s.result.field, basis);
  // Lux by area: it cannot depend on how triangles fell into pieces.
  const auto lumens = [](const scene::PolygonMesh& m) {
    const auto& lux = *std::find_if(m.cell_arrays.begin(), m.cell_arrays.end(),
                                    [](const auto& a) { return a.name == "illuminance_lux"; });
    double sum = 0.0;
    std::size_t first = 0;
    for (std::size_t k = 0; k < m.polygon_sizes.size(); first += m.polygon_sizes[k++]) {
      Vec3d twice = Vec3d::Zero();
      for (std::size_t i = 1; i + 1 < m.polygon_sizes[k]; ++i) {
        const Vec3d& o = m.points[m.polygon_points[first]];
        twice += (m.points[m.polygon_points[first + i]] - o)
                     .cross(m.points[m.polygon_points[first + i + 1]] - o);
      }
      sum += 0.5 * twice.norm() * static_cast<double>(lux.values[k]);
    }
    return sum;
  };
  EXPECT_NEAR(lumens(restored), lumens(solved), 1e-4 * lumens(solved));
}

}  // namespace
