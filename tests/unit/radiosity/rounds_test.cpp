// What rounds of samples stand on: tallies, regions, bent rays, plans.
#include <gtest/gtest.h>

#include <cmath>

#include "error_control.h"
#include "material/spectral_basis.h"
#include "rows.h"
#include "scene/ray_query.h"
#include "tally.h"
#include "unit/radiosity/box_scene.h"

namespace {

using namespace atrium;
using namespace atrium::radiosity;

/// A room of 0.25 m elements.
struct Room {
  Room() {
    test::SceneMaker maker;
    maker.room({0, 0, 0}, {3, 2, 2}, maker.material(test::diffuse(0.5)));
    maker.point_light({1, 1, 1}, 1.0);
    scene = maker.take();
    query.emplace(scene);
    shading.emplace(*query, material::SpectralBasis::grey());
    elements = make_elements(scene, {.element_size = 0.25});
    problem.emplace(*shading, elements, options);
  }
  scene::Scene scene;
  std::optional<scene::RayQuery> query;
  std::optional<scene::Shading<1>> shading;
  SolveOptions options;
  Elements elements;
  std::optional<Problem<1>> problem;
};

SideSums<1> sums_of(std::array<float, kReplicates> values) {
  SideSums<1> sums(1);
  for (int r = 0; r < kReplicates; ++r) {
    const Spectrum<1> v(values[static_cast<std::size_t>(r)]);
    sums.add(0, r, v, v);
    sums.end_sample();
    sums.valid[static_cast<std::size_t>(r)] = 1;
  }
  return sums;
}

// Two rounds of means 3 and 7 with shares 0.75 and 0.25; variances of four values 1 2 4 5 and
// 5 6 8 9 (squared deviations 10, over 3 * 4) join by the squares of their shares.
TEST(Tally, JoinsRoundsByTheirShares) {
  Tally<1> tally(1, 1, false);
  tally.add(0, sums_of({1, 2, 4, 5}), 1);
  EXPECT_FLOAT_EQ(tally.mean(0, 0)[0], 3.0f);
  EXPECT_NEAR(tally.variance(0), 10.0 / 12.0, 1e-6);
  tally.end_round(1.0);
  EXPECT_FLOAT_EQ(tally.mean(0, 0)[0], 3.0f);
  EXPECT_EQ(tally.drawn(0), 0u);
  tally.add(0, sums_of({5, 6, 8, 9}), 1);
  EXPECT_FLOAT_EQ(tally.mean(0, 0)[0], 3.0f) << "an unfinished round does not count";
  tally.end_round(0.25);
  EXPECT_FLOAT_EQ(tally.mean(0, 0)[0], 4.0f);
  EXPECT_NEAR(tally.variance(0), (0.75 * 0.75 + 0.25 * 0.25) * 10.0 / 12.0, 1e-6);
  EXPECT_EQ(tally.valid(0), 8u);
  EXPECT_FLOAT_EQ(static_cast<float>(tally.last_mean(0)), 7.0f);
}

// A side that nothing was valid of keeps what it had.
TEST(Tally, RoundsWithoutValidSamplesChangeNothing) {
  Tally<1> tally(2, 1, false);
  tally.add(0, sums_of({1, 2, 4, 5}), 1);
  tally.end_round(1.0);
  tally.add(1, sums_of({5, 6, 8, 9}), 1);
  tally.end_round(0.5);
  EXPECT_FLOAT_EQ(tally.mean(0, 0)[0], 3.0f);
  EXPECT_FLOAT_EQ(tally.mean(1, 0)[0], 7.0f);
}

TEST(Regions, HoldEverySideOnceAndFaceAlike) {
  const Room room;
  const Regions regions(*room.problem);
  int apart = 0;
  std::vector<int> times(room.problem->side_count(), 0);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    ASSERT_LE(regions.members(r).size(), Regions::kMost);
    const SideIndex first = regions.members(r).front();
    const auto normal = [&](SideIndex i) {
      return room.problem->points.ng(room.problem->points.spot(i / 2, 0.5f, 0.5f).fan);
    };
    for (const SideIndex i : regions.members(r)) {
      ++times[i];
      apart += normal(i).dot(normal(first)) < 0.9f ? 1 : 0;
    }
  }
  // Walls of a room part before places do.
  EXPECT_EQ(apart, 0);
  for (const SideIndex i : room.problem->sides.active) EXPECT_EQ(times[i], 1);
}

// One entry of a coloured path: 2 rays, summed weights 0.2, 0.4 and 0.6 by lane, so a share of 0.2 on
// average, and 0.2^2 of the variance of what it meets.
TEST(Rows, ColouredEntriesPassOnVarianceByTheirWeights) {
  Rows<3> rows;
  rows.first = {0, 1};
  rows.entries.resize(1);
  rows.entries[0] = {1U | Rows<3>::kChromatic, 1.0f, 1.0f, 0};
  Spectrum<3> weights;
  for (int lane = 0; lane < 3; ++lane) weights[lane] = 0.2f * static_cast<float>(lane + 1);
  rows.spectral = {weights};
  rows.rays = {2};
  EXPECT_NEAR(rows.mean_weight(rows.entries[0]), 0.4, 1e-6);
  EXPECT_NEAR(rows.apply_squared(0, {100.0, 4.0}), 0.16, 1e-6);
}

// One stratum of equal sides: n samples of variance 1 each make V = 1 / n; joined with V0 = 1 / n0
// it is 1 / (n + n0).
TEST(RoundEffort, BringsTheSumToWhatIsWanted) {
  const Room room;
  const Problem<1>& p = *room.problem;
  const auto sides = static_cast<double>(p.sides.active.size());
  Tally<1> tally(p.side_count(), 1, false);
  std::vector<double> weights(p.side_count(), 0.0);
  std::vector<double> variance(p.side_count(), 0.0);
  for (const SideIndex i : p.sides.active) {
    tally.add(i, sums_of({1, 2, 4, 5}), 1);
    weights[i] = 1.0 / sides;
    variance[i] = 1.0;
  }
  const std::vector<float> exposed(p.side_count(), 1.0f);
  const Stratum<1> stratum{&tally, variance, 1.0};
  const double effort = round_effort(p, weights, exposed, {stratum}, {1.0 / 4.0}, 1.0 / 24.0, 1e9);
  // 20 more for each side.
  const std::vector<Draw> plan = plan_round(p, weights, exposed, stratum, effort);
  ASSERT_EQ(plan.size(), p.sides.active.size());
  for (const Draw& d : plan) EXPECT_NEAR(d.more * kReplicates, 20.0, 4.0);
  // No more than may be spent.
  const double little =
      round_effort(p, weights, exposed, {stratum}, {1.0 / 4.0}, 1.0 / 24.0, 8.0 * sides);
  for (const Draw& d : plan_round(p, weights, exposed, stratum, little))
    EXPECT_EQ(d.more * kReplicates, 8u);
}

}  // namespace
