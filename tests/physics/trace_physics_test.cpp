#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "picture_support.h"

namespace atrium::trace {
namespace {

using material::Material;
using material::SpectralBasis;
using testing::SceneMaker;

// Furnace: every surface emits M and reflects rho; the radiance is M / (1 - rho) everywhere.
TEST(PathTracer, ClosedFurnaceIsAGeometricSeries) {
  for (const double rho : {0.0, 0.5, 0.8}) {
    SceneMaker s;
    s.box(s.diffuse(rho, 1.0), {0, 0, 0}, {3, 2, 4}, true);
    const Picture p =
        picture(s.build(), camera_at({1.2, 1, 1}, {2, 0.7, 3}, 1.2), path_options(16, 256));
    EXPECT_NEAR(p.mean, 1.0 / (1.0 - rho), 4.0 * p.error + 1e-5) << rho;
    EXPECT_LT(p.error, 0.02 / (1.0 - rho));
  }
}

// In a uniform surround of radiance 1 a lossless body cannot be seen: R + T = 1, and the factor
// (n1/n2)^2 of entering cancels on leaving. Every specular kind, smooth and rough, alone and
// nested.
TEST(PathTracer, LosslessBodiesVanishInAUniformSurround) {
  struct Body {
    const char* name;
    Material::Medium medium;
    double c;
    double tolerance;  // what V-cavities lose between facets, both interfaces (measured albedo)
  };
  const double smooth = std::numeric_limits<double>::infinity();
  for (const Body& body : {Body{"glass", Material::Medium::Solid, smooth, 0.0},
                           Body{"pane", Material::Medium::Pane, smooth, 0.0},
                           Body{"frosted", Material::Medium::Solid, 100.0, 0.01}}) {
    SceneMaker s;
    Material m;
    m.medium = body.medium;
    m.n = 1.5;
    m.c = body.c;
    m.k_df = 0.0;
    m.k_rg = m.k_tp_rg = 1.0;
    s.sphere(s.material(m), {0, 0, 0}, 1.0, 24, false);
    s.model().environment.emplace();
    s.model().environment->radiance = 1.0;
    const Picture p =
        picture(s.build(), camera_at({0, 0, 4}, {0, 0, 0}, 0.4), path_options(16, 128));
    EXPECT_NEAR(p.mean, 1.0, 4.0 * p.error + body.tolerance + 1e-5) << body.name;
  }
}

// A small floor under a small square light: E = L F(point to polygon), radiance = rho E / pi, with
// the closed form of the point-to-parallel-rectangle factor.
TEST(PathTracer, DirectLightOfASquareMatchesTheFormFactor) {
  SceneMaker s;
  s.quad(s.diffuse(0.6), {-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0});  // faces up
  s.quad(s.diffuse(0.0, 10.0), {-0.5, 1.0, -0.5}, {1, 0, 0}, {0, 0, 1});  // faces down
  scene::Camera c = camera_at({0, 0.5, 0.3}, {0, 0, 0}, 0.01);
  const Picture p = picture(s.build(), c, path_options(4, 4096));
  // Point under the centre: four quarter rectangles, each with X = Y = 0.5 (Howell, C-11).
  const double x = 0.5, r = std::sqrt(1.0 + x * x);
  const double f = 4.0 / (2.0 * std::numbers::pi) * 2.0 * x / r * std::atan(x / r);
  // The receiver is 1 cm wide: F varies by less than 1e-4 over it.
  EXPECT_NEAR(p.mean, 0.6 * 10.0 * f, 4.0 * p.error + 1e-3);
  EXPECT_LT(p.error, 0.005);
}

// A room with one glazed window under a clear sky: its floor has the same light by path tracing
// with portals and without, and with them a good deal less noise.
TEST(PathTracer, PortalsChangeTheNoiseOfARoomAndNotItsLight) {
  Picture picture_with[2];
  for (const bool portals : {false, true}) {
    SceneMaker s;
    const auto wall = s.diffuse(0.5);
    s.quad(wall, {0, 0, 0}, {0, 0, 4}, {5, 0, 0});
    s.quad(wall, {0, 3, 0}, {5, 0, 0}, {0, 0, 4});
    s.quad(wall, {5, 0, 0}, {0, 0, 4}, {0, 3, 0});
    s.quad(wall, {0, 0, 0}, {5, 0, 0}, {0, 3, 0});
    s.quad(wall, {0, 0, 4}, {0, 3, 0}, {5, 0, 0});
    s.quad(wall, {0, 0, 0}, {0, 1, 0}, {0, 0, 4});
    s.quad(wall, {0, 2.2, 0}, {0, 0.8, 0}, {0, 0, 4});
    s.quad(wall, {0, 1, 0}, {0, 1.2, 0}, {0, 0, 1});
    s.quad(wall, {0, 1, 3}, {0, 1.2, 0}, {0, 0, 1});
    Material glass;
    glass.medium = Material::Medium::Pane;
    glass.n = 1.52;
    glass.k_df = 0.0;
    glass.k_rg = glass.k_tp_rg = 1.0;
    s.quad(s.material(glass), {0, 1, 1}, {0, 1.2, 0}, {0, 0, 2});
    scene::Environment& sky = s.model().environment.emplace();
    sky.radiance = 100.0;
    sky.pattern = scene::SkyDome(scene::cie_sky(12), Vec3d(0.3, 0.8, 0.4).normalized(), 0.2);
    s.model().portals.find = portals;
    picture_with[portals ? 1 : 0] =
        picture(s.build(), camera_at({2.5, 2.9, 2.0}, {2.5, 0, 2.01}, 0.8), path_options(16, 256));
  }
  const auto& [without, with] = picture_with;
  EXPECT_NEAR(with.mean, without.mean, 4.0 * std::hypot(with.error, without.error));
  EXPECT_GT(with.mean, 0.1);
  EXPECT_LT(with.error, 0.5 * without.error);
}

// Point light: E = I cos / r^2 (CIE 171, 5.2), through a pane times T of the pane.
TEST(PathTracer, PointLightFollowsInverseSquareAndPanesTransmit) {
  for (const bool with_pane : {false, true}) {
    SceneMaker s;
    s.quad(s.diffuse(0.5), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    if (with_pane) {
      Material glass;
      glass.medium = Material::Medium::Pane;
      glass.n = 1.52;
      glass.k_df = 0.0;
      glass.k_rg = glass.k_tp_rg = 1.0;
      s.quad(s.material(glass), {-2, 1.5, -2}, {4, 0, 0}, {0, 0, 4});
    }
    scene::Light light;
    light.kind = scene::PointLight{.intensity = 1000.0, .falloff = {}};
    light.to_scene.translation() = Vec3d(0, 3, 0);
    s.model().lights.push_back(light);
    RenderOptions o = path_options(4, 64);
    o.method = Method::Direct;
    const Picture p = picture(s.build(), camera_at({0.0, 1.0, 0.05}, {0, 0, 0}, 0.002), o);
    const double expected = 0.5 / std::numbers::pi * 1000.0 / 9.0 * (with_pane ? 0.9183 : 1.0);
    EXPECT_NEAR(p.mean, expected, 2e-4 * expected) << with_pane;
  }
}

// Air that absorbs: a wall of radiance 1 at 2.5 m shows exp(-2.5 K); a floor 1 m below the eye and
// 2 m below a point light 1000 / 4 rho / pi exp(-(1 + 2) K); the sky above it exp(-K) of the 1 m
// that is left of the bounds.
TEST(PathTracer, AirAbsorbsAlongEveryKindOfRay) {
  const double k = 0.4;
  {
    SceneMaker s;
    s.box(s.diffuse(0.0, 1.0), {0, 0, 0}, {3, 2, 4}, true);
    scene::Scene scene = s.build();
    scene.medium_extinction = k;
    const Picture p =
        picture(scene, camera_at({1.5, 1, 1.5}, {1.5, 1.001, 4}, 0.002), path_options(4, 16));
    EXPECT_NEAR(p.mean, std::exp(-2.5 * k), 1e-4);
  }
  SceneMaker s;
  s.quad(s.diffuse(0.5), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  s.quad(s.diffuse(0.0), {-2, 0, -2}, {4, 0, 0}, {0, 2.5, 0});  // a wall: bounds 2.5 m high
  scene::Light light;
  light.kind = scene::PointLight{.intensity = 1000.0, .falloff = {}};
  light.to_scene.translation() = Vec3d(0, 2, 0);
  s.model().lights.push_back(light);
  s.model().environment.emplace();
  scene::Scene scene = s.build();
  scene.medium_extinction = k;
  scene.environment->radiance = 1e-9;
  RenderOptions o = path_options(4, 64);
  o.method = Method::Direct;
  const Picture floor = picture(scene, camera_at({0.0, 1.0, 0.05}, {0, 0, 0}, 0.002), o);
  const double expected = 0.5 / std::numbers::pi * 250.0 * std::exp(-(std::hypot(1, 0.05) + 2) * k);
  EXPECT_NEAR(floor.mean, expected, 3e-4 * expected);
  scene.environment->radiance = 1.0;
  const Picture sky = picture(scene, camera_at({0.0, 1.5, 0.0}, {0, 3, 1e-4}, 0.002), o);
  EXPECT_NEAR(sky.mean, std::exp(-k), 1e-4);
}

// The same seed gives the same bits, whatever the terms are split into; the terms sum to the image.
TEST(Render, TermsSumToTheImage) {
  SceneMaker s;
  s.box(s.diffuse(0.5), {0, 0, 0}, {3, 2, 4}, true);
  Material metal;
  metal.k_df = 0.0;
  metal.k_rg = 1.0;
  metal.n = 0.2;
  metal.kappa = 15.0;
  metal.c = 6.0;
  s.sphere(s.material(metal), {1.5, 0.6, 2.5}, 0.5, 12, false);
  s.quad(s.diffuse(0.0, 20.0), {1, 1.99, 1.5}, {1, 0, 0}, {0, 0, 1});
  RenderOptions o = path_options(24, 8);
  o.components = true;
  const scene::Scene scene = s.build();
  const Picture p = picture(scene, camera_at({1.5, 1, 0.2}, {1.5, 0.8, 3}, 1.2), o);
  const scene::Image& image = p.result.image;
  double lit = 0.0;
  for (int y = 0; y < o.height; ++y)
    for (int x = 0; x < o.width; ++x)
      for (const char* c : {"R", "G", "B"}) {
        double sum = 0.0;
        for (const char* t : {"C1", "C2", "C3", "C4", "C5", "C6", "emission"})
          sum += static_cast<double>(image.at(x, y, image.channel_index(std::string(t) + "." + c)));
        const double total = static_cast<double>(image.at(x, y, image.channel_index(c)));
        EXPECT_NEAR(sum, total, 1e-5 * std::max(1.0, total));
        lit += total;
      }
  EXPECT_GT(lit, 0.0);
  o.components = false;
  const Picture again = picture(scene, camera_at({1.5, 1, 0.2}, {1.5, 0.8, 3}, 1.2), o);
  EXPECT_EQ(again.mean, p.mean);
}

}  // namespace
}  // namespace atrium::trace
