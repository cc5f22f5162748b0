#include "scene/sky.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "scene/sun.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

/// Integral over the upper hemisphere of `f(w) * w.y` by the midpoint rule on equal cells of
/// (Z^2-like) projected solid angle: sin^2 Z and azimuth uniform. Knows nothing of the sun.
template <class F>
double midpoint_irradiance(F&& f, int rings = 700, int sectors = 900) {
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double s = std::sqrt((i + 0.5) / rings);
    const double c = std::sqrt(1.0 - s * s);
    for (int j = 0; j < sectors; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / sectors;
      sum += f(Vec3d(s * std::cos(phi), c, s * std::sin(phi)));
    }
  }
  return kPi * sum / (static_cast<double>(rings) * sectors);
}

Vec3d sun_at(double elevation_deg, double azimuth_deg = 130.0) {
  return direction_of(azimuth_deg * kRadians, elevation_deg * kRadians);
}

std::vector<PerezState> perez_states() {
  std::vector<PerezState> states;
  for (const double direct : {0.0, 40.0, 120.0, 250.0, 400.0, 600.0, 800.0, 950.0}) {
    for (const double zenith : {20.0, 50.0, 75.0}) {
      const double diffuse = direct > 500.0 ? 90.0 : 180.0;
      states.push_back(perez_state(direct, diffuse, zenith * kRadians, 1.0));
    }
  }
  return states;
}

// ISO 15469:2004, Table 1: the six gradation and six indicatrix groups and how the types pair them.
TEST(CieSky, ParametersAreThoseOfTheStandard) {
  constexpr double gradation[6][2] = {{4.0, -0.70},  {1.1, -0.80},  {0.0, -1.00},
                                      {-1.0, -0.55}, {-1.0, -0.32}, {-1.0, -0.15}};
  constexpr double indicatrix[6][3] = {{0, -1.0, 0.0},   {2, -1.5, 0.15},  {5, -2.5, 0.30},
                                       {10, -3.0, 0.45}, {16, -3.0, 0.30}, {24, -2.8, 0.15}};
  constexpr int pair[15][2] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1}, {3, 2}, {3, 3}, {3, 4},
                               {4, 2}, {4, 3}, {4, 4}, {5, 4}, {5, 5}, {6, 5}, {6, 6}};
  for (int type = 1; type <= 15; ++type) {
    const auto s = std::get<GradationSky>(cie_sky(type));
    const auto& g = gradation[pair[type - 1][0] - 1];
    const auto& i = indicatrix[pair[type - 1][1] - 1];
    EXPECT_EQ(std::tie(s.a, s.b, s.c, s.d, s.e), std::tie(g[0], g[1], i[0], i[1], i[2])) << type;
  }
  EXPECT_THROW((void)cie_sky(0), std::invalid_argument);
  EXPECT_THROW((void)cie_sky(17), std::invalid_argument);
}

// E = 7 pi / 9 of the zenith's luminance under the traditional overcast sky, pi under the uniform
// one; the ratio of a dome's own values must be the closed form.
TEST(SkyDome, ClosedForms) {
  const SkyDome overcast(cie_sky(16), sun_at(40.0), 0.0);
  EXPECT_NEAR(overcast.zenith(), 9.0 / (7.0 * kPi), 1e-6);
  EXPECT_NEAR(overcast.at(Vec3d(1.0, 1e-9, 0.0).normalized()) / overcast.zenith(), 1.0 / 3.0, 1e-6);
  const SkyDome uniform(cie_sky(5), sun_at(40.0), 0.3, 0.5);
  EXPECT_NEAR(uniform.zenith(), 1.0 / kPi, 1e-9);
  EXPECT_NEAR(uniform.at(Vec3d(0.6, 0.1, 0.2).normalized()), 1.0 / kPi, 1e-9);
  EXPECT_NEAR(uniform.at(Vec3d(0.6, -0.1, 0.2).normalized()), 0.3 * 1.5 / kPi, 1e-12);
  EXPECT_NEAR(uniform.mean(), (1.0 + 0.45) / (2.0 * kPi), 1e-9);
  // Type 1 has the same darkening towards the horizon as the traditional one: 1 / (1 + 4 e^-0.7).
  const SkyDome standard(cie_sky(1), sun_at(40.0), 0.0);
  EXPECT_NEAR(standard.at(Vec3d(1.0, 1e-9, 0.0).normalized()) / standard.zenith(),
              1.0 / (1.0 + 4.0 * std::exp(-0.7)), 1e-6);
}

// Every dome gives a horizontal irradiance of 1, by a quadrature that shares nothing with the
// library's. The midpoint rule is good to some 1e-5 here; the bound is the required 0.1 %.
TEST(SkyDome, EveryCieSkyHasUnitHorizontalIrradiance) {
  for (int type = 1; type <= 16; ++type) {
    for (const double elevation : {5.0, 35.0, 62.0, 90.0}) {
      const SkyDome dome(cie_sky(type), sun_at(elevation), 0.2);
      EXPECT_NEAR(midpoint_irradiance([&](const Vec3d& w) { return dome.at(w); }), 1.0, 1e-3)
          << "type " << type << ", sun at " << elevation;
    }
  }
}

TEST(SkyDome, EveryPerezRangeHasUnitHorizontalIrradiance) {
  int ranges_seen = 0;
  double last = 0.0;
  for (const PerezState& state : perez_states()) {
    const SkyDome dome(perez_sky(state), direction_of(1.0, 0.5 * kPi - state.sun_zenith), 0.2);
    EXPECT_NEAR(midpoint_irradiance([&](const Vec3d& w) { return dome.at(w); }), 1.0, 1e-3)
        << state.clearness << ", " << state.brightness << ", " << state.sun_zenith;
    if (state.clearness > last) ++ranges_seen;
    last = std::max(last, state.clearness);
  }
  EXPECT_GE(ranges_seen, 8);
}

// The mean over the sphere, by the midpoint rule on cells of equal solid angle.
TEST(SkyDome, MeanIsTheIntegralOverDirections) {
  for (const int type : {1, 7, 12, 15, 16}) {
    const SkyDome dome(cie_sky(type), sun_at(35.0), 0.25, 2.0);
    constexpr int n = 800;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      const double c = (i + 0.5) / n, s = std::sqrt(1.0 - c * c);
      for (int j = 0; j < n; ++j) {
        const double phi = 2.0 * kPi * (j + 0.5) / n;
        sum += dome.at({s * std::cos(phi), c, s * std::sin(phi)}) / (n * n);
      }
    }
    EXPECT_NEAR(dome.mean(), 0.5 * (sum + dome.ground()), 1e-4 * dome.mean()) << type;
  }
}

// Turning sky and sun together about the vertical changes nothing; skies without a sun's indicatrix
// are the same all round.
TEST(SkyDome, TurnsWithTheSun) {
  for (const int type : {1, 3, 5, 12, 14, 16}) {
    const SkyDome a(cie_sky(type), sun_at(30.0, 20.0), 0.2);
    const SkyDome b(cie_sky(type), sun_at(30.0, 95.0), 0.2);
    for (const double azimuth : {0.0, 40.0, 200.0, 310.0}) {
      for (const double elevation : {2.0, 30.0, 70.0}) {
        EXPECT_NEAR(a.at(sun_at(elevation, azimuth)), b.at(sun_at(elevation, azimuth + 75.0)),
                    1e-9);
        if (needs_sun(a.pattern())) continue;
        EXPECT_NEAR(a.at(sun_at(elevation, azimuth)), a.at(sun_at(elevation, 0.0)), 1e-12);
      }
    }
  }
}

// The paper's definitions, worked by hand: 400 W/m^2 direct, 200 diffuse, sun at 40 degrees from
// the zenith. kappa Z^3 = 0.3546, eps = (3 + 0.3546) / 1.3546; Delta = 200 m / 1367 with m
// = 1.3045.
TEST(Perez, ClearnessAndBrightness) {
  const PerezState s = perez_state(400.0, 200.0, 40.0 * kRadians, 1.0);
  EXPECT_NEAR(s.clearness, 2.4765, 1e-3);
  EXPECT_NEAR(s.brightness, 0.1908, 2e-4);
  const PerezState overcast = perez_state(0.0, 150.0, 1.0, 1.0);
  EXPECT_EQ(overcast.clearness, 1.0);
}

// Range 8 has plain linear parameters, range 1 its own forms of c and d, ranges 2 to 5 a brightness
// of at least 0.2.
TEST(Perez, ParametersByHand) {
  const double z = 0.5;
  const GradationSky clear = perez_sky({10.0, 0.1, z});
  EXPECT_NEAR(clear.a, -1.05 + 0.0289 * z + 0.1 * (0.426 + 0.359 * z), 1e-12);
  EXPECT_NEAR(clear.c, 31.0625 - 14.5 * z + 0.1 * (-46.1148 + 55.375 * z), 1e-12);
  EXPECT_NEAR(clear.d, -7.2312 + 0.405 * z + 0.1 * (13.35 + 0.6234 * z), 1e-12);
  const GradationSky overcast = perez_sky({1.0, 0.3, z});
  EXPECT_NEAR(overcast.c, std::exp(std::pow(0.3 * (2.8 + 0.6004 * z), 1.2375)) - 1.0, 1e-12);
  EXPECT_NEAR(overcast.d, -std::exp(0.3 * (1.8734 + 0.6297 * z)) + 0.9738 + 0.3 * 0.2809, 1e-12);
  EXPECT_EQ(perez_sky({2.0, 0.05, z}).c, perez_sky({2.0, 0.2, z}).c);
  EXPECT_NE(perez_sky({2.0, 0.25, z}).c, perez_sky({2.0, 0.2, z}).c);
}

// A clear sky is brightest around the sun, an overcast one towards the zenith and even around it.
TEST(Perez, ClearSkiesFollowTheSunOvercastOnesDoNot) {
  const double z = 50.0 * kRadians;
  const SkyDome clear(perez_sky(perez_state(850.0, 90.0, z, 1.0)), sun_at(40.0), 0.2);
  EXPECT_GT(clear.at(sun_at(40.0)), 8.0 * clear.at(sun_at(60.0, 310.0)));
  const SkyDome overcast(perez_sky(perez_state(0.0, 150.0, z, 1.0)), sun_at(40.0), 0.2);
  EXPECT_GT(overcast.zenith(), 1.5 * overcast.at(sun_at(5.0, 310.0)));
  EXPECT_LT(overcast.at(sun_at(40.0)), 1.5 * overcast.at(sun_at(40.0, 310.0)));
}

// Perez et al. 1990: around 120 lm/W for overcast skies, 130 to 150 for the blue of clear ones,
// near 100 for a high sun, less for a low one.
TEST(Perez, EfficaciesAreThoseOfDaylight) {
  const PerezState overcast = perez_state(0.0, 150.0, 1.0, 1.0);
  EXPECT_NEAR(perez_diffuse_efficacy(overcast, 10.0), 119.0, 5.0);
  const PerezState clear = perez_state(850.0, 90.0, 0.7, 1.0);
  EXPECT_NEAR(perez_diffuse_efficacy(clear, 10.0), 135.0, 10.0);
  EXPECT_NEAR(perez_direct_efficacy(clear, 10.0), 103.0, 3.0);
  const PerezState low = perez_state(400.0, 60.0, 85.0 * kRadians, 1.0);
  EXPECT_LT(perez_direct_efficacy(low, 10.0), 75.0);
  // Range 4 at the horizon: 110 - 1.99 exp(5.73 Z - 5) is negative.
  EXPECT_EQ(perez_direct_efficacy(perez_state(68.0, 20.0, 1.55, 1.0), 20.0), 0.0);
}

}  // namespace
}  // namespace atrium::scene
