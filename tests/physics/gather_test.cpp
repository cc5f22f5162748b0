#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "scene/bright_surfaces.h"
#include "scene/sampler.h"
#include "support/scenes.h"
#include "trace/compare.h"
#include "trace/render.h"

namespace atrium::trace {
namespace {

using material::SpectralBasis;
using testing::SceneMaker;

// A lamp on a ledge shines at a strip of the ceiling, which lights the room: hemisphere rays find
// the strip rarely.
scene::Scene cove() {
  SceneMaker s;
  const auto white = s.diffuse(0.7);
  s.box(white, {0, 0, 0}, {3, 2.4, 3}, true);
  s.box(white, {0, 2.1, 2.7}, {3, 2.13, 3}, false);
  s.box(white, {0, 2.13, 2.7}, {3, 2.22, 2.73}, false);
  s.quad(s.diffuse(0.0, 100.0), {0.2, 2.14, 2.8}, {0, 0, 0.1}, {2.6, 0, 0});
  return s.build();
}

scene::Camera camera(const scene::Scene& scene) {
  scene::Camera c;
  c.to_scene = scene::look_at({1.5, 1.4, 2.6}, {1.5, 0.9, 0.5}, Vec3d::UnitY());
  c.to_scene.translation() -= scene.origin;
  c.yfov = 1.2;
  return c;
}

struct Solved {
  explicit Solved(scene::Scene s) : scene(std::move(s)) {
    radiosity::SolveOptions o;
    o.max_elements = 8000;
    field = radiosity::solve(query, basis, o).field;
  }
  scene::Scene scene;
  scene::RayQuery query{scene, {"isa=avx2"}};
  SpectralBasis basis = SpectralBasis::grey();
  scene::SurfaceField field;
};

// The density that points are chosen with is the density that they are said to have: the mean of
// 1 / pdf is the area of the parts that can be chosen, which uniform points over the room count by
// themselves.
TEST(BrightSurfaces, SamplesHaveTheirDensity) {
  const Solved room(cove());
  const scene::BrightSurfaces bright(room.scene, room.field);
  ASSERT_FALSE(bright.empty());
  const Vec3f p(Vec3f(0.4f, 0.3f, 0.6f) - room.scene.origin.cast<float>());
  const Vec3f up = Vec3f::UnitY();
  constexpr std::uint32_t kSamples = 1 << 16;
  double area = 0.0;
  double strip = 0.0;  // of that, on the ceiling
  double squares = 0.0;
  int off = 0;  // rounding may put a point beyond the border of its part
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    scene::Sampler sampler(7, 1, k);
    const float u_choice = sampler.next_1d();
    const auto s = bright.sample(p, up, u_choice, sampler.next_2d());
    if (!s) continue;
    ASSERT_GT(s->pdf, 0.0f);
    if (std::abs(bright.pdf(p, up, s->point, s->side) / s->pdf - 1.0f) > 1e-3f) ++off;
    const double own = 1.0 / static_cast<double>(s->pdf);
    area += own / kSamples;
    const double height = static_cast<double>(s->point.position.y()) + room.scene.origin.y();
    if (!(height > 2.39)) continue;
    strip += own / kSamples;
    squares += own * own / kSamples;
  }
  double counted = 0.0;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    scene::Sampler sampler(8, 2, k);
    const Vec2f u = sampler.next_2d();
    const Vec3f at = Vec3f(3.0f * u.x(), 0.0f, 3.0f * u.y()) - room.scene.origin.cast<float>();
    scene::Counters counters;
    scene::Ray ray{at + Vec3f(0, 2.3f, 0), Vec3f::UnitY()};
    const auto hit = room.query.closest(ray, counters, scene::Counter::RaysPrimary);
    if (!hit) continue;
    const scene::SurfacePoint point = scene::surface_point(room.scene, *hit);
    const auto side = point.ng.y() < 0.0f ? scene::Side::Front : scene::Side::Back;
    if (bright.pdf(p, up, point, side) > 0.0f) counted += 9.0 / kSamples;
  }
  EXPECT_GT(strip, 0.5 * area);
  EXPECT_GT(counted, 0.1);
  const double chosen_error = std::sqrt((squares - strip * strip) / kSamples);
  const double counted_error = std::sqrt(counted * (9.0 - counted) / kSamples);
  EXPECT_LT(chosen_error, 0.03 * strip);
  EXPECT_NEAR(strip, counted, 4.0 * std::hypot(chosen_error, counted_error));
  EXPECT_LT(off, 16);
}

TEST(BrightSurfaces, AreNoneWhereLightIsEven) {
  SceneMaker s;
  s.box(s.diffuse(0.5, 1.0), {0, 0, 0}, {3, 2.4, 4}, true);
  const Solved furnace(s.build());
  EXPECT_TRUE(scene::BrightSurfaces(furnace.scene, furnace.field).empty());
  EXPECT_TRUE(scene::BrightSurfaces(furnace.scene, {}).empty());
}

// Bent rays and points on bright surfaces change the noise, not the picture: it is that of path
// tracing, with less than a fifth of the noise that plain rays have (estimated error of 3.7 % where
// they have 20 %).
TEST(Gather, FindsTheLightOfACove) {
  const Solved room(cove());
  RenderOptions o;
  o.width = o.height = 24;
  o.samples = 1024;
  o.method = Method::Path;
  const RenderResult path = render(room.query, room.basis, camera(room.scene), {}, o);
  o.method = Method::Hybrid;
  o.samples = 128;
  o.share_samples = false;
  const RenderResult hybrid = render(room.query, room.basis, camera(room.scene), room.field, o);
  const auto mean = [](const scene::Image& image, const std::string& channel, double power) {
    const int c = image.channel_index(channel);
    double sum = 0.0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        sum += std::pow(static_cast<double>(image.at(x, y, c)), power);
    return sum / (image.width * image.height);
  };
  const double light = mean(path.image, "G", 1.0);
  const double error = std::sqrt(
      (mean(path.image, "stderr.G", 2.0) + mean(hybrid.image, "stderr.G", 2.0)) / (24.0 * 24.0));
  EXPECT_LT(error, 0.01 * light);
  // The field of elements of 7 cm, solved to about 1 %.
  EXPECT_NEAR(mean(hybrid.image, "G", 1.0), light, 4.0 * error + 0.015 * light);
  EXPECT_LT(hybrid.error_estimate, 0.06);
}

}  // namespace
}  // namespace atrium::trace
