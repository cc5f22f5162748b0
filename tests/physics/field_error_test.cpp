#include <cmath>

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "support/scenes.h"
#include "trace/compare.h"
#include "trace/render.h"

namespace atrium::trace {
namespace {

using material::SpectralBasis;
using testing::SceneMaker;

/// A room with a lamp and a block, lit by inter-reflection for a good part.
class Room {
 public:
  Room() : scene_(make()), query_(scene_, {"isa=avx2"}) {
    radiosity::SolveOptions o;
    o.max_elements = 4000;
    field_ = radiosity::solve(query_, SpectralBasis::grey(), o).field;
    camera_.to_scene = scene::look_at({1.5, 1.3, 0.2}, {1.3, 0.8, 3.0}, Vec3d::UnitY());
    camera_.to_scene.translation() -= scene_.origin;
    camera_.yfov = 1.1;
  }
  /// The solution, all light in it times a factor.
  [[nodiscard]] scene::SurfaceField field(float factor) const {
    scene::SurfaceField wrong = field_;
    for (auto* q : {&wrong.irradiance, &wrong.body_irradiance})
      for (auto* part : {&q->direct, &q->caustic, &q->indirect})
        for (float& v : *part) v *= factor;
    return wrong;
  }
  [[nodiscard]] RenderResult render(float factor, const RenderOptions& o) const {
    return trace::render(query_, SpectralBasis::grey(), camera_, field(factor), o);
  }

 private:
  static scene::Scene make() {
    SceneMaker s;
    s.box(s.diffuse(0.7), {0, 0, 0}, {3, 2.4, 4}, true);
    s.quad(s.diffuse(0.0, 20.0), {1.0, 2.39, 2.4}, {1, 0, 0}, {0, 0, 1});
    s.box(s.diffuse(0.5), {1.2, 0.01, 2.5}, {1.8, 0.7, 3.2}, false);
    return s.build();
  }
  scene::Scene scene_;
  scene::RayQuery query_;
  scene::Camera camera_;
  scene::SurfaceField field_;
};

RenderOptions options(Indirect indirect, double error, int samples) {
  RenderOptions o;
  o.indirect = indirect;
  o.width = 48;
  o.height = 36;
  o.error = error;
  o.samples = samples;
  return o;
}

class FieldError : public ::testing::TestWithParam<Indirect> {};

// A field that lacks a fifth of its light makes a picture whose error is known: what it differs by
// from the picture of the right field. A single estimate is rough, but right in the mean of
// squares.
TEST_P(FieldError, IsFoundByPaths) {
  const Room room;
  const auto exact = room.render(1.0f, options(GetParam(), 0.0, 512));
  const auto wrong = room.render(0.8f, options(GetParam(), 0.0, 512));
  const double found = compare(exact.image, wrong.image).pixel.value;  // relative to the wrong one
  ASSERT_GT(found, 0.05);

  constexpr int kSeeds = 24;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RenderOptions o = options(GetParam(), 0.2, 1 << 14);
    o.seed = seed;
    const auto asked = room.render(0.8f, o);
    EXPECT_EQ(asked.stopped_by, "error");
    EXPECT_GE(asked.error_estimate, asked.field_error_estimate);
    square += asked.field_error_estimate * asked.field_error_estimate / kSeeds;
  }
  EXPECT_GT(std::sqrt(square), 0.85 * found);
  EXPECT_LT(std::sqrt(square), 1.15 * found);
}

// Samples do not lower it, and the picture says so.
TEST_P(FieldError, EndsThePicture) {
  const Room room;
  const auto asked = room.render(0.8f, options(GetParam(), 0.03, 1 << 14));
  EXPECT_EQ(asked.stopped_by, "radiosity");
  EXPECT_TRUE(asked.complete);
  EXPECT_GT(asked.field_error_estimate, 0.03);
  EXPECT_GT(asked.block_error_estimate, 0.03);
  EXPECT_LT(asked.samples_mean, 500.0);
}

// A caller who can have a better field wants to know before it is certain that this one is useless.
TEST_P(FieldError, EndsThePictureEarlierAboveItsShare) {
  const Room room;
  double whole = 0.0, half = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RenderOptions o = options(GetParam(), GetParam() == Indirect::Mesh ? 0.04 : 0.08, 1 << 14);
    o.seed = seed;
    const auto last = room.render(0.8f, o);
    EXPECT_EQ(last.stopped_by, "radiosity");
    whole += last.samples_mean;
    o.field_share = 0.5;
    const auto early = room.render(0.8f, o);
    EXPECT_EQ(early.stopped_by, "radiosity");
    EXPECT_GT(early.field_error_estimate, 0.5 * o.error);
    EXPECT_LE(early.samples_mean, last.samples_mean);
    half += early.samples_mean;
  }
  RecordProperty("samples", std::to_string(half / whole));
  EXPECT_LT(half, 0.9 * whole);
}

TEST_P(FieldError, IsSmallOfAGoodField) {
  const Room room;
  const auto asked = room.render(1.0f, options(GetParam(), 0.02, 1 << 14));
  EXPECT_EQ(asked.stopped_by, "error");
  EXPECT_LT(asked.field_error_estimate, 0.01);
}

// Samples that check the field have numbers of their own.
TEST_P(FieldError, CheckingChangesNoPixel) {
  const Room room;
  const auto plain = room.render(1.0f, options(GetParam(), 0.0, 8));
  const auto checked = room.render(1.0f, options(GetParam(), 1e-6, 8));
  EXPECT_EQ(plain.image.pixels, checked.image.pixels);
  EXPECT_EQ(plain.counters[scene::Counter::RaysPath], 0U);
  EXPECT_GT(checked.counters[scene::Counter::RaysPath], 0U);
  EXPECT_EQ(plain.counters[scene::Counter::RaysGather],
            checked.counters[scene::Counter::RaysGather]);
}

INSTANTIATE_TEST_SUITE_P(MeshAndGather, FieldError,
                         ::testing::Values(Indirect::Mesh, Indirect::Gather));

}  // namespace
}  // namespace atrium::trace
