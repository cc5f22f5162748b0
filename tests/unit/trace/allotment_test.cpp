#include "allotment.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "picture_samples.h"

namespace atrium::trace {
namespace {

constexpr int kSize = 64;
constexpr std::size_t kPixels = std::size_t{kSize} * kSize;

PixelCosts uniform(float noise, std::uint32_t count) {
  PixelCosts p{kSize, kSize, {}, {}, {}, {}};
  p.noise.assign(kPixels, noise);
  p.bias.assign(kPixels, 0.0f);
  p.count.assign(kPixels, count);
  p.cost.assign(kPixels, 3.0f);
  return p;
}
bool left(std::size_t i) { return i % kSize < kSize / 2; }
std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kSize + x); }

// e^2 falls as 1 / n: 0.04 at 8 samples is 0.02 at 16.
TEST(Allotment, ReachesTheGoal) {
  const auto n =
      allot_samples(uniform(0.04f, 8), {.goal = std::sqrt(0.02), .growth = 4.0, .most = 1000});
  for (const std::uint32_t v : n) EXPECT_EQ(v, 16u);
}

// Nine times the variance earns three times the samples, four times the cost half of them.
TEST(Allotment, IsNeymans) {
  PixelCosts p = uniform(0.01f, 8);
  for (std::size_t i = 0; i < kPixels; ++i)
    if (left(i)) p.noise[i] = 0.09f;
  const RoundLimits limits{.goal = std::sqrt(0.05 * 8.0 / 400.0), .growth = 100.0, .most = 100000};
  p.count.assign(kPixels, 100);  // a few steps of the least number do not matter
  for (float& v : p.noise) v *= 0.08f;
  auto n = allot_samples(p, limits);
  EXPECT_NEAR(n[at(10, 32)] / static_cast<double>(n[at(50, 32)]), 3.0, 0.1);
  for (std::size_t i = 0; i < kPixels; ++i)
    if (left(i)) p.cost[i] = 12.0f;
  n = allot_samples(p, limits);
  EXPECT_NEAR(n[at(10, 32)] / static_cast<double>(n[at(50, 32)]), 1.5, 0.1);
}

// Whatever a pixel has found itself, its number of samples stays: else bright samples would be
// diluted and dark ones not, and pictures would come out dark.
TEST(Allotment, APixelsOwnSamplesDoNotDecide) {
  PixelCosts p = uniform(0.04f, 8);
  const RoundLimits limits{.goal = 0.02, .growth = 2.0, .most = 1000};
  const auto before = allot_samples(p, limits);
  p.noise[at(20, 20)] = 20.0f;
  p.bias[at(20, 20)] = 0.1f;
  p.cost[at(20, 20)] = 5.0f;
  const auto after = allot_samples(p, limits);
  EXPECT_EQ(after[at(20, 20)], before[at(20, 20)]);
  EXPECT_GT(after[at(21, 20)], before[at(21, 20)]);
}

// What no sample near by has found may still be there if the wider region has it.
TEST(Allotment, ARegionIsThePrior) {
  PixelCosts p = uniform(0.0f, 8);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) p.noise[at(30 + x, 30 + y)] = 0.5f;
  const auto n = allot_samples(p, {.goal = 0.01, .growth = 8.0, .most = 1000});
  EXPECT_GT(n[at(38, 32)], 8u);  // 5 pixels away: beyond its neighbours, in the region
  EXPECT_EQ(n[at(60, 60)], 8u);
}

TEST(Allotment, KeepsWithinItsLimits) {
  PixelCosts p = uniform(0.04f, 8);
  p.noise[5] = 1e6f;
  const auto n = allot_samples(p, {.goal = 1e-6, .growth = 2.0, .most = 14});
  for (const std::uint32_t v : n) {
    EXPECT_GE(v, 8u);
    EXPECT_LE(v, 14u);
  }
  const auto half = allot_samples(uniform(0.04f, 8), {.goal = 1e-6, .growth = 2.0, .most = 1000});
  const double total = std::accumulate(half.begin(), half.end(), 0.0);
  EXPECT_NEAR(total / (8.0 * kPixels), 2.0, 0.01);
  for (const std::uint32_t v : half) EXPECT_EQ((v - 8) % kReplicates, 0u);
}

}  // namespace
}  // namespace atrium::trace
