#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "material/fresnel.h"
#include "picture_support.h"
#include "scene/camera_film.h"
#include "scene/parallel.h"
#include "trace/light_classes.h"
#include "trace/strategy.h"

namespace atrium::trace {
namespace {

using material::Material;
using material::SpectralBasis;
using testing::SceneMaker;

constexpr double kPi = std::numbers::pi;

Material mirror() {
  Material m;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.n = 0.2;
  m.kappa = 20.0;  // k = n kappa = 4
  m.fresnel_error = 0.0;
  return m;
}
double mirror_reflectance(double cosine) { return material::fresnel_unpolarised(cosine, 0.2, 4.0); }

Material glass(Material::Medium medium, double c = std::numeric_limits<double>::infinity()) {
  Material m;
  m.medium = medium;
  m.n = 1.5;
  m.c = c;
  m.k_df = 0.0;
  m.k_rg = m.k_tp_rg = 1.0;
  m.fresnel_error = 0.0;
  return m;
}

scene::Light light_at(const Vec3d& place, auto kind) {
  scene::Light light;
  light.kind = kind;
  light.to_scene.translation() = place;
  return light;
}

/// Looks down on the square [-0.5, 0.5]^2 of the floor y = 0 from below everything else.
scene::Camera plan() {
  scene::Camera c;
  c.kind = scene::Camera::Kind::Orthographic;
  c.to_scene = scene::look_at({0, 0.2, 0}, {0, 0, 0}, -Vec3d::UnitZ());
  c.height = 1.0;
  return c;
}

/// Mean of a function over that square, midpoint rule.
double mean_over_plan(const std::function<double(double x, double z)>& f) {
  constexpr int kSteps = 200;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) sum += f((i + 0.5) / kSteps - 0.5, (j + 0.5) / kSteps - 0.5);
  return sum / (kSteps * kSteps);
}

RenderOptions options(PathKind paths, int size, int samples) {
  RenderOptions o = path_options(size, samples);
  o.paths = paths;
  o.classes = true;
  return o;
}

// A point light before a plane mirror is two lights: the second at its image, dimmed by the
// mirror's reflectance at the angle of each ray. No path from the eye alone finds it.
TEST(Bidirectional, PointLightInAPlaneMirrorIsItsImage) {
  SceneMaker s;
  s.quad(s.diffuse(0.5), {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  s.quad(s.material(mirror()), {1, 0.01, -3}, {0, 0, 6}, {0, 3, 0});  // faces -x
  s.model().lights.push_back(
      light_at({0.3, 1, 0}, scene::PointLight{.intensity = 10.0, .falloff = {}}));
  const scene::Scene scene = s.build();
  const auto irradiance = [](double x, double z, double light) {
    const double d2 = (x - light) * (x - light) + z * z + 1.0;
    return 10.0 / (d2 * std::sqrt(d2));
  };
  const double direct = mean_over_plan([&](double x, double z) { return irradiance(x, z, 0.3); });
  const double image = mean_over_plan([&](double x, double z) {
    const double cosine = (1.7 - x) / std::sqrt((1.7 - x) * (1.7 - x) + z * z + 1.0);
    return mirror_reflectance(cosine) * irradiance(x, z, 1.7);
  });
  const Picture p = picture(scene, plan(), options(PathKind::Needed, 16, 1024));
  const Layer caustic = layer(p.result.image, "LSDE"), lit = layer(p.result.image, "LDE");
  EXPECT_NEAR(caustic.mean, 0.5 / kPi * image, 4.0 * caustic.error);
  EXPECT_NEAR(lit.mean, 0.5 / kPi * direct, 4.0 * lit.error + 1e-4 * lit.mean);
  EXPECT_LT(caustic.error, 0.02 * caustic.mean);
  const Picture eye = picture(scene, plan(), options(PathKind::FromEye, 16, 16));
  EXPECT_EQ(layer(eye.result.image, "LSDE").mean, 0.0);
}

// A spot above a slab of glass, 0.4 m thick: a ray at t to the normal crosses with (1 - F)^2 F^2k
// after k pairs of reflections within, and lands at h tan t + (2k + 1) d tan t', sin t' = sin t /
// n. The spot is uniform within its cone, so E = I T(t) sin t / (r dr/dt) on the floor.
TEST(Bidirectional, SpotThroughASlabFollowsFresnelAndSnell) {
  const double n = 1.5, height = 2.0, thickness = 0.4, intensity = 10.0;
  SceneMaker s;
  s.quad(s.diffuse(0.5), {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  s.box(s.material(glass(Material::Medium::Solid)), {-3, 0.6, -3}, {3, 0.6 + thickness, 3}, false);
  scene::Light spot = light_at(
      {0, height, 0},
      scene::SpotLight{
          .intensity = intensity, .inner_angle = 0.7f, .outer_angle = 0.71f, .falloff = {}});
  spot.to_scene.linear() = scene::look_at({0, 2, 0}, {0, 0, 0}, Vec3d::UnitX()).linear();
  s.model().lights.push_back(spot);

  // Flux within the radius r, by summing over t: the square's mean is not a disc's, so tabulate
  // E(r).
  constexpr int kSteps = 4000;
  constexpr double kWidth = 0.72, kBins = 100;
  std::array<double, 100> flux{};
  for (int i = 0; i < kSteps; ++i) {
    const double t = 0.69 * (i + 0.5) / kSteps, inside = std::asin(std::sin(t) / n);
    const double f = material::fresnel_unpolarised(std::cos(t), n, 0.0);
    double share = (1 - f) * (1 - f);
    for (int k = 0; k < 4; ++k, share *= f * f) {
      const double r =
          (height - thickness) * std::tan(t) + (2 * k + 1) * thickness * std::tan(inside);
      const auto bin = static_cast<std::size_t>(r / kWidth * kBins);
      if (bin < flux.size()) flux[bin] += intensity * share * std::sin(t) * 0.69 / kSteps * 2 * kPi;
    }
  }
  const double expected =
      0.5 / kPi * mean_over_plan([&](double x, double z) {
        const double at = std::hypot(x, z) / kWidth * kBins;
        const auto bin = std::min<std::size_t>(static_cast<std::size_t>(at), flux.size() - 1);
        const double ring =
            kPi * (2.0 * static_cast<double>(bin) + 1.0) * std::pow(kWidth / kBins, 2);
        return flux[bin] / ring;
      });
  scene::Scene scene = s.build();
  ASSERT_EQ(scene.materials.at(1).medium, Material::Medium::Solid);
  const Picture p = picture(scene, plan(), options(PathKind::Needed, 16, 256));
  const Layer caustic = layer(p.result.image, "LSDE");
  EXPECT_NEAR(caustic.mean, expected, 4.0 * caustic.error + 1e-3 * expected);  // rings: 0.1 %
  EXPECT_LT(caustic.error, 0.01 * expected);
}

// The sun in a mirror that covers all of the floor seen: E = F(t) E0 cos, with a disc and without.
TEST(Bidirectional, SunInAMirrorIsASecondSun) {
  for (const float radius : {0.0f, 0.00465f}) {
    SceneMaker s;
    s.quad(s.diffuse(0.5), {-1, 0, -0.6}, {0, 0, 1.2}, {2, 0, 0});
    s.quad(s.material(mirror()), {1, 0.01, -0.6}, {0, 0, 1.2}, {0, 2.2, 0});
    scene::Light sun =
        light_at({0, 0, 0}, scene::DirectionalLight{.irradiance = 100.0, .angular_radius = radius});
    sun.to_scene.linear() = scene::look_at({0, 0, 0}, {0.6, -0.8, 0}, Vec3d::UnitZ()).linear();
    s.model().lights.push_back(sun);
    const Picture p = picture(s.build(), plan(), options(PathKind::Needed, 16, 512));
    const Layer caustic = layer(p.result.image, "LSDE"), lit = layer(p.result.image, "LDE");
    EXPECT_NEAR(lit.mean, 0.5 / kPi * 80.0, 4.0 * lit.error + 0.01) << radius;
    EXPECT_NEAR(caustic.mean, mirror_reflectance(0.6) * 0.5 / kPi * 80.0, 4.0 * caustic.error)
        << radius;
    EXPECT_LT(caustic.error, 0.01 * caustic.mean);
  }
}

// Furnace with paths from both ends, also where surfaces are rough mirrors or sheets.
TEST(Bidirectional, ClosedFurnaceIsAGeometricSeries) {
  SceneMaker s;
  s.box(s.diffuse(0.7, 1.0), {0, 0, 0}, {3, 2, 4}, true);
  Material sheet;
  sheet.k_df = 0.5;
  sheet.k_tp_df = 0.5;
  sheet.body_reflectance = sheet.body_transmittance = 0.7;
  sheet.emission = 1.0;
  sheet.emits_both_sides = true;
  s.quad(s.material(sheet), {1, 0.5, 3}, {1, 0, 0}, {0, 1, 0.3});
  RenderOptions o = path_options(16, 64);
  o.paths = PathKind::BothEnds;
  const Picture p = picture(s.build(), camera_at({1.2, 1, 1}, {2, 0.7, 3}, 1.2), o);
  EXPECT_NEAR(p.mean, 1.0 / (1.0 - 0.7), 4.0 * p.error);
  EXPECT_LT(p.error, 0.02);
}

// A closed room with a lamp and everything that scatters: what paths from the eye can find paths
// from both ends find too, class by class, with every camera, in a crop and in air that absorbs.
scene::Scene mixed_room(bool lamps_without_size) {
  SceneMaker s;
  s.box(s.diffuse(0.6), {0, 0, 0}, {3, 2.4, 4}, true);
  if (lamps_without_size)
    s.model().lights.push_back(
        light_at({1.5, 2.2, 2.6}, scene::PointLight{.intensity = 5.0, .falloff = {}}));
  else
    s.quad(s.diffuse(0.3, 20.0), {1.0, 2.39, 2.4}, {1, 0, 0}, {0, 0, 1});
  s.quad(s.material(mirror()), {0.01, 0.5, 1.5}, {0, 1.2, 0}, {0, 0, 1.5});
  s.quad(s.material(glass(Material::Medium::Pane)), {1.6, 0.01, 2.0}, {0, 1.4, 0}, {1.0, 0, 0.3});
  Material tinted = glass(Material::Medium::Solid);
  tinted.extinction = 1.0;
  s.sphere(s.material(tinted), {0.8, 0.41, 1.9}, 0.4, 12, false);
  s.box(s.material(glass(Material::Medium::Solid, 100.0)), {2.0, 0.01, 2.6}, {2.5, 0.5, 3.0},
        false);
  Material plastic;
  plastic.combination = Material::Combination::Coupled;
  plastic.body_reflectance = 0.6;
  plastic.k_rg = 1.0;
  plastic.c = 8.0;
  s.box(s.material(plastic), {1.2, 0.01, 3.0}, {1.8, 0.7, 3.5}, false);
  Material sheet;
  sheet.k_df = 0.5;
  sheet.k_tp_df = 0.5;
  sheet.body_reflectance = sheet.body_transmittance = 0.8;
  s.quad(s.material(sheet), {0.3, 0.8, 3.0}, {0.6, 0, 0.2}, {0, 0.8, 0});
  return s.build();
}

void expect_same_classes(const scene::Image& a, const scene::Image& b, double largest_error) {
  double whole = 0.0;
  for (const std::string_view c : kLightClassNames) whole += layer(b, c).mean;
  for (const std::string_view c : kLightClassNames) {
    const Layer one = layer(a, c), two = layer(b, c);
    const double error = std::hypot(one.error, two.error);
    EXPECT_NEAR(one.mean, two.mean, 4.0 * error + 1e-6 * whole) << c;
    EXPECT_LT(error, largest_error * whole) << c;
  }
}

TEST(Bidirectional, AgreesWithPathsFromTheEyeClassByClass) {
  scene::Scene scene = mixed_room(false);
  const scene::Camera room = camera_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, 1.1);
  scene::Camera panorama = room, parallel = room;
  panorama.kind = scene::Camera::Kind::Panorama;
  parallel.kind = scene::Camera::Kind::Orthographic;
  parallel.height = 1.5;
  for (const scene::Camera& camera : {room, panorama, parallel}) {
    SCOPED_TRACE(static_cast<int>(camera.kind));
    RenderOptions both = options(PathKind::BothEnds, 20, 32),
                  eye = options(PathKind::FromEye, 20, 128);
    if (camera.kind == scene::Camera::Kind::Panorama) {
      scene.medium_extinction = 0.2;
      both.crop = eye.crop = {0.25, 0.25, 0.75, 0.75};
      both.width = eye.width = 40;
    }
    const SpectralBasis grey = SpectralBasis::grey();
    expect_same_classes(picture(scene, camera, both, grey).result.image,
                        picture(scene, camera, eye, grey).result.image, 0.015);
  }
}

// A mirror whose shading normals lean: light on its way from the lamp to the ceiling carries what
// the camera would see on the way back, by the factor of Veach 1997, Eq. 5.19. Without it a fifth
// of the light is missing.
TEST(Bidirectional, AgreesWhereShadingNormalsLean) {
  SceneMaker s;
  s.quad(s.material(mirror()), {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  s.model().meshes.back().normals.assign(4, Vec3f(0.5f, 1.0f, 0.0f).normalized());
  s.quad(s.diffuse(0.5), {-1.5, 1.5, -1.5}, {3, 0, 0}, {0, 0, 3});           // ceiling
  s.quad(s.diffuse(0.0, 20.0), {0.6, 1.0, -0.3}, {0.6, 0, 0}, {0, 0, 0.6});  // lamp
  scene::Camera up = plan();
  up.to_scene = scene::look_at({0.1, 1.05, 0}, {0.1, 1.5, 0}, Vec3d::UnitZ());
  const scene::Scene scene = s.build();
  const auto caustic = [&](PathKind paths, int samples) {
    return layer(
        picture(scene, up, options(paths, 16, samples), SpectralBasis::grey()).result.image,
        "LSDE");
  };
  const Layer both = caustic(PathKind::BothEnds, 512), eye = caustic(PathKind::FromEye, 2048);
  const double error = std::hypot(both.error, eye.error);
  EXPECT_NEAR(both.mean, eye.mean, 4.0 * error);
  EXPECT_LT(error, 0.02 * eye.mean);
}

// The layers of classes and of terms each sum to the picture, whatever adds to it.
TEST(Bidirectional, ClassesAndTermsSumToThePicture) {
  RenderOptions o = options(PathKind::BothEnds, 16, 8);
  o.components = true;
  const scene::Scene scene = mixed_room(true);
  const Picture p = picture(scene, camera_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, 1.1), o);
  const scene::Image& image = p.result.image;
  for (int y = 0; y < o.height; ++y)
    for (int x = 0; x < o.width; ++x) {
      double classes = 0.0, terms = 0.0;
      for (const std::string_view c : kLightClassNames)
        classes += static_cast<double>(image.at(x, y, image.channel_index(std::string(c) + ".G")));
      for (const char* t : {"C1", "C2", "C3", "C4", "C5", "C6", "emission"})
        terms += static_cast<double>(image.at(x, y, image.channel_index(std::string(t) + ".G")));
      const double all = static_cast<double>(image.at(x, y, image.channel_index("G")));
      EXPECT_NEAR(classes, all, 1e-5 * std::max(1.0, all));
      EXPECT_NEAR(terms, all, 1e-5 * std::max(1.0, all));
    }
  EXPECT_GT(p.mean, 0.0);
}

// The same bits with one thread and with several: splats are added in the order of the tiles.
TEST(Bidirectional, ThreadsDoNotChangeABit) {
  const scene::Scene scene = mixed_room(true);
  std::vector<float> pixels[2];
  for (const int threads : {1, 4}) {
    const scene::ThreadLimit limit(threads);
    pixels[threads == 1 ? 0 : 1] = picture(scene, camera_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, 1.1),
                                           options(PathKind::BothEnds, 40, 6))
                                       .result.image.pixels;
  }
  EXPECT_EQ(pixels[0], pixels[1]);
}

// film_place() undoes ray(), and its density is that of the rays: film per solid angle by a small
// step on the film.
TEST(CameraFilm, UndoesTheRaysOfEveryCamera) {
  scene::Camera c = camera_at({1, 2, 3}, {-2, 1, 0.5}, 0.9);
  c.height = 1.7;
  for (const auto kind : {scene::Camera::Kind::Perspective, scene::Camera::Kind::Orthographic,
                          scene::Camera::Kind::Panorama}) {
    c.kind = kind;
    for (const Vec2d& film : {Vec2d(0.5, 0.5), Vec2d(0.1, 0.7), Vec2d(0.93, 0.22)}) {
      const double h = 1e-3, distance = 2.5;
      const auto point = [&](double x, double y) {
        const auto r = c.ray({x, y}, 1.5);
        return Vec3d((r.origin + 2.5f * r.direction).cast<double>());
      };
      const Vec3f p = point(film.x(), film.y()).cast<float>();
      const auto place = scene::film_place(c, p, 1.5);
      ASSERT_TRUE(place);
      EXPECT_NEAR((place->film - film).norm(), 0.0, 1e-6);
      EXPECT_NEAR(static_cast<double>(place->distance), distance, 1e-5);
      const auto ray = c.ray(film, 1.5);
      EXPECT_LT((place->direction + ray.direction).norm(), 1e-5f);
      EXPECT_LT((place->eye - ray.origin).norm(), 1e-5f);
      // Rays a step apart span an area at that distance; what of it faces the ray counts.
      const Vec3d du = point(film.x() + h, film.y()) - point(film.x() - h, film.y());
      const Vec3d dv = point(film.x(), film.y() + h) - point(film.x(), film.y() - h);
      const double area = std::abs(du.cross(dv).dot(ray.direction.cast<double>()));
      EXPECT_NEAR(place->density * area / (4.0 * h * h), 1.0, 2e-3);
    }
  }
}

// Paths from lights are traced where they are needed, and nowhere else.
TEST(PathStrategy, FollowsWhatTheSceneHas) {
  SceneMaker diffuse;
  diffuse.box(diffuse.diffuse(0.5), {0, 0, 0}, {3, 2, 4}, true);
  diffuse.model().lights.push_back(light_at({1, 1, 1}, scene::PointLight{}));
  EXPECT_FALSE(choose_strategy(diffuse.build()).from_lights);
  const PathStrategy lamp = choose_strategy(mixed_room(false));
  EXPECT_FALSE(lamp.from_lights);
  EXPECT_TRUE(lamp.missing.empty());
  const PathStrategy point = choose_strategy(mixed_room(true));
  EXPECT_TRUE(point.from_lights);
  EXPECT_FALSE(point.missing.empty());
}

}  // namespace
}  // namespace atrium::trace
