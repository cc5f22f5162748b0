#include "scene/sun.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace atrium::scene {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// The worked example of Reda & Andreas 2004 (NREL/TP-560-34302, Table A4.1 and A5): Golden,
// Colorado, 17 October 2003, 12:30:30 at UTC-7, 820 hPa, 11 C. The stated accuracy is 0.01 degrees.
TEST(SunPosition, ExampleOfTheSolarPositionAlgorithm) {
  const SunPosition sun =
      sun_position({39.742476, -105.1786, -7.0}, {2003, 10, 17, 12.0 + 30.5 / 60.0});
  EXPECT_NEAR(sun.azimuth * kDegrees, 194.34024, 0.01);
  const double apparent = sun.elevation + refraction(sun.elevation, 820.0, 11.0);
  EXPECT_NEAR(90.0 - apparent * kDegrees, 50.11162, 0.01);
  EXPECT_NEAR(sun.elevation * kDegrees, 39.872046, 0.01);
  EXPECT_NEAR(sun.declination * kDegrees, -9.31434, 0.01);
  EXPECT_NEAR(sun.distance_au, 0.9965422974, 2e-5);
}

// Meeus, example 25.a: 13 October 1992, 0h dynamical time. Apparent declination -7.78507 degrees,
// R = 0.99766.
TEST(SunPosition, ExampleOfMeeus) {
  const SunPosition sun = sun_position({0.0, 0.0, 0.0}, {1992, 10, 13, 0.0});
  EXPECT_NEAR(sun.declination * kDegrees, -7.78507, 0.001);
  EXPECT_NEAR(sun.distance_au, 0.99766, 1e-5);
}

// Solstices and equinoxes of 2000 by their published moments (USNO): 20 March 07:35, 21 June 01:48,
// 22 September 17:27, 21 December 13:37 UTC.
TEST(SunPosition, SeasonsOf2000) {
  const auto declination = [](int month, int day, double hour) {
    return sun_position({0.0, 0.0, 0.0}, {2000, month, day, hour}).declination * kDegrees;
  };
  EXPECT_NEAR(declination(3, 20, 7.0 + 35.0 / 60.0), 0.0, 0.005);
  EXPECT_NEAR(declination(6, 21, 1.8), 23.438, 0.003);
  EXPECT_NEAR(declination(9, 22, 17.45), 0.0, 0.005);
  EXPECT_NEAR(declination(12, 21, 13.6), -23.438, 0.003);
}

// Clock and zone only name the moment: the same sun at any offset, across midnight and new year.
TEST(SunPosition, ClocksNameTheSameMoment) {
  const SunPosition a = sun_position({-33.9, 151.2, 0.0}, {2019, 12, 31, 23.5});
  const SunPosition b = sun_position({-33.9, 151.2, 10.0}, {2020, 1, 1, 9.5});
  const SunPosition c = sun_position({-33.9, 151.2, 10.0}, {2019, 12, 31, 33.5});
  for (const SunPosition& s : {b, c}) {
    EXPECT_NEAR(a.azimuth, s.azimuth, 1e-9);
    EXPECT_NEAR(a.elevation, s.elevation, 1e-9);
  }
  // In Sydney's morning the summer sun stands in the east to north-east.
  EXPECT_GT(a.azimuth * kDegrees, 60.0);
  EXPECT_LT(a.azimuth * kDegrees, 100.0);
}

TEST(SunPosition, ImpossibleDatesAreRefused) {
  EXPECT_THROW((void)sun_position({}, {2023, 2, 29, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)sun_position({}, {2100, 2, 29, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)sun_position({}, {2023, 13, 1, 0.0}), std::invalid_argument);
  EXPECT_NO_THROW((void)sun_position({}, {2024, 2, 29, 0.0}));
}

TEST(SunPosition, DirectionsTurnWithNorth) {
  const double quarter = 0.5 * std::numbers::pi;
  EXPECT_TRUE(direction_of(0.0, 0.0).isApprox(-Vec3d::UnitZ(), 1e-12));     // north
  EXPECT_TRUE(direction_of(quarter, 0.0).isApprox(Vec3d::UnitX(), 1e-12));  // east
  EXPECT_TRUE(direction_of(0.3, quarter).isApprox(Vec3d::UnitY(), 1e-12));
  // A building turned so that its +x looks north: azimuth 0 is +x and east is +z.
  const Eigen::Affine3d turn = turned_to_north(quarter);
  EXPECT_TRUE((turn * direction_of(0.0, 0.0)).isApprox(Vec3d::UnitX(), 1e-12));
  EXPECT_TRUE((turn * direction_of(quarter, 0.0)).isApprox(Vec3d::UnitZ(), 1e-12));
}

// Kasten & Young 1989, Table 1: 1.9943 at 60 degrees, 5.5841 at 80, 37.9196 at 90.
TEST(AirMass, PublishedValues) {
  EXPECT_NEAR(air_mass(0.0), 1.0, 1e-3);
  EXPECT_NEAR(air_mass(60.0 / kDegrees), 1.994, 2e-3);
  EXPECT_NEAR(air_mass(80.0 / kDegrees), 5.58, 0.02);
  EXPECT_NEAR(air_mass(90.0 / kDegrees), 37.92, 0.05);
}

}  // namespace
}  // namespace atrium::scene
