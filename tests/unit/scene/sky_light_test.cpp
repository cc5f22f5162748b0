// Light from the sky as LightSampler gives it: irradiances against quadrature, densities against
// counts, rooms with windows against integrals over the window.
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "scene/light_sampler.h"
#include "scene/sampler.h"
#include "scene/sun.h"
#include "support/scenes.h"

namespace atrium::scene {
namespace {

using testing::SceneMaker;
constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

Vec3d sun_at(double elevation_deg, double azimuth_deg) {
  return direction_of(azimuth_deg * kRadians, elevation_deg * kRadians);
}

/// Something to be in; the samplers are asked about free points.
Scene speck(const Environment& environment, std::vector<Light> lights = {}) {
  SceneMaker s;
  s.quad(s.diffuse(0.5), {0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0});
  s.model().environment = environment;
  s.model().lights = std::move(lights);
  return s.build();
}

Environment dome(const SkyPattern& pattern, double sun_elevation_deg, double north = 0.0) {
  Environment e;
  e.radiance = 10.0;
  e.pattern = SkyDome(pattern, sun_at(sun_elevation_deg, 150.0), 0.3, 0.7);
  e.to_scene = turned_to_north(north);
  return e;
}

/// 16 x 8 pixels that 8 bits could not hold: a dim floor of light, black patches, one hot pixel.
Environment hot_image() {
  Image image;
  image.width = 16;
  image.height = 8;
  image.channels = {"R", "G", "B"};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float v = u(random) < 0.4f ? 0.0f : u(random);
    for (int c = 0; c < 3; ++c) image.pixels.push_back(v);
  }
  for (std::size_t c = 0; c < 3; ++c) image.pixels[(2 * 16 + 5) * 3 + c] = 5000.0f;
  Environment e;
  e.radiance = 1.0;
  e.pattern = image;
  e.to_scene = turned_to_north(0.4);
  return e;
}

Environment uniform() {
  Environment e;
  e.radiance = 3.0;
  return e;
}

struct Case {
  const char* name;
  Environment environment;
};

std::vector<Case> cases() {
  std::vector<Case> list{{"uniform", uniform()}, {"image", hot_image()}};
  static const char* names[] = {"cie 1", "cie 5", "cie 8", "cie 12", "cie 15", "cie 16"};
  const int types[] = {1, 5, 8, 12, 15, 16};
  for (std::size_t i = 0; i < 6; ++i)
    list.push_back({names[i], dome(cie_sky(types[i]), 35.0, 0.8)});
  list.push_back({"perez clear", dome(perez_sky(perez_state(850, 90, 55 * kRadians, 1)), 35.0)});
  list.push_back({"perez mixed", dome(perez_sky(perez_state(200, 200, 55 * kRadians, 1)), 35.0)});
  list.push_back({"perez overcast", dome(perez_sky(perez_state(0, 120, 55 * kRadians, 1)), 35.0)});
  return list;
}

/// Sum over cells of equal solid angle.
template <class F>
double sphere_integral(F&& f, int rows, int columns) {
  double sum = 0.0;
  for (int i = 0; i < rows; ++i) {
    const double c = 1.0 - 2.0 * (i + 0.5) / rows, s = std::sqrt(1.0 - c * c);
    for (int j = 0; j < columns; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / columns;
      sum += f(Vec3d(s * std::cos(phi), c, s * std::sin(phi)));
    }
  }
  return sum * 4.0 * kPi / (static_cast<double>(rows) * columns);
}

struct Estimate {
  double mean = 0.0, error = 0.0, variance = 0.0;
};

/// Irradiance by independent random samples; `visible(wi)` says what is free.
template <class F>
Estimate irradiance(const LightSampler<1>& lights, const Vec3f& p, const Vec3f& normal, int samples,
                    F&& visible) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(0.0f, 0x1.fffffep-1f);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float choice = u(random);
    const float u0 = u(random), u1 = u(random);
    const auto s = lights.sample(p, normal, choice, {u0, u1});
    double value = 0.0;
    if (s && s->wi.dot(normal) > 0.0f && visible(*s))
      value = static_cast<double>(s->radiance[0] * s->wi.dot(normal) / s->pdf);
    sum += value;
    squares += value * value;
  }
  Estimate e;
  e.mean = sum / samples;
  e.variance = std::max(0.0, squares / samples - e.mean * e.mean);
  e.error = std::sqrt(e.variance / samples);
  return e;
}
const auto always = [](const LightSample<1>&) { return true; };

TEST(SkyLight, SampledIrradianceIsTheQuadrature) {
  for (const Case& c : cases()) {
    const Scene scene = speck(c.environment);
    const LightSampler<1> lights(scene, material::SpectralBasis::grey());
    for (const Vec3f& normal :
         {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(1, 0, 0), Vec3f(Vec3f(-1, 2, 1).normalized())}) {
      const double expected = sphere_integral(
          [&](const Vec3d& w) {
            const double cosine = w.dot(normal.cast<double>());
            return cosine > 0.0
                       ? cosine * static_cast<double>(lights.environment(w.cast<float>())[0])
                       : 0.0;
          },
          400, 800);
      const Estimate e = irradiance(lights, {0, 1, 0}, normal, 20000, always);
      EXPECT_NEAR(e.mean, expected, 3.0 * e.error + 1e-3 * expected) << c.name;
    }
    // What it is normalised to: the irradiance of the ground is the given one.
    if (!std::holds_alternative<SkyDome>(c.environment.pattern)) continue;
    const Estimate up = irradiance(lights, {0, 1, 0}, {0, 1, 0}, 20000, always);
    EXPECT_NEAR(up.mean, 10.0, 3.0 * up.error) << c.name;
    const Estimate down = irradiance(lights, {0, 1, 0}, {0, -1, 0}, 20000, always);
    EXPECT_NEAR(down.mean, 10.0 * 0.3 * 1.7, 3.0 * down.error + 1e-4) << c.name;
  }
}

TEST(SkyLight, ImagesAreNotQuantised) {
  const Scene scene = speck(hot_image());
  const LightSampler<1> lights(scene, material::SpectralBasis::grey());
  const double u = (5 + 0.5) / 16, v = (2 + 0.5) / 8;  // the hot pixel's centre
  const double theta = kPi * v, phi = 2.0 * kPi * (u - 0.5);
  const Vec3d w = turned_to_north(0.4) * Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta),
                                               -std::sin(theta) * std::cos(phi));
  EXPECT_NEAR(lights.environment(w.cast<float>())[0], 5000.0f, 1.0f);
}

// Densities: what sample() says of itself is what pdf_environment() says, and they integrate to 1.
TEST(SkyLight, DensitiesAgreeAndIntegrateToOne) {
  for (const Case& c : cases()) {
    const Scene scene = speck(c.environment);
    const LightSampler<1> lights(scene, material::SpectralBasis::grey());
    for (const Vec3f& normal : {Vec3f(0, 0, 0), Vec3f(0, 1, 0)}) {
      for (std::uint32_t i = 0; i < 200; ++i) {
        Sampler sampler(3, 0, i);
        const float choice = sampler.next_1d();
        const auto s = lights.sample({0, 1, 0}, normal, choice, sampler.next_2d());
        ASSERT_TRUE(s);
        EXPECT_NEAR(lights.pdf_environment({0, 1, 0}, normal, s->wi), s->pdf, 1e-4f * s->pdf);
      }
      const double sum = sphere_integral(
          [&](const Vec3d& w) {
            return static_cast<double>(lights.pdf_environment({0, 1, 0}, normal, w.cast<float>()));
          },
          512, 1024);
      EXPECT_NEAR(sum, 1.0, 2e-3) << c.name;
    }
  }
}

/// Chi-square of directions counted in cells of equal solid angle against the integrated density.
/// Returns its distance from the mean in standard deviations.
double chi_square(const LightSampler<1>& lights, const Vec3f& p, const Vec3f& normal, int samples) {
  constexpr int rows = 16, columns = 32, fine = 24;
  std::vector<double> expected(rows * columns, 0.0);
  std::vector<int> count(rows * columns, 0);
  for (int i = 0; i < rows * fine; ++i) {
    for (int j = 0; j < columns * fine; ++j) {
      const double c = 1.0 - 2.0 * (i + 0.5) / (rows * fine), s = std::sqrt(1.0 - c * c);
      const double phi = 2.0 * kPi * (j + 0.5) / (columns * fine);
      const Vec3d w(s * std::cos(phi), c, s * std::sin(phi));
      expected[static_cast<std::size_t>(i / fine * columns + j / fine)] +=
          static_cast<double>(lights.pdf_environment(p, normal, w.cast<float>())) * 4.0 * kPi /
          (rows * fine * columns * fine) * samples;
    }
  }
  std::mt19937 random(77);
  std::uniform_real_distribution<float> u(0.0f, 0x1.fffffep-1f);
  for (int i = 0; i < samples; ++i) {
    const float choice = u(random), u0 = u(random), u1 = u(random);
    const auto s = lights.sample(p, normal, choice, {u0, u1});
    if (!s) continue;
    const int row = std::clamp(static_cast<int>((1.0f - s->wi.y()) / 2.0f * rows), 0, rows - 1);
    double phi = std::atan2(static_cast<double>(s->wi.z()), static_cast<double>(s->wi.x()));
    if (phi < 0.0) phi += 2.0 * kPi;
    const int column = std::clamp(static_cast<int>(phi / (2.0 * kPi) * columns), 0, columns - 1);
    ++count[static_cast<std::size_t>(row * columns + column)];
  }
  double chi2 = 0.0, pooled_expected = 0.0;
  int pooled_count = 0, cells = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < 10.0) {  // rare cells together
      pooled_expected += expected[i];
      pooled_count += count[i];
      continue;
    }
    chi2 += std::pow(count[i] - expected[i], 2.0) / expected[i];
    ++cells;
  }
  if (pooled_expected > 10.0) {
    chi2 += std::pow(pooled_count - pooled_expected, 2.0) / pooled_expected;
    ++cells;
  } else {
    EXPECT_LT(pooled_count, 40);
  }
  return (chi2 - (cells - 1)) / std::sqrt(2.0 * (cells - 1));
}

// Eleven cases at 4 standard deviations: one false alarm in a few thousand runs, and the seed is
// fixed.
TEST(SkyLight, DirectionsFollowTheirDensity) {
  for (const Case& c : cases()) {
    const Scene scene = speck(c.environment);
    const LightSampler<1> lights(scene, material::SpectralBasis::grey());
    EXPECT_LT(chi_square(lights, {0, 1, 0}, Vec3f::Zero(), 50000), 4.0) << c.name;
  }
}

// The sun's disc gives its irradiance to a plane that faces it, and the sine of its elevation of
// that to the ground, whatever rounding does to half a degree.
TEST(SkyLight, SunDiscGivesItsIrradiance) {
  for (const double elevation : {1.0, 30.0, 77.0}) {
    Light sun;
    sun.kind = DirectionalLight{1000.0, static_cast<float>(kSunAngularRadius)};
    const Vec3d towards = sun_at(elevation, 200.0);
    sun.to_scene = look_at(Vec3d::Zero(), -towards, Vec3d::UnitY());
    const Scene scene = speck({}, {sun});
    const LightSampler<1> lights(scene, material::SpectralBasis::grey());
    const Estimate facing = irradiance(lights, {0, 1, 0}, towards.cast<float>(), 5000, always);
    EXPECT_NEAR(facing.mean, 1000.0, 0.3);
    const Estimate ground = irradiance(lights, {0, 1, 0}, {0, 1, 0}, 5000, always);
    EXPECT_NEAR(ground.mean, 1000.0 * std::sin(elevation * kRadians), 3.0 * ground.error + 0.3);
    EXPECT_EQ(lights.environment(sun_at(elevation + 0.28, 200.0).cast<float>())[0], 0.0f);
    EXPECT_GT(lights.environment(sun_at(elevation + 0.25, 200.0).cast<float>())[0], 0.0f);
  }
}

// Photons: what sample_emission() sends out adds up to flux().
TEST(SkyLight, EmittedFluxIsThatOfTheMeanRadiance) {
  for (const Case& c : cases()) {
    const Scene scene = speck(c.environment);
    const LightSampler<1> lights(scene, material::SpectralBasis::grey());
    double sum = 0.0, squares = 0.0;
    constexpr int n = 20000;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> u(0.0f, 0x1.fffffep-1f);
    for (int i = 0; i < n; ++i) {
      const float a = u(random), b = u(random), d = u(random), e = u(random), f = u(random);
      const auto s = lights.sample_emission(a, {b, d}, {e, f});
      ASSERT_TRUE(s);
      const double w = static_cast<double>(s->weight[0]);
      sum += w;
      squares += w * w;
    }
    const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
    const double flux = static_cast<double>(lights.flux()[0]);
    // The image's mean is that of its pixels, its bilinear surface is some percent off at the
    // poles.
    const double slack = std::holds_alternative<Image>(c.environment.pattern) ? 0.02 : 1e-4;
    EXPECT_NEAR(mean, flux, 4.0 * error + slack * flux) << c.name;
  }
}

// ---- rooms ----

/// A black room 5 x 3 x 4 (x, y, z) without the wall's part at x = 0, y in [1, 2.2], z in [1, 3],
/// and a second opening in the roof where asked for.
struct RoomOptions {
  bool pane = false;
  bool skylight = false;
  bool table = false;  ///< before the window, on two boards
};

Scene room(const Environment& environment, const PortalHints& hints, const RoomOptions& o = {},
           std::vector<Light> lights = {}) {
  SceneMaker s;
  const auto black = s.diffuse(0.0);
  const auto wall = [&](const Vec3d& a, const Vec3d& u, const Vec3d& v) { s.quad(black, a, u, v); };
  wall({0, 0, 0}, {0, 0, 4}, {5, 0, 0});  // floor
  wall({5, 0, 0}, {0, 0, 4}, {0, 3, 0});  // east
  wall({0, 0, 0}, {5, 0, 0}, {0, 3, 0});  // back
  wall({0, 0, 4}, {0, 3, 0}, {5, 0, 0});  // front
  wall({0, 0, 0}, {0, 1, 0}, {0, 0, 4});  // west: below, above, beside the window
  wall({0, 2.2, 0}, {0, 0.8, 0}, {0, 0, 4});
  wall({0, 1, 0}, {0, 1.2, 0}, {0, 0, 1});
  wall({0, 1, 3}, {0, 1.2, 0}, {0, 0, 1});
  if (o.skylight) {  // the roof is open where x is 3 to 4 and z is 1 to 2
    wall({0, 3, 0}, {3, 0, 0}, {0, 0, 4});
    wall({4, 3, 0}, {1, 0, 0}, {0, 0, 4});
    wall({3, 3, 0}, {1, 0, 0}, {0, 0, 1});
    wall({3, 3, 2}, {1, 0, 0}, {0, 0, 2});
  } else {
    wall({0, 3, 0}, {5, 0, 0}, {0, 0, 4});
  }
  if (o.table) {
    s.box(black, {0.8, 0.7, 1}, {1.6, 0.74, 3}, false);
    s.box(black, {0.8, 0, 1}, {1.6, 0.7, 1.04}, false);
    s.box(black, {0.8, 0, 2.96}, {1.6, 0.7, 3}, false);
  }
  if (o.pane) {
    material::Material glass;
    glass.medium = material::Material::Medium::Pane;
    glass.k_df = 0.0;
    glass.k_rg = glass.k_tp_rg = 1.0;
    s.quad(s.material(glass), {0, 1, 1}, {0, 1.2, 0}, {0, 0, 2});
  }
  s.model().environment = environment;
  s.model().lights = std::move(lights);
  s.model().portals = hints;
  return s.build();
}

PortalHints window_hint() {
  PortalHints hints;
  hints.polygons = {{{0, 1, 1}, {0, 2.2, 1}, {0, 2.2, 3}, {0, 1, 3}}};
  return hints;
}

/// Sky component of the irradiance of a floor point in world coordinates: the integral of
/// L cos cos / d^2 over the window by the midpoint rule.
double through_window(const LightSampler<1>& lights, const Vec3d& p, bool skylight) {
  double sum = 0.0;
  constexpr int n = 300;
  const auto add = [&](const Vec3d& q, const Vec3d& normal, double area) {
    const Vec3d d = q - p;
    const double d2 = d.squaredNorm();
    const Vec3d w = d / std::sqrt(d2);
    sum += static_cast<double>(lights.environment(w.cast<float>())[0]) * w.y() *
           std::abs(w.dot(normal)) / d2 * area;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = (i + 0.5) / n, b = (j + 0.5) / n;
      add({0.0, 1.0 + 1.2 * a, 1.0 + 2.0 * b}, Vec3d::UnitX(), 2.4 / (n * n));
      if (skylight) add({3.0 + a, 3.0, 1.0 + b}, Vec3d::UnitY(), 1.0 / (n * n));
    }
  }
  return sum;
}

struct RoomLight {
  Estimate with, without;
  double expected;
};

RoomLight floor_light(const Scene& scene, const Vec3d& p, bool skylight, int samples) {
  const RayQuery query(scene, {"isa=avx2"});
  const auto basis = material::SpectralBasis::grey();
  const LightSampler<1> guided(scene, basis, find_portals(query)), plain(scene, basis);
  const Vec3f at = (p - scene.origin).cast<float>();
  Counters counters;
  const auto visible = [&](const LightSample<1>& s) {
    return !query.occluded({at, s.wi, 1e-4f}, counters, Counter::RaysShadow, kOpaque);
  };
  return {irradiance(guided, at, {0, 1, 0}, samples, visible),
          irradiance(plain, at, {0, 1, 0}, samples, visible), through_window(plain, p, skylight)};
}

// CIE 171:2006, 5.9 to 5.11 in kind: the sky's part of the light on a floor behind an unglazed
// window, against the integral over the window, with and without portals.
TEST(Portals, SkyThroughAWindowMatchesTheIntegralOverIt) {
  for (const int type : {5, 16, 12}) {
    const Scene scene = room(dome(cie_sky(type), 35.0), window_hint());
    for (const Vec3d& p : {Vec3d(0.5, 0, 2), Vec3d(2.5, 0, 2), Vec3d(4.5, 0, 0.5)}) {
      const RoomLight e = floor_light(scene, p, false, 100000);
      EXPECT_NEAR(e.with.mean, e.expected, 3.5 * e.with.error + 1e-4 * e.expected) << type;
      EXPECT_NEAR(e.without.mean, e.expected, 3.5 * e.without.error + 1e-4 * e.expected) << type;
      const double gain = e.without.variance / e.with.variance;
      std::cout << "[ portal   ] CIE " << type << ", floor at x = " << p.x() << " m: " << gain
                << " times less variance\n";
      EXPECT_GT(gain, 4.0);
    }
  }
}

// An opening that no portal was given for still counts in full.
TEST(Portals, UnnamedOpeningsLoseNothing) {
  PortalHints hints = window_hint();
  hints.find = false;
  const Scene scene = room(dome(cie_sky(16), 35.0), hints, {.skylight = true});
  for (const Vec3d& p : {Vec3d(1.0, 0, 2), Vec3d(3.5, 0, 1.5)}) {
    const RoomLight e = floor_light(scene, p, true, 200000);
    EXPECT_NEAR(e.with.mean, e.expected, 3.5 * e.with.error + 1e-4 * e.expected);
  }
}

// With portals, sun and all: the same density in sample() and pdf_environment(), and counts follow.
TEST(Portals, DirectionsFollowTheirDensity) {
  const Scene scene = room(dome(cie_sky(12), 35.0), window_hint());
  const RayQuery query(scene, {"isa=avx2"});
  const LightSampler<1> lights(scene, material::SpectralBasis::grey(), find_portals(query));
  for (const Vec3d& p : {Vec3d(0.3, 0.5, 2), Vec3d(2.5, 1, 2), Vec3d(-3, 1, 2)}) {
    const Vec3f at = (p - scene.origin).cast<float>();
    EXPECT_LT(chi_square(lights, at, Vec3f::Zero(), 100000), 4.0) << p.transpose();
    EXPECT_LT(chi_square(lights, at, Vec3f(0, 1, 0), 100000), 4.0) << p.transpose();
  }
}

TEST(Portals, SunInARoomKeepsItsIrradiance) {
  Light sun;  // from the west at 30 degrees: reaches the floor from x = 1.7 to 3.8 in the middle
  sun.kind = DirectionalLight{1000.0, static_cast<float>(kSunAngularRadius)};
  const Vec3d towards = sun_at(30.0, 270.0);
  sun.to_scene = look_at(Vec3d::Zero(), -towards, Vec3d::UnitY());
  const Scene scene = room(dome(cie_sky(5), 35.0), window_hint(), {}, {sun});
  const Scene sky_only = room(dome(cie_sky(5), 35.0), window_hint());
  for (const double x : {0.7, 2.5, 4.5}) {
    const RoomLight e = floor_light(scene, {x, 0, 2}, false, 100000);
    const double sky = floor_light(sky_only, {x, 0, 2}, false, 10).expected;
    const double expected = sky + (x == 2.5 ? 500.0 : 0.0);
    EXPECT_NEAR(e.with.mean, expected, 3.5 * e.with.error + 1e-3 * expected) << x;
    EXPECT_NEAR(e.without.mean, expected, 3.5 * e.without.error + 1e-3 * expected) << x;
  }
}

// A pane between room and open air is found and turned inwards; one between two rooms is not, nor
// is anything in a scene without a sky.
TEST(Portals, PanesAreFoundAutomatically) {
  const Scene scene = room(dome(cie_sky(16), 35.0), {}, {.pane = true});
  const std::vector<Portal> portals = find_portals(RayQuery(scene, {"isa=avx2"}));
  ASSERT_EQ(portals.size(), 2u);
  for (const Portal& p : portals) {
    const Vec3f n = (p.corners[1] - p.corners[0]).cross(p.corners[2] - p.corners[0]).normalized();
    EXPECT_GT(n.x(), 0.999f);
    EXPECT_TRUE(p.room.contains((Vec3d(4.5, 0.1, 0.2) - scene.origin).cast<float>()));
    EXPECT_FALSE(p.room.contains((Vec3d(7.0, 0.1, 0.2) - scene.origin).cast<float>()));
    EXPECT_FALSE(p.room.contains((Vec3d(-1.0, 0.1, 0.2) - scene.origin).cast<float>()));
  }
  PortalHints off;
  off.find = false;
  EXPECT_TRUE(find_portals(RayQuery(room(dome(cie_sky(16), 35.0), off, {.pane = true}))).empty());
  EXPECT_TRUE(find_portals(RayQuery(room({}, {}, {.pane = true}))).empty()) << "no sky";

  SceneMaker s;  // glass partition in a closed box
  material::Material glass;
  glass.medium = material::Material::Medium::Pane;
  s.box(s.diffuse(0.5), {0, 0, 0}, {4, 3, 4}, true);
  s.quad(s.material(glass), {2, 0, 0}, {0, 3, 0}, {0, 0, 4});
  s.model().environment = uniform();
  EXPECT_TRUE(find_portals(RayQuery(s.build(), {"isa=avx2"})).empty());
}

/// Corners of the portals found, in world coordinates.
Eigen::AlignedBox3d extent(const Scene& scene, const std::vector<Portal>& portals) {
  Eigen::AlignedBox3d box;
  for (const Portal& p : portals)
    for (const Vec3f& c : p.corners) box.extend(c.cast<double>() + scene.origin);
  return box;
}

// The window without a pane, in a wall of four pieces that share no edges: found to the
// millimetre, turned inwards, and the light through it is the integral's.
TEST(Portals, HolesInWallsAreFound) {
  const Scene scene = room(dome(cie_sky(12), 35.0), {});
  const RayQuery query(scene, {"isa=avx2"});
  const std::vector<Opening> openings = find_openings(query);
  ASSERT_EQ(openings.size(), 1u);
  EXPECT_NEAR(openings[0].area, 2.4, 1e-3);
  EXPECT_NEAR((openings[0].center - Vec3d(0, 1.6, 2)).norm(), 0.0, 1e-3);
  EXPECT_NE(openings[0].reason.find("hole in a wall"), std::string::npos);
  EXPECT_GT(openings[0].outside, 0.9);
  EXPECT_LT(openings[0].inside, 0.1);
  for (const Portal& p : openings[0].portals)
    EXPECT_GT((p.corners[1] - p.corners[0]).cross(p.corners[2] - p.corners[0]).x(), 0.0f);
  const RoomLight e = floor_light(scene, {2.5, 0, 2}, false, 50000);
  EXPECT_NEAR(e.with.mean, e.expected, 3.5 * e.with.error + 1e-4 * e.expected);
  EXPECT_GT(e.without.variance / e.with.variance, 20.0);
  EXPECT_EQ(find_openings(RayQuery(room(dome(cie_sky(12), 35.0), {}, {.skylight = true}))).size(),
            2u);
}

// Turned by 33 degrees about y, in a wall with two windows and a door that reaches the floor.
TEST(Portals, HolesOfATurnedRoomAreFound) {
  SceneMaker s;
  const auto grey = s.diffuse(0.5);
  const Eigen::AngleAxisd turn(33.0 * kRadians, Vec3d::UnitY());
  const auto wall = [&](const Vec3d& a, const Vec3d& u, const Vec3d& v) {
    s.quad(grey, turn * a, turn * u, turn * v);
  };
  wall({0, 0, 0}, {0, 0, 6}, {5, 0, 0});
  wall({0, 3, 0}, {5, 0, 0}, {0, 0, 6});
  wall({5, 0, 0}, {0, 0, 6}, {0, 3, 0});
  wall({0, 0, 0}, {5, 0, 0}, {0, 3, 0});
  wall({0, 0, 6}, {0, 3, 0}, {5, 0, 0});
  const auto part = [&](double z0, double z1, double y0, double y1) {
    wall({0, y0, z0}, {0, y1 - y0, 0}, {0, 0, z1 - z0});
  };
  for (const auto& [z0, z1] : {std::pair{0.0, 0.5}, {1.5, 2.0}, {3.5, 4.0}, {5.0, 6.0}})
    part(z0, z1, 0.0, 3.0);
  part(0.5, 1.5, 0.0, 1.0), part(0.5, 1.5, 2.2, 3.0);  // window
  part(2.0, 3.5, 0.0, 1.0), part(2.0, 3.5, 2.2, 3.0);  // window
  part(4.0, 5.0, 2.1, 3.0);                            // door
  s.model().environment = uniform();
  const std::vector<Opening> openings = find_openings(RayQuery(s.build(), {"isa=avx2"}));
  ASSERT_EQ(openings.size(), 3u);  // largest first
  EXPECT_NEAR(openings[0].area, 2.1, 2e-3);
  EXPECT_NEAR(openings[1].area, 1.8, 2e-3);
  EXPECT_NEAR(openings[2].area, 1.2, 2e-3);
  EXPECT_NEAR((openings[0].center - turn * Vec3d(0, 1.05, 4.5)).norm(), 0.0, 2e-3);
}

TEST(Portals, MissingWallsAreFound) {
  for (const int missing : {0, 1, 2}) {
    SceneMaker s;
    const auto grey = s.diffuse(0.5);
    s.quad(grey, {0, 0, 0}, {0, 0, 4}, {5, 0, 0});
    s.quad(grey, {0, 0, 0}, {5, 0, 0}, {0, 3, 0});
    s.quad(grey, {5, 0, 0}, {0, 0, 4}, {0, 3, 0});
    if (missing != 0) s.quad(grey, {0, 3, 0}, {5, 0, 0}, {0, 0, 4});
    if (missing != 1) s.quad(grey, {0, 0, 0}, {0, 3, 0}, {0, 0, 4});
    if (missing != 2) s.quad(grey, {0, 0, 4}, {0, 3, 0}, {5, 0, 0});
    s.model().environment = uniform();
    const Scene scene = s.build();
    const std::vector<Opening> openings = find_openings(RayQuery(scene, {"isa=avx2"}));
    ASSERT_EQ(openings.size(), 1u) << missing;
    EXPECT_NE(openings[0].reason.find("missing wall"), std::string::npos);
    const Vec3d normals[] = {{0, 20, 0}, {12, 0, 0}, {0, 0, 15}};
    EXPECT_NEAR(openings[0].area, normals[missing].sum(), 1e-3);
    const Vec3d size = extent(scene, find_portals(RayQuery(scene))).sizes();
    EXPECT_NEAR(size.dot(normals[missing].normalized()), 0.0, 1e-4);
  }
}

// What is no opening of a room: blocks under the open sky, a table, a gate, a fence with gaps.
TEST(Portals, OutdoorsHasNone) {
  SceneMaker s;
  const auto grey = s.diffuse(0.5);
  s.quad(grey, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
  s.box(grey, {-5, 0, -5}, {-1, 6, 5}, false);
  s.box(grey, {2, 0, -5}, {6, 6, 5}, false);  // a street
  for (int i = 0; i < 5; ++i)
    s.box(grey, {-8.0 + 3.0 * i, 0, 10}, {-6.5 + 3.0 * i, 2, 10.1}, false);
  s.box(grey, {-12, 0, 3}, {-11.5, 3, 3.5}, false);  // a gate
  s.box(grey, {-12, 0, -3.5}, {-11.5, 3, -3}, false);
  s.box(grey, {-12, 3, -3.5}, {-11.5, 3.3, 3.5}, false);
  s.model().environment = uniform();
  const Scene scene = s.build();
  for (const Opening& o : find_openings(RayQuery(scene, {"isa=avx2"})))
    ADD_FAILURE() << o.reason << " at " << o.center.transpose() << ", outside " << o.outside
                  << ", inside " << o.inside;
}

// Portals that lie: beside the window, across it, far too small, in the open. Only the noise may
// know.
TEST(Portals, WrongPortalsGiveTheSameLight) {
  const std::vector<std::vector<Vec3d>> wrong[] = {
      {{{0, 2.3, 1}, {0, 2.9, 1}, {0, 2.9, 3}, {0, 2.3, 3}}},
      {{{0.5, 0.5, 2.1}, {1.5, 2.5, 2.3}, {0.5, 2.5, 3.5}}},
      {{{0, 1.5, 1.9}, {0, 1.6, 1.9}, {0, 1.6, 2.1}, {0, 1.5, 2.1}}},
      {{{-3, 1, 1}, {-3, 2.2, 1}, {-3, 2.2, 3}, {-3, 1, 3}}}};
  for (const auto& polygons : wrong) {
    PortalHints hints;
    hints.polygons = polygons;
    hints.find = false;
    const Scene scene = room(dome(cie_sky(12), 35.0), hints);
    for (const Vec3d& p : {Vec3d(1.0, 0, 2), Vec3d(3.5, 0, 1.5)}) {
      const RoomLight e = floor_light(scene, p, false, 300000);
      EXPECT_NEAR(e.with.mean, e.expected, 3.5 * e.with.error);
      EXPECT_LT(e.with.error, 0.05 * e.expected);
    }
  }
}

}  // namespace
}  // namespace atrium::scene
