#include "radiosity/measure.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "radiosity/form_factor.h"
#include "radiosity_support.h"
#include "scene/parallel.h"
#include "scene/sampler.h"

namespace atrium::radiosity {
namespace {

using test::diffuse;
using test::emitter;
using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;

std::vector<Reading> measure_direct(const scene::Scene& scene, std::span<const Sensor> sensors,
                                    const MeasureOptions& options = {}) {
  const scene::RayQuery query(scene);
  return measure(query, material::SpectralBasis::grey(), {}, sensors, options).readings;
}

// CIE 171:2006, 5.2: I = 1000 cd cos(theta), 3 m above a plane; E = I0 h^2 / d^4. The table in
// steps of a quarter degree is linear between its angles, off by at most 2.4e-6.
TEST(Measure, PointSourceOfCie171) {
  SceneMaker maker;
  const auto black = maker.material(diffuse(0.0));
  maker.quad(black, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  scene::Scene scene = maker.take();
  scene::ProfileLight lambertian;
  for (int i = 0; i <= 360; ++i) {
    lambertian.profile.theta_deg.push_back(0.25 * i);
    lambertian.profile.candela.push_back(1000.0 * std::cos(0.25 * i * kPi / 180.0));
  }
  lambertian.profile.phi_deg = {0.0};
  scene::Light light;
  light.kind = lambertian;  // looks along -z
  light.to_scene.translation() = Vec3d(0, 0, 3);
  scene.lights.push_back(light);
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {1.5, 1.5, 0}};
  const std::vector<double> table{111.11, 90.00, 49.38};
  std::vector<Sensor> sensors;
  for (const Vec3d& p : points) sensors.push_back({p, Vec3d::UnitZ()});
  const auto readings = measure_direct(scene, sensors);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d2 = 9.0 + points[i].squaredNorm();
    ASSERT_TRUE(readings[i].valid);
    EXPECT_TRUE(readings[i].on_surface);
    EXPECT_NEAR(readings[i].total.y / (1000.0 * 9.0 / (d2 * d2)), 1.0, 1e-5);
    EXPECT_NEAR(readings[i].total.y, table[i], 0.006);
    EXPECT_EQ(readings[i].total.standard_error, 0.0);
  }
}

/// E at p of a panel [1.5, 2.5]^2 at height 3 that looks down, by midpoints: the relative error of
/// n^2 cells is about h^2 / (12 d^2) < 1e-6 for the distances here.
double panel_by_midpoints(const Vec3d& p, const Vec3d& n, double radiance) {
  constexpr int kCells = 600;
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const Vec3d d = Vec3d(1.5 + (i + 0.5) / kCells, 1.5 + (j + 0.5) / kCells, 3.0) - p;
      const double r2 = d.squaredNorm();
      sum += std::max(0.0, n.dot(d)) * d.z() / (r2 * r2);
    }
  return radiance * sum / (kCells * kCells);
}

// CIE 171:2006, 5.3: a panel of 1 m^2 and 1000 cd/m^2 at the centre of the ceiling, 4 x 4 x 3 m,
// black; sensors lie on the wall y = 0 and on the floor. Closed form, rounded.
TEST(Measure, AreaSourceOfCie171) {
  SceneMaker maker;
  const auto black = maker.material(diffuse(0.0));
  maker.room({0, 0, 0}, {4, 4, 3}, black);
  const auto panel = maker.material(emitter(1000.0, 0.0));
  maker.quad(panel, {1.5f, 1.5f, 3}, {1.5f, 2.5f, 3}, {2.5f, 2.5f, 3}, {2.5f, 1.5f, 3});
  const scene::Scene scene = maker.take();
  std::vector<Sensor> sensors;
  for (int i = 0; i < 6; ++i) sensors.push_back({{2, 0, 2.75 - 0.5 * i}, Vec3d::UnitY()});
  for (int i = 0; i < 4; ++i) sensors.push_back({{2, 0.25 + 0.5 * i, 0}, Vec3d::UnitZ()});
  const std::vector<double> table{32.68, 75.19, 81.32, 69.06, 53.40,
                                  40.00, 61.42, 79.26, 95.67, 105.78};
  const auto readings = measure_direct(scene, sensors);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_TRUE(readings[i].on_surface);
    EXPECT_NEAR(readings[i].total.y, table[i], 0.006);
    EXPECT_NEAR(
        readings[i].total.y / panel_by_midpoints(sensors[i].position, sensors[i].normal, 1000.0),
        1.0, 2e-6);
    EXPECT_LT(readings[i].total.standard_error, 1e-12);
  }
}

/// Emitter [0, 1]^2 at z = 1 that looks down, a screen [0, 1/2]^2 at z = 1/2.
scene::Scene screened_squares() {
  SceneMaker maker;
  const auto lamp = maker.material(emitter(1.0, 0.0));
  maker.quad(lamp, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1});
  const auto black = maker.material(diffuse(0.0));
  maker.quad(black, {0, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0.5f, 0.5f}, {0, 0.5f, 0.5f});
  return maker.take();
}

// VERIFICATION 3.1: the screen and its three mirror images tile the square, so it blocks exactly a
// quarter of F = 0.199824896. The mean over the receiver by eight scrambles of 256 points.
TEST(Measure, AQuarterOfTheFormFactorIsBlocked) {
  const scene::Scene scene = screened_squares();
  constexpr int kGroups = 8;
  std::vector<Sensor> sensors;
  for (std::uint32_t g = 0; g < kGroups; ++g)
    for (std::uint32_t k = 0; k < 256; ++k) {
      const Vec2f u = scene::Sampler(7, g, k).next_2d();
      sensors.push_back(
          {Vec3d(static_cast<double>(u.x()), static_cast<double>(u.y()), 0.0), Vec3d::UnitZ()});
    }
  const auto readings = measure_direct(scene, sensors, {.error = 0.02});
  std::array<double, kGroups> means{};
  for (std::size_t i = 0; i < readings.size(); ++i)
    means[i / 256] += readings[i].direct.y / (256.0 * kPi);
  double mean = 0.0, squares = 0.0;
  for (const double m : means) mean += m / kGroups;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double error = std::sqrt(squares / (kGroups * (kGroups - 1.0)));
  EXPECT_LT(error, 3e-4);
  EXPECT_NEAR(mean, 0.149868672, 3.5 * error);  // Student t, 7 degrees of freedom: 99 %
}

// From the middle of the receiver the screen hides a quarter of the emitter, exactly. The stated
// error is checked for coverage: 95 % of 300 runs, binomial standard error 1.3 %.
TEST(Measure, StandardErrorOfAPartlyHiddenPolygonCoversTheTruth) {
  const scene::Scene scene = screened_squares();
  const scene::RayQuery query(scene);
  const std::vector<Sensor> sensor{{{0.5, 0.5, 0.0}, Vec3d::UnitZ()}};
  const std::vector<Vec3d> square{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  const double exact = 0.75 * kPi * point_to_polygon(sensor[0].position, sensor[0].normal, square);
  constexpr int kRuns = 300;
  constexpr double kStudent15 = 2.131;
  int covered = 0;
  double sum = 0.0, variance = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Reading r =
        measure(query, material::SpectralBasis::grey(), {}, sensor, {.error = 0.02, .seed = seed})
            .readings[0];
    EXPECT_GT(r.total.standard_error, 0.0);
    variance += r.total.standard_error * r.total.standard_error / kRuns;
    covered += std::abs(r.total.y - exact) <= kStudent15 * r.total.standard_error ? 1 : 0;
    sum += r.total.y;
  }
  RecordProperty("covered", covered);
  EXPECT_GE(covered, 0.91 * kRuns);
  EXPECT_LE(covered, 0.99 * kRuns);
  EXPECT_LT(std::sqrt(variance) / exact, 0.02);  // as asked for
  EXPECT_NEAR(sum / kRuns / exact, 1.0, 3.0 * 0.02 / std::sqrt(kRuns));
}

// Furnace: whatever the place and direction, E = M / (1 - rho) within a closed cell that emits M.
// The field is the exact one, so that what is tested is the sensor.
TEST(Measure, FurnaceCell) {
  constexpr double kRho = 0.7;
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 2, 3}, maker.material(emitter(1.0 / kPi, kRho)));
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  scene::SurfaceField field = make_elements(scene, {.max_elements = 300}).layout;
  field.lanes = 1;
  field.valid.assign(2 * field.element_count(), 1);
  field.irradiance.direct.assign(field.valid.size(), 1.0f);
  field.irradiance.indirect.assign(field.valid.size(), static_cast<float>(kRho / (1.0 - kRho)));
  const std::vector<Sensor> sensors{{{1, 1, 1}, Vec3d::UnitZ()},
                                    {{3.5, 0.2, 2.7}, Vec3d(1, -2, 2) / 3.0},
                                    {{2, 0, 1}, Vec3d::UnitY()},
                                    {{0, 0.3, 2.9}, Vec3d::UnitX()}};
  for (const Reading& r :
       measure(query, material::SpectralBasis::grey(), field, sensors).readings) {
    ASSERT_TRUE(r.valid);
    EXPECT_NEAR(r.direct.y, 1.0, 2e-6);
    EXPECT_NEAR(r.total.y * (1.0 - kRho), 1.0, 2e-6);
    EXPECT_EQ(r.caustic.y, 0.0);
  }
}

// A perfect mirror at x = 0 shows the panel's image. A sensor in the open finds it with its own
// rays; light of a point source that comes this way is only found on surfaces, and that is said.
TEST(Measure, CausticsInTheOpenAreTheImageOfThePanel) {
  SceneMaker maker;
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.n = 1.0;
  mirror.kappa = 1e5;
  maker.quad(maker.material(mirror), {0, -9, -9}, {0, 9, -9}, {0, 9, 9}, {0, -9, 9});
  const auto lamp = maker.material(emitter(10.0, 0.0));
  maker.quad(lamp, {1, 0, 2}, {1, 1, 2}, {2, 1, 2}, {2, 0, 2});
  const std::vector<Sensor> sensors{{{1, 0.5, 0}, Vec3d::UnitZ()}};
  const std::vector<Vec3d> image{{-1, 0, 2}, {-1, 1, 2}, {-2, 1, 2}, {-2, 0, 2}};
  scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  const MeasureResult alone = measure(query, material::SpectralBasis::grey(), {}, sensors);
  const Reading& r = alone.readings[0];
  const double exact = 10.0 * kPi * point_to_polygon(sensors[0].position, sensors[0].normal, image);
  EXPECT_GT(r.caustic.standard_error, 0.0);
  EXPECT_NEAR(r.caustic.y, exact, 3.0 * r.caustic.standard_error);
  EXPECT_LT(r.total.standard_error, 0.015 * r.total.y);
  EXPECT_EQ(alone.caustics_missing, 0u);

  scene.lights.push_back(
      {.name = "", .kind = scene::PointLight{}, .to_scene = Eigen::Affine3d::Identity()});
  scene.lights[0].to_scene.translation() = Vec3d(1, 1, 1);
  EXPECT_EQ(measure(query, material::SpectralBasis::grey(), {}, sensors).caustics_missing, 1u);
}

// On elements the reading agrees with the solution.
TEST(Measure, AgreesWithTheSolutionOnItsElements) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 3, 3}, maker.material(diffuse(0.6)));
  const auto panel = maker.material(emitter(100.0, 0.0));
  maker.quad(panel, {1.5f, 1, 2.99f}, {1.5f, 2, 2.99f}, {2.5f, 2, 2.99f}, {2.5f, 1, 2.99f});
  const Solved solved(maker.take(), {.max_elements = 2000, .gather_rays = 512});
  std::vector<Sensor> sensors;
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < solved.count(); e += 37) {
    if (solved.object(e) != 4) continue;  // the floor
    elements.push_back(e);
    sensors.push_back({solved.centre(e).cast<double>(), Vec3d::UnitZ()});
  }
  ASSERT_GT(sensors.size(), 5u);
  const MeasureResult result = measure(solved.query, material::SpectralBasis::grey(),
                                       solved.result.field, sensors, {.error = 0.005});
  double ratio = 0.0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Reading& r = result.readings[i];
    EXPECT_LT(r.total.standard_error, 0.0075 * r.total.y);
    const double indirect = solved.indirect(elements[i]);
    EXPECT_NEAR(r.indirect.y / indirect, 1.0, 0.05);  // single elements: 640 rays, 1.5 % each
    ratio += r.indirect.y / indirect / static_cast<double>(sensors.size());
  }
  EXPECT_NEAR(ratio, 1.0, 0.01);
}

TEST(Measure, SensorsInsideSolidsAreNotValid) {
  SceneMaker maker;
  const auto grey = maker.material(diffuse(0.5));
  maker.room({0, 0, 0}, {4, 4, 3}, grey);
  std::vector<Vec3f> p;
  for (int i = 0; i < 8; ++i)
    p.emplace_back((i & 1) != 0 ? 2.0f : 1.0f, (i & 2) != 0 ? 2.0f : 1.0f,
                   (i & 4) != 0 ? 1.0f : 0.0f);
  maker.object(grey, p,
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
                {1, 7, 5}},
               /*closed=*/true);
  maker.point_light({2, 2, 2.5}, 100.0);
  const std::vector<Sensor> sensors{{{1.5, 1.5, 0.5}, Vec3d::UnitZ()},
                                    {{1.5, 1.5, 1.0}, Vec3d::UnitZ()},
                                    {{3.0, 3.0, 0.5}, Vec3d::UnitZ()},
                                    {{1.0, 1.5, 0.5}, -Vec3d::UnitX()}};
  const auto readings = measure_direct(maker.take(), sensors);
  EXPECT_FALSE(readings[0].valid);
  for (const std::size_t i : {1U, 2U, 3U}) EXPECT_TRUE(readings[i].valid);
  const double d2 = 0.5 + 1.5 * 1.5;
  EXPECT_NEAR(readings[1].total.y, 100.0 * 1.5 / (d2 * std::sqrt(d2)), 1e-4);
  EXPECT_EQ(readings[3].total.y, 0.0);  // looks away from the light
}

// Unit radiance from all around: E = pi on an open plane, pi (1 + cos(tilt)) / 2 above a black
// ground, which a tilted sensor that lies on it must not see through.
TEST(Measure, OpenSky) {
  SceneMaker maker;
  maker.quad(maker.material(diffuse(0.0)), {-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  scene::Scene scene = maker.take();
  scene.environment =
      scene::Environment{.radiance = 1.0, .pattern = {}, .to_scene = Eigen::Affine3d::Identity()};
  const double tilt = kPi / 3.0;
  const Vec3d tilted(std::sin(tilt), 0.0, std::cos(tilt));
  const std::vector<Sensor> sensors{
      {{0, 0, 0}, Vec3d::UnitZ()}, {{0, 0, 0}, tilted}, {{0, 0, 1e-6}, tilted}};
  const auto readings = measure_direct(scene, sensors, {.error = 0.002});
  EXPECT_NEAR(readings[0].total.y, kPi, 1e-5);
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_GT(readings[i].total.standard_error, 0.0);
    EXPECT_NEAR(readings[i].total.y, kPi * (1.0 + std::cos(tilt)) / 2.0,
                3.0 * readings[i].total.standard_error);
  }
}

TEST(Measure, SameBitsWithAnyNumberOfThreadsAndAnyNeighbours) {
  const scene::Scene scene = screened_squares();
  std::vector<Sensor> sensors;
  for (int i = 0; i < 40; ++i) sensors.push_back({{0.02 * i, 0.3, 0.0}, Vec3d::UnitZ()});
  const auto values = [&](int threads, std::size_t count) {
    const scene::ThreadLimit limit(threads);
    std::vector<double> y;
    for (const Reading& r : measure_direct(scene, std::span(sensors).first(count)))
      y.push_back(r.total.y);
    return y;
  };
  const std::vector<double> one = values(1, 40);
  EXPECT_EQ(one, values(2, 40));
  const std::vector<double> few = values(2, 10);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), one.begin()));
}

TEST(Measure, RefusesWhatMakesNoSense) {
  const scene::Scene scene = screened_squares();
  const std::vector<Sensor> long_normal{{{0, 0, 0}, {0, 0, 2}}};
  const std::vector<Sensor> nowhere{{{0, std::nan(""), 0}, Vec3d::UnitZ()}};
  const std::vector<Sensor> fine{{{0, 0, 0}, Vec3d::UnitZ()}};
  EXPECT_THROW((void)measure_direct(scene, long_normal), std::invalid_argument);
  EXPECT_THROW((void)measure_direct(scene, nowhere), std::invalid_argument);
  EXPECT_THROW((void)measure_direct(scene, fine, {.error = 0.0}), std::invalid_argument);
}

// A slit of 5 mm in a roof that nothing was told of: the pilot's rays all miss it, and yet the
// reading must be as good as its rays allow, not the one lucky sample of the pilot's number.
// Reference: a uniform sky's irradiance is pi L times the point-to-polygon factor.
TEST(Measure, PilotThatSeesNothingIsNoAnswer) {
  SceneMaker maker;
  const auto black = maker.material(diffuse(0.0));
  maker.quad(black, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  for (const float s : {-1.0f, 1.0f}) {
    maker.quad(black, {2 * s, -2, 0}, {2 * s, 2, 0}, {2 * s, 2, 3}, {2 * s, -2, 3});
    maker.quad(black, {-2, 2 * s, 0}, {2, 2 * s, 0}, {2, 2 * s, 3}, {-2, 2 * s, 3});
    maker.quad(black, {0.0025f * s, -2, 3}, {0.0025f * s, 2, 3}, {2 * s, 2, 3}, {2 * s, -2, 3});
  }
  scene::Scene scene = maker.take();
  scene.environment.emplace().radiance = 100.0;
  scene.portals.find = false;
  std::vector<Sensor> sensors;
  for (const double x : {-1.5, -0.7, 0.0, 0.4, 1.1})
    sensors.push_back({{x, 0.3, 0}, Vec3d::UnitZ()});
  const auto readings = measure_direct(scene, sensors);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::vector<Vec3d> slit{
        {-0.0025, -2, 3}, {-0.0025, 2, 3}, {0.0025, 2, 3}, {0.0025, -2, 3}};
    const double expected =
        100.0 * kPi * point_to_polygon(sensors[i].position, Vec3d::UnitZ(), slit);
    const Amount& e = readings[i].total;
    EXPECT_LT(e.standard_error, 0.2 * expected) << i;
    EXPECT_NEAR(e.y, expected, 4.0 * e.standard_error) << i;
  }
}

}  // namespace
}  // namespace atrium::radiosity
