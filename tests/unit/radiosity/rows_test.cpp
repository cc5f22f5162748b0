#include "rows.h"

#include <gtest/gtest.h>

#include "unit/radiosity/row_box.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Box;
using test::closed_box;

// In a closed room every ray of an inner side ends on an inner side: rows sum to the ray count
// exactly (sums of ones).
TEST(Rows, ClosedRoomSumsToOneExactly) {
  Box box{closed_box(0.5)};
  const Rows<1> rows = box.rows();
  int inner = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (side_of(box.problem.sides.active[k]) != scene::Side::Front) continue;
    float sum = 0.0f;
    for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e) {
      sum += rows.entries[e].weight;
      EXPECT_EQ(rows.entries[e].target % 2, 0U);
    }
    EXPECT_EQ(sum, 32.0f);
    EXPECT_EQ(rows.escaped[k].mean(), 0.0f);
    ++inner;
  }
  EXPECT_GT(inner, 100);
}

// Rays 0..15 and then 16..31 make the same rows as 0..31 at once.
TEST(Rows, RoundsAddUp) {
  Box box{closed_box(0.5)};
  const std::vector<std::uint8_t> all(box.problem.sides.active.size(), 1);
  Rows<1> half = trace_rows<1>(box.problem, {}, {}, all, 0, 16, box.work, box.counters);
  const Rows<1> both =
      trace_rows<1>(box.problem, {}, std::move(half), all, 16, 32, box.work, box.counters);
  const Rows<1> once = box.rows();
  ASSERT_EQ(both.entries.size(), once.entries.size());
  for (std::size_t e = 0; e < once.entries.size(); ++e) {
    EXPECT_EQ(both.entries[e].target, once.entries[e].target);
    EXPECT_EQ(both.entries[e].weight, once.entries[e].weight);
  }
}

// A body with closed outer faces has no inner side; a room wound outwards does, as a lamp in it
// shows.
TEST(Problem, ClosedBodyHasOneSideUnlessLitInside) {
  for (const bool lamp_inside : {false, true}) {
    SCOPED_TRACE(lamp_inside);
    SceneMaker maker;
    maker.sphere(maker.material(test::diffuse(0.5)), 1.0f, 2, false);
    maker.point_light(lamp_inside ? Vec3d(0, 0, 0) : Vec3d(0, 0, 3), 1.0);
    Box box{maker.take()};
    const std::size_t elements = box.elements.layout.element_count();
    EXPECT_EQ(box.problem.sides.active.size(), lamp_inside ? 2 * elements : elements);
  }
}

// Points on an element are uniform by area: their mean is the centroid.
TEST(ElementPoints, MeanIsCentroid) {
  SceneMaker maker;
  maker.object(maker.material(test::diffuse(0.5)),
               {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3f, 0.6f, 0}},
               {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const scene::Scene scene = maker.take();
  const Elements e = make_elements(scene, {.element_size = 1.0});
  ASSERT_EQ(e.layout.element_count(), 1U);
  const ElementPoints points(scene, e);
  Vec3d sum = Vec3d::Zero();
  for (std::uint32_t k = 0; k < 4096; ++k) {
    scene::Sampler sampler(1, 0, k);
    sum += points.sample(0, sampler.next_2d()).position.cast<double>();
  }
  // Low-discrepancy: far below the random 0.29 / sqrt(4096) = 0.0045.
  EXPECT_NEAR(sum.x() / 4096, 0.5, 1e-3);
  EXPECT_NEAR(sum.y() / 4096, 0.5, 1e-3);
}

}  // namespace
}  // namespace atrium::radiosity
