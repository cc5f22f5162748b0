// Surfaces on top of each other in one plane, and thin walls that end in the room.
#include <gtest/gtest.h>

#include "physics/leak_rooms.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kReflectance = 0.5;

/// A room with a rug that lies in the plane of the floor.
scene::Scene rug_room(bool rug_first, bool turned) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(kReflectance));
  const auto lay_rug = [&] {
    // Oblique to the elements, larger than some and smaller than most.
    const Vec3f a(0.83f, 0.71f, 0), b(2.51f, 1.13f, 0), c(2.19f, 2.41f, 0), d(0.51f, 1.99f, 0);
    if (turned)
      maker.quad(white, a, d, c, b);
    else
      maker.quad(white, a, b, c, d);
  };
  if (rug_first) lay_rug();
  maker.room({0, 0, 0}, {4, 3, 2.5f}, white);
  if (!rug_first) lay_rug();
  maker.point_light({2, 1.5, 2}, 10.0);
  return maker.take();
}

// All that is emitted is absorbed, once: with elements counted as long as less than three quarters
// of them were covered, the floor below this rug absorbed 2 % of the light again.
TEST(Coplanar, EveryPartOfAnAreaCountsOnce) {
  for (const bool rug_first : {true, false})
    for (const bool turned : {true, false}) {
      SCOPED_TRACE(std::string(rug_first ? "rug first" : "floor first") +
                   (turned ? ", turned" : ""));
      const Solved s(rug_room(rug_first, turned),
                     {.element_size = 0.6, .max_level = 0, .direct_samples = 256});
      const FluxBalance& f = s.result.flux;
      EXPECT_NEAR(f.absorbed / f.emitted, 1.0, 2e-3);
      // One area is active on each side of the plane: that of the floor.
      double floor = 0.0;
      for (std::size_t e = 0; e < s.count(); ++e)
        if (s.centre(e).z() < 1e-4f && s.total(e) > 0.0) floor += s.area(e);
      EXPECT_GT(floor, 11.99);
    }
}

/// A thin wall that stands on the floor and ends in the room, a lamp close to it on one side.
scene::Scene screen_room(float x0, float y0, float x1, float y1) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(kReflectance));
  maker.room({0, 0, 0}, {4, 3, 2.5f}, white);
  maker.quad(white, {x0, y0, 0}, {x1, y1, 0}, {x1, y1, 2.1f}, {x0, y0, 2.1f});
  maker.point_light({0.9, 0.5, 1.9}, 10.0);
  return maker.take();
}

/// RMS over the floor within 25 cm of both sides of the wall of the difference between two
/// interpolated fields, relative to the mean.
double difference_beside(const Solved& s, const Solved& reference, const Vec2f& a, const Vec2f& b) {
  double squares = 0.0, mean = 0.0, count = 0.0;
  for (float x = 0.025f; x < 4.0f; x += 0.05f)
    for (float y = 0.025f; y < 3.0f; y += 0.05f) {
      const Vec2f p(x, y);
      const float t = (p - a).dot(b - a) / (b - a).squaredNorm();
      // Beyond its end the shadow's edge lies, which is a matter of the elements' size.
      if (t < 0.0f || t > 0.9f || (a + t * (b - a) - p).norm() > 0.25f) continue;
      const double is = test::look(s, {x, y, 0.1f}, {0, 0, -1});
      const double expected = test::look(reference, {x, y, 0.1f}, {0, 0, -1});
      squares += (is - expected) * (is - expected);
      mean += expected;
      count += 1.0;
    }
  return std::sqrt(squares / count) / (mean / count);
}

struct Screen {
  const char* name;
  Vec2f a, b;
  /// Measured: 0.11, 0.07, 0.17; 0.43, 0.54, 0.44 with elements on both sides of the wall. Shadow
  /// and light vary within half a metre, too.
  double allowed;
};

TEST(FreeWalls, LightDoesNotLeakBelowADoorLeaf) {
  for (const Screen& w : {Screen{"from a wall", {2.03f, 0}, {2.03f, 0.9f}, 0.15},
                          Screen{"oblique", {2.03f, 0}, {2.5f, 0.75f}, 0.1},
                          Screen{"in the room", {2.03f, 0.3f}, {2.13f, 1.1f}, 0.2}}) {
    SCOPED_TRACE(w.name);
    const auto solved = [&](double size) {
      return Solved(screen_room(w.a.x(), w.a.y(), w.b.x(), w.b.y()),
                    {.element_size = size, .max_level = 0, .direct_samples = 64});
    };
    const Solved reference = solved(0.05);
    const double coarse = difference_beside(solved(0.5), reference, w.a, w.b);
    ::testing::Test::RecordProperty(std::string("rms ") + w.name, std::to_string(coarse));
    EXPECT_LT(coarse, w.allowed);
  }
}

/// A room with a board 2 cm above the floor, and what its elements say of the floor.
struct BoardRoom {
  static constexpr float kX0 = 0.83f, kX1 = 2.13f, kY0 = 1.04f, kY1 = 1.67f, kHeight = 0.02f;
  Solved solved;

  explicit BoardRoom(double size)
      : solved(make(), {.element_size = size, .max_level = 0, .direct_samples = 64}) {}

  static scene::Scene make() {
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(kReflectance));
    maker.room({0, 0, 0}, {4, 3, 2.5f}, white);
    maker.quad(white, {kX0, kY0, kHeight}, {kX1, kY0, kHeight}, {kX1, kY1, kHeight},
               {kX0, kY1, kHeight});
    maker.point_light({2, 1.5, 2}, 10.0);
    return maker.take();
  }
  /// Mean irradiance of a rectangle of the floor.
  [[nodiscard]] double floor(float x0, float x1, float y0, float y1) const {
    constexpr int kSteps = 20;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        sum += test::look(solved,
                          {x0 + (x1 - x0) * (static_cast<float>(i) + 0.5f) / kSteps,
                           y0 + (y1 - y0) * (static_cast<float>(j) + 0.5f) / kSteps, 0.01f},
                          {0, 0, -1});
    return sum / (kSteps * kSteps);
  }
  [[nodiscard]] double below() const { return floor(kX0, kX1, kY0, kY1); }
  [[nodiscard]] double beside() const { return floor(kX0, kX1, kY0 - 0.3f, kY0); }
};

// With elements of half a metre on both sides of its outline the floor below the board would have
// 51 % of the light beside it, which is lost there.
TEST(Overhang, LightDoesNotLeakBelowABoard) {
  const BoardRoom coarse(0.5), reference(0.05);
  RecordProperty("below", std::to_string(coarse.below() / reference.beside()));
  RecordProperty("beside", std::to_string(coarse.beside() / reference.beside()));
  RecordProperty("reference below", std::to_string(reference.below() / reference.beside()));
  EXPECT_LT(reference.below(), 0.1 * reference.beside());
  EXPECT_NEAR(coarse.below(), reference.below(), 0.02 * reference.beside());
  EXPECT_NEAR(coarse.beside(), reference.beside(), 0.05 * reference.beside());
}

}  // namespace
}  // namespace atrium::radiosity
