#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "physics/picture_support.h"
#include "radiosity/solve.h"
#include "support/materials.h"
#include "trace/light_classes.h"
#include "trace/strategy.h"

namespace atrium::trace {
namespace {

using material::Material;
using material::SpectralBasis;
using testing::glass;
using testing::mirror;
using testing::plastic;
using testing::SceneMaker;

// Lit by a spot on a mirror and by a lamp: caustics that paths from the eye do not find.
scene::Scene spot_room() {
  SceneMaker s;
  s.box(s.diffuse(0.6), {0, 0, 0}, {3, 2.4, 4}, true);
  s.quad(s.diffuse(0.0, 4.0), {1.0, 2.39, 2.4}, {1, 0, 0}, {0, 0, 1});
  s.quad(s.material(mirror()), {0.01, 0.5, 1.5}, {0, 1.2, 0}, {0, 0, 1.5});
  s.box(s.material(plastic()), {1.6, 0.01, 2.6}, {2.2, 0.7, 3.1}, false);
  scene::Light spot;
  spot.kind =
      scene::SpotLight{.intensity = 30.0, .inner_angle = 0.3f, .outer_angle = 0.5f, .falloff = {}};
  spot.to_scene = scene::look_at({2.2, 1.9, 2.0}, {0.01, 1.1, 2.2}, Vec3d::UnitY());
  s.model().lights.push_back(spot);
  return s.build();
}

// The sun through a pane and from a mirror on the floor; sky.
scene::Scene sun_room() {
  SceneMaker s;
  const auto wall = s.diffuse(0.6);
  s.quad(wall, {0, 0, 0}, {0, 0, 4}, {3, 0, 0});
  s.quad(wall, {0, 2.4, 0}, {3, 0, 0}, {0, 0, 4});
  s.quad(wall, {3, 0, 0}, {0, 0, 4}, {0, 2.4, 0});
  s.quad(wall, {0, 0, 0}, {3, 0, 0}, {0, 2.4, 0});
  s.quad(wall, {0, 0, 4}, {0, 2.4, 0}, {3, 0, 0});
  s.quad(wall, {0, 0, 0}, {0, 0.8, 0}, {0, 0, 4});
  s.quad(s.material(glass(Material::Medium::Pane)), {0, 0.8, 0}, {0, 1.6, 0}, {0, 0, 4});
  s.quad(s.material(mirror()), {0.6, 0.01, 0.6}, {0, 0, 2.8}, {2.0, 0, 0});
  scene::Light sun;
  sun.kind = scene::DirectionalLight{.irradiance = 100.0, .angular_radius = 0.00465f};
  sun.to_scene.linear() = scene::look_at({0, 0, 0}, {0.8, -0.6, 0.1}, Vec3d::UnitY()).linear();
  s.model().lights.push_back(sun);
  s.model().environment.emplace();
  s.model().environment->radiance = 3.0;
  return s.build();
}

// Hybrid and reference, class by class: four standard errors of both pictures and, of classes that
// the hybrid reads from elements of some 8 cm, 1 % of the light for what they smear.
void expect_agreement(const scene::Scene& scene) {
  const scene::RayQuery query(scene, {"isa=avx2"});
  const SpectralBasis basis = SpectralBasis::grey();
  const scene::Camera camera = in_scene(camera_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, 1.1), scene);
  radiosity::SolveOptions solve;
  solve.max_elements = 4000;
  const radiosity::SolveResult solved = radiosity::solve(query, basis, solve);
  RenderOptions path = path_options(24, 128), hybrid = path_options(24, 64);
  hybrid.method = Method::Hybrid;
  path.classes = hybrid.classes = true;
  const scene::Image reference = render(query, basis, camera, {}, path).image;
  const scene::Image image = render(query, basis, camera, solved.field, hybrid).image;
  EXPECT_FALSE(choose_strategy(scene).missing.empty());
  double whole = 0.0;
  for (const std::string_view c : kLightClassNames) whole += layer(reference, c).mean;
  for (std::size_t c = 0; c < kLightClasses; ++c) {
    const std::string name(kLightClassNames[c]);
    const Layer a = layer(image, name), b = layer(reference, name);
    const double error = std::hypot(a.error, b.error);
    const bool traced = c <= static_cast<std::size_t>(LightClass::LDSE);
    const double tolerance = 4.0 * error + (traced ? 1e-5 : 0.01) * whole;
    // Of these the reference says that it lacks a part.
    const bool lacking = name == "LSDSE" || name == "LSDDSE" || name == "LDDDSE";
    EXPECT_GT(a.mean, b.mean - tolerance) << name;
    if (!lacking) {
      EXPECT_LT(a.mean, b.mean + tolerance) << name;
    }
    EXPECT_LT(error, 0.01 * whole) << name;
  }
  EXPECT_GT(layer(reference, "LSDE").mean, 0.01 * whole);
  EXPECT_GT(layer(reference, "LSDDE").mean, 0.005 * whole);
}

TEST(LightClasses, HybridAndReferenceAgreeUnderASpotOnAMirror) { expect_agreement(spot_room()); }
TEST(LightClasses, HybridAndReferenceAgreeInTheSun) { expect_agreement(sun_room()); }

}  // namespace
}  // namespace atrium::trace
