#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "cost.h"
#include "radiosity/form_factor.h"
#include "support/scenes.h"

namespace atrium::bench {
namespace {

constexpr double kPi = std::numbers::pi;

// Furnace: in a closed room whose walls all emit L and reflect rho, E = pi L / (1 - rho)
// everywhere.
TEST(PointReference, UniformEnclosureIsAGeometricSeries) {
  testing::SceneMaker maker;
  maker.box(maker.diffuse(0.5, 1.0), {0, 0, 0}, {3, 2, 4}, true);
  const Workload room("furnace", maker.model());
  for (const double size : {0.0, 0.5}) {
    SCOPED_TRACE(size);
    const std::vector<Receiver> receivers = choose_receivers(room, 20, size, 1);
    const PointValues v = trace_receivers(room, receivers, 2048, 5);
    const double deviation = std::sqrt(v.variance[0] / 20.0);
    EXPECT_LT(deviation, 0.02 * kPi);
    // Twenty receivers of about the variance of the first; four standard errors.
    EXPECT_NEAR(v.area_mean(), 2.0 * kPi, 4.0 * deviation);
  }
}

// A black floor below a lamp: E is the factor from the point to the polygon times pi L.
TEST(PointReference, LampAboveABlackFloorIsThePolygonFactor) {
  testing::SceneMaker maker;
  maker.quad(maker.diffuse(1e-9), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  maker.quad(maker.diffuse(0.0, 3.0), {-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1});
  const Workload scene("lamp", maker.model());
  const std::vector<Receiver> receivers = choose_receivers(scene, 50, 0.0, 3);
  const PointValues v = trace_receivers(scene, receivers, 4096, 5);
  const Vec3d shift = scene.scene().origin;
  const std::vector<Vec3d> lamp = {{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}};
  double worst = 0.0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Vec3d p =
        receivers[i].sample(scene.scene(), {0.5f, 0.5f}).position.cast<double>() + shift;
    const double exact = 3.0 * kPi * radiosity::point_to_polygon(p, {0, 1, 0}, lamp);
    worst = std::max(worst, std::abs(v.mean[i] - exact) / std::sqrt(v.variance[i] + 1e-12));
  }
  // The largest of 50 Student's t of 15 degrees of freedom exceeds 5.5 once in 300 runs.
  EXPECT_LT(worst, 5.5);
}

// Values that are 2 % off at random and a reference of 3 % noise: what is found is the 2 %.
TEST(ErrorMeasure, NoiseOfTheReferenceIsSubtracted) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  PointValues reference;
  for (int i = 0; i < 20000; ++i) {
    const double truth = 1.0 + 0.5 * std::sin(i);
    values.push_back(truth * (1.0 + 0.02 * normal(random)));
    reference.mean.push_back(truth * (1.0 + 0.03 * normal(random)));
    reference.variance.push_back(std::pow(truth * 0.03, 2));
  }
  const ErrorMeasure m = measure_error(values, reference);
  EXPECT_LT(m.low, 0.02);
  EXPECT_GT(m.high, 0.02);
  EXPECT_LT(m.high - m.low, 0.002);
  EXPECT_NEAR(m.noise, 0.03, 0.001);
  EXPECT_NEAR(m.bias, 0.0, 0.002);
}

// Dark receivers count against 1 % of the mean: an error of 0.01 where E = 0 and the mean is 1
// (99 receivers of 100/99) is an error of 100 %.
TEST(ErrorMeasure, DarkReceiversCountAgainstTheFloor) {
  std::vector<double> reference(100, 100.0 / 99.0);
  reference[0] = 0.0;
  std::vector<double> values = reference;
  values[0] = 0.01;
  const ErrorMeasure m = measure_error(values, reference, std::vector<double>(100, 1.0));
  EXPECT_NEAR(m.rms, 0.1, 1e-12);
  EXPECT_NEAR(m.worst, 1.0, 1e-12);
  EXPECT_NEAR(m.most, 0.0, 1e-12);
}

// An error of c / sqrt(rays) is a line in the logarithms: interpolation is exact.
TEST(Cost, InterpolationIsExactForAPowerLaw) {
  CostSeries series;
  for (const std::uint64_t rays : {10000U, 100000U, 1000000U}) {
    CostRow row;
    row.rays = rays;
    row.patches.rms = 10.0 / std::sqrt(static_cast<double>(rays));
    series.rows.push_back(row);
  }
  EXPECT_NEAR(cost_to(series, 0.02, ErrorKind::Total, CostKind::Rays), 250000.0, 1.0);
  EXPECT_EQ(cost_to(series, 0.5, ErrorKind::Total, CostKind::Rays), 10000.0);
  EXPECT_EQ(cost_to(series, 0.001, ErrorKind::Total, CostKind::Rays), 0.0);
}

}  // namespace
}  // namespace atrium::bench
