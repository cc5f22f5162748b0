#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/light_sampler.h"
#include "scene/sampler.h"
#include "support/scenes.h"

namespace atrium::scene {
namespace {

using material::SpectralBasis;
using testing::SceneMaker;

constexpr double kPi = std::numbers::pi;

Light light_at(const Vec3d& place, auto kind, const Vec3d& target) {
  Light light;
  light.kind = kind;
  light.to_scene = look_at(place, target, Vec3d::UnitZ());
  return light;
}

/// A floor (so that there are bounds) under one kind of light at (0, 2, 0) or from above.
enum class Kind { Point, Spot, Sun, Disc, Sky, Lamp };
Scene scene_of(Kind kind) {
  SceneMaker s;
  s.quad(s.diffuse(0.5), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  const Vec3d place(0, 2, 0), below(0, 0, 0);
  auto& lights = s.model().lights;
  if (kind == Kind::Point)
    lights.push_back(light_at(place, PointLight{.intensity = 5.0, .falloff = {}}, below));
  if (kind == Kind::Spot)
    lights.push_back(light_at(
        place, SpotLight{.intensity = 5.0, .inner_angle = 0.5f, .outer_angle = 0.7f, .falloff = {}},
        below));
  if (kind == Kind::Sun || kind == Kind::Disc)
    lights.push_back(light_at(
        place,
        DirectionalLight{.irradiance = 5.0, .angular_radius = kind == Kind::Disc ? 0.05f : 0.0f},
        below));
  if (kind == Kind::Sky) {
    s.model().environment.emplace();
    s.model().environment->radiance = 1.0;
  }
  if (kind == Kind::Lamp)
    s.quad(s.diffuse(0.0, 5.0), {-0.1, 2, -0.1}, {0.2, 0, 0}, {0, 0, 0.2});  // shines down
  return s.build();
}

// Of the rays that lights send out, a share of density times area passes a small disc that faces
// them; of lights with a size the density times the lamp's projected solid angle per distance^2
// (lamp: A cos / d^2 from its middle; sun's disc: pi (2 sin(r / 2))^2; sky: within a cone).
TEST(EmissionDensity, IsTheShareOfRaysThatArrive) {
  constexpr int kRays = 400000;
  constexpr double kCone = 0.5;  // [rad]
  for (const Kind kind : {Kind::Point, Kind::Spot, Kind::Sun, Kind::Disc, Kind::Sky, Kind::Lamp}) {
    SCOPED_TRACE(static_cast<int>(kind));
    const double radius = kind == Kind::Sky ? 0.5 : 0.08;  // [m]
    const Scene scene = scene_of(kind);
    const LightSampler<1> lights(scene, SpectralBasis::grey());
    const Vec3f p = Vec3f(0.3f, 0.5f, 0.1f) - scene.origin.cast<float>();
    const auto light = lights.sample(p, Vec3f::Zero(), 0.5f, {0.4f, 0.3f});
    ASSERT_TRUE(light);
    // The place of a lamp is its middle; the sky is looked at straight up.
    const Vec3f up = kind == Kind::Sky ? Vec3f(Vec3f::UnitY()) : light->wi;
    const double density = static_cast<double>(kind == Kind::Sky ? lights.emission_density(up)
                                                                 : lights.emission_density(*light));
    double solid_angle = 1.0;
    if (kind == Kind::Disc) solid_angle = kPi * std::pow(2.0 * std::sin(0.025), 2);
    if (kind == Kind::Sky) solid_angle = 2.0 * kPi * (1.0 - std::cos(kCone));
    if (kind == Kind::Lamp) {
      const Vec3d d = Vec3d(0, 2, 0) - Vec3d(0.3, 0.5, 0.1);
      solid_angle = 0.04 * d.y() / (d.norm() * d.squaredNorm());
    }
    int passed = 0;
    for (int i = 0; i < kRays; ++i) {
      Sampler one(7, 0, static_cast<std::uint32_t>(i));
      const float choice = one.next_1d();
      const Vec2f place = one.next_2d();
      const auto e = lights.sample_emission(choice, place, one.next_2d());
      ASSERT_TRUE(e);
      const float cosine = -e->direction.dot(up);
      if (kind == Kind::Sky && cosine < std::cos(static_cast<float>(kCone))) continue;
      const float t = (e->origin - p).dot(up) / cosine;
      if (cosine > 0.0f && t > 0.0f &&
          (e->origin + t * e->direction - p).norm() < static_cast<float>(radius))
        ++passed;
    }
    const double expected = density * solid_angle * kPi * radius * radius;
    // Five binomial standard deviations; finite disc, lamp and cone: 3 %.
    EXPECT_NEAR(passed / static_cast<double>(kRays), expected,
                5.0 * std::sqrt(expected / kRays) + 0.03 * expected);
    EXPECT_GT(passed, 100);
  }
}

}  // namespace
}  // namespace atrium::scene
