// Lamps that are smaller than the pixels that show them: as bright as they are after a few samples,
// by every method, and by their share of the pixel's area.
#include <gtest/gtest.h>

#include "physics/picture_support.h"
#include "scene/camera_film.h"
#include "support/materials.h"
#include "trace/compare.h"

namespace atrium::trace {
namespace {

using testing::SceneMaker;

constexpr double kRadiance = 5000.0;
constexpr int kSize = 16;  // pixels, over 2 x 2 m at the lamps' distance

/// A square that faces the camera.
void add_lamp(SceneMaker& maker, scene::MaterialId lamp, const Vec2d& middle, double edge) {
  const double h = 0.5 * edge;
  maker.quad(lamp, {middle.x() - h, middle.y() - h, 0}, {edge, 0, 0}, {0, edge, 0});
}

/// Such lamps 4 m before the camera in a black world. \param wall  a wall 2 m before it hides what
/// is left of x = 0.
scene::Scene lamps_at(const std::vector<Vec2d>& places, double edge, bool wall = false) {
  SceneMaker maker;
  const auto black = maker.diffuse(0.0);
  maker.quad(black, {-4, -4, -1}, {8, 0, 0}, {0, 8, 0});
  const auto lamp = maker.diffuse(0.0, kRadiance);
  for (const Vec2d& p : places) add_lamp(maker, lamp, p, edge);
  if (wall) maker.quad(black, {-3, -3, 2}, {3, 0, 0}, {0, 6, 0});
  return maker.build();
}

scene::Camera camera_of(scene::Camera::Kind kind) {
  scene::Camera c = camera_at({0, 0, 4}, {0, 0, 0}, 2.0 * std::atan(0.25));
  c.kind = kind;
  c.height = 2.0;
  return c;
}

RenderOptions options_of(Method method, int samples) {
  RenderOptions o = path_options(kSize, samples);
  o.method = method;
  return o;
}

/// Sum over all pixels, in pixels filled by a lamp.
double filled(const Picture& p) { return p.mean * kSize * kSize / kRadiance; }

// A square of edge a covers (8 a)^2 pixels of a picture that is 16 pixels and 2 m wide.
TEST(SmallLamps, CoverTheirShareOfAPixel) {
  for (const double edge : {0.05, 0.01, 0.001, 1e-4}) {
    SCOPED_TRACE(edge);
    const scene::Scene s = lamps_at({{0.05, 0.07}}, edge);
    const double share = std::pow(8.0 * edge, 2.0);
    for (const auto kind : {scene::Camera::Kind::Perspective, scene::Camera::Kind::Orthographic}) {
      for (const Method method : {Method::Path, Method::Hybrid, Method::Direct}) {
        const Picture p = picture(s, camera_of(kind), options_of(method, 4));
        EXPECT_NEAR(filled(p) / share, 1.0, 0.05);
      }
      RenderOptions o = options_of(Method::Path, 4);
      o.paths = PathKind::BothEnds;
      EXPECT_NEAR(filled(picture(s, camera_of(kind), o)) / share, 1.0, 0.05);
    }
  }
}

// The same seen by a camera that sees everything, in single pixels of 11 degrees.
TEST(SmallLamps, InAPanorama) {
  const scene::Scene s = lamps_at({{0.0, 0.3}}, 0.01);
  const scene::Camera camera = camera_of(scene::Camera::Kind::Panorama);
  const Vec3d middle = Vec3d(0.0, 0.3, 0.0) - s.origin;
  const auto place = scene::film_place(in_scene(camera, s), middle.cast<float>(), 1.0);
  ASSERT_TRUE(place.has_value());
  const double cosine = 4.0 / std::hypot(4.0, 0.3);
  const double share = place->density * kSize * kSize * 1e-4 * cosine;
  EXPECT_NEAR(filled(picture(s, camera, options_of(Method::Path, 4))) / share, 1.0, 0.05);
}

// Half of a lamp's light at the border of two pixels and a quarter where four meet; none is lost.
TEST(SmallLamps, BetweenPixels) {
  const scene::Scene s = lamps_at({{0.0, 0.0}, {0.5, 0.0625}}, 0.02);
  const Picture p =
      picture(s, camera_of(scene::Camera::Kind::Orthographic), options_of(Method::Path, 4));
  const double share = 0.16 * 0.16;
  EXPECT_NEAR(filled(p) / (2.0 * share), 1.0, 0.05);
  const scene::Image& image = p.result.image;
  const int g = image.channel_index("G");
  const auto at = [&](int x, int y) {
    return static_cast<double>(image.at(x, y, g)) / kRadiance / share;
  };
  for (const int x : {7, 8})
    for (const int y : {7, 8}) EXPECT_NEAR(at(x, y), 0.25, 0.02);
  for (const int x : {11, 12}) EXPECT_NEAR(at(x, 7), 0.5, 0.04);
}

// Many in one pixel, far more of them than there are parts of a pixel.
TEST(SmallLamps, ManyInOnePixel) {
  std::vector<Vec2d> places;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 8; ++column)
      places.emplace_back(0.01 + 0.1 * column / 8.0, 0.01 + 0.1 * row / 5.0);
  const scene::Scene s = lamps_at(places, 0.004);
  const double share = 40.0 * 0.032 * 0.032;
  EXPECT_NEAR(filled(picture(s, camera_of(scene::Camera::Kind::Perspective),
                             options_of(Method::Path, 1024))) /
                  share,
              1.0, 0.05);
}

// What is behind a wall or shines away from the camera is not seen; half of what it hides half.
TEST(SmallLamps, AreHidden) {
  const auto seen = [](const std::vector<Vec2d>& places) {
    const scene::Scene s = lamps_at(places, 0.01, true);
    return filled(picture(s, camera_of(scene::Camera::Kind::Orthographic),
                          options_of(Method::Hybrid, 16))) /
           (0.08 * 0.08);
  };
  EXPECT_EQ(seen({{-0.2, 0.07}}), 0.0);
  EXPECT_NEAR(seen({{0.2, 0.07}}), 1.0, 0.03);
  EXPECT_NEAR(seen({{0.0, 0.07}}), 0.5, 0.03);
}

// Through a pane they are found by camera rays, before it by rays of their own; both count once.
TEST(SmallLamps, BehindGlass) {
  SceneMaker maker;
  add_lamp(maker, maker.diffuse(0.0, kRadiance), {0.07, 0.06}, 0.02);
  const auto pane = maker.material(testing::glass(material::Material::Medium::Pane));
  maker.quad(pane, {-3, -3, 2}, {6, 0, 0}, {0, 6, 0});
  const scene::Scene s = maker.build();
  RenderOptions o = options_of(Method::Path, 4096);
  o.components = true;
  const Picture p = picture(s, camera_of(scene::Camera::Kind::Orthographic), o);
  const double through = 1.0 - 2.0 * 0.04 / (1.0 + 0.04);  // n = 1.5
  EXPECT_NEAR(filled(p) / (0.16 * 0.16), through, 0.05);
}

// A picture that asks for an error has it, although but one camera ray of its pixel in 40 meets the
// lamp: by camera rays alone 16 of these 20 pictures are more than that beside the truth.
TEST(SmallLamps, AnAskedErrorIsFound) {
  SceneMaker maker;
  maker.box(maker.diffuse(0.5), {-1, -1, -1}, {1, 1, 4.5}, true);
  add_lamp(maker, maker.diffuse(0.5, kRadiance), {0.06, 0.07}, 0.0066);
  maker.quad(maker.diffuse(0.5, 5.0), {-0.5, 0.99, 0}, {1, 0, 0}, {0, 0, 1});
  const scene::Scene s = maker.build();
  const scene::RayQuery query(s, {"isa=avx2"});
  const auto basis = material::SpectralBasis::rgb();
  const scene::Camera camera = in_scene(camera_of(scene::Camera::Kind::Perspective), s);
  RenderOptions o = options_of(Method::Direct, 1024);
  o.width = o.height = 3 * kSize;
  const auto reference = render(query, basis, camera, {}, o);
  int above = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    o.samples = 1 << 14;
    o.error = 0.1;
    o.seed = seed;
    const auto asked = render(query, basis, camera, {}, o);
    EXPECT_EQ(asked.stopped_by, "error");
    if (compare(asked.image, reference.image).pixel.value > 0.12) ++above;
  }
  EXPECT_LE(above, 1);
}

}  // namespace
}  // namespace atrium::trace
