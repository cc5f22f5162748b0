#include "barrier_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace atrium::radiosity {
namespace {

constexpr double kTolerance = 1e-5;

/// Barriers of many lengths on a line, both ends up to the tolerance beside it; angle [rad].
std::vector<Barrier> on_line(double angle, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3d along(std::cos(angle), std::sin(angle), 0.0), across(-along.y(), along.x(), 0.0);
  std::vector<Barrier> barriers;
  for (int i = 0; i < 200; ++i) {
    const double length = std::pow(10.0, -5.0 + 0.03 * i);  // 10 um to 10 m
    const Vec3d from = 5.0 * uniform(random) * along + kTolerance * uniform(random) * across;
    const Vec3d to = from + length * along + kTolerance * uniform(random) * across;
    barriers.push_back({from, to, true, {}});
  }
  return barriers;
}

// None that may lie on a line is missed, at the ends of the range of angles either, and each is
// named once.
TEST(BarrierDirections, AllOfALineAreFound) {
  constexpr double kPi = std::numbers::pi;
  for (const double angle : {0.0, 1e-7, 0.3, 0.5 * kPi, kPi - 1e-7, kPi - 0.03, kPi}) {
    SCOPED_TRACE(angle);
    const std::vector<Barrier> barriers = on_line(angle, 1);
    const BarrierDirections directions(barriers, Vec3d::UnitX(), Vec3d::UnitZ(), 2.0 * kTolerance);
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::uint32_t> found;
      directions.along(sign * Vec3d(std::cos(angle), std::sin(angle), 0.0), found);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      EXPECT_EQ(found.size(), barriers.size());
    }
  }
}

// Of long barriers in all directions few are looked at.
TEST(BarrierDirections, OthersAreLeftOut) {
  std::vector<Barrier> barriers;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.001 * std::numbers::pi * i;
    barriers.push_back({Vec3d::Zero(), Vec3d(std::cos(angle), std::sin(angle), 0.0), true, {}});
  }
  const BarrierDirections directions(barriers, Vec3d::UnitX(), Vec3d::UnitZ(), kTolerance);
  std::vector<std::uint32_t> found;
  directions.along(Vec3d::UnitY(), found);
  EXPECT_GE(found.size(), 1U);
  EXPECT_LE(found.size(), 40U);
}

}  // namespace
}  // namespace atrium::radiosity
