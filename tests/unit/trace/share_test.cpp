#include "share.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace atrium::trace {
namespace {

constexpr int kSize = 64;

// A wall that faces the camera, one metre per pixel.
ShareGuides flat_guides() {
  ShareGuides g{kSize, kSize};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      g.add({static_cast<float>(x), static_cast<float>(y), 0.0f}, Vec3f::UnitZ(), 50.0f);
  return g;
}

template <class F>
Illumination noisy(F&& truth, float sigma) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0.0f, sigma);
  Illumination i;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      // The mean of the two replicates of a half has the variance that is stated.
      for (auto& r : i.replicate) r.emplace_back(truth(x, y) + std::sqrt(2.0f) * normal(random));
      i.variance.push_back(sigma * sigma);
    }
  return i;
}

Rgb first_half(const Illumination& i, std::size_t pixel) {
  return (i.replicate[0][pixel] + i.replicate[1][pixel]) * 0.5f;
}

double rms(const Illumination& i, double truth, int x0, int x1) {
  double sum = 0.0;
  for (int y = 0; y < kSize; ++y)
    for (int x = x0; x < x1; ++x)
      sum += std::pow(
          static_cast<double>(first_half(i, static_cast<std::size_t>(y * kSize + x))[1]) - truth,
          2.0);
  return std::sqrt(sum / (kSize * (x1 - x0)));
}

// Uniform light with 10 % noise: what is left must be well below it, and the reported variance must
// not promise more than was reached.
TEST(Share, NoiseOnAFlatWallGoesDown) {
  const Illumination in = noisy([](int, int) { return 1.0f; }, 0.1f);
  const Illumination out = share_illumination(flat_guides(), in);
  const double left = rms(out, 1.0, 0, kSize);
  EXPECT_LT(left, 0.02);
  double variance = 0.0;
  for (const float v : out.variance) variance += static_cast<double>(v);
  // The overlap factor holds for full weights; where noise holds some neighbours off, each level
  // reports more than it leaves. So: never below the error (0.7 for one realisation of few
  // independent patches), and not so far above that sharing would seem useless.
  const double reported = std::sqrt(variance / (kSize * kSize));
  EXPECT_GT(reported, 0.7 * left);
  EXPECT_LT(reported, 0.1 / 4.0);
}

// Rare bright samples, as light through a small gap gives them: the mean is what counts, and it
// stays. (Weights from the samples themselves lose a tenth of it.)
TEST(Share, SkewedNoiseKeepsItsMean) {
  std::mt19937 random(9);
  std::exponential_distribution<float> rare(1.0f);
  Illumination in;
  for (int i = 0; i < kSize * kSize; ++i) {
    for (auto& r : in.replicate) {
      const float x = rare(random);
      r.emplace_back(x * x * 0.5f);  // mean 1, variance 5
    }
    in.variance.push_back(2.5f);
  }
  const Illumination out = share_illumination(flat_guides(), in);
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < kSize * kSize; ++i)
    for (std::size_t r = 0; r < kReplicates; ++r) {
      before += static_cast<double>(in.replicate[r][i][1]);
      after += static_cast<double>(out.replicate[r][i][1]);
    }
  const double n = 4.0 * kSize * kSize;
  EXPECT_NEAR(after / n, before / n, 4.0 * std::sqrt(5.0 / n));
}

// What the estimate of the error rests on: the two replicates of a half differ by the noise that is
// left in their mean, as its weights know nothing of either. Averages of 64 pixels: 8 %.
TEST(Share, ReplicatesDifferByTheNoiseThatIsLeft) {
  const Illumination out =
      share_illumination(flat_guides(), noisy([](int, int) { return 1.0f; }, 0.1f));
  double squares = 0.0;
  for (std::size_t i = 0; i < kSize * kSize; ++i)
    squares +=
        std::pow(0.5 * static_cast<double>(out.replicate[0][i][1] - out.replicate[1][i][1]), 2.0);
  EXPECT_NEAR(std::sqrt(squares) / kSize / rms(out, 1.0, 0, kSize), 1.0, 0.25);
}

// A shadow edge of ten standard errors stays where it is, on both sides.
TEST(Share, ShadowEdgesStay) {
  const Illumination in = noisy([](int x, int) { return x < kSize / 2 ? 1.0f : 2.0f; }, 0.1f);
  const Illumination out = share_illumination(flat_guides(), in);
  EXPECT_LT(rms(out, 1.0, kSize / 2 - 1, kSize / 2), 0.1);
  EXPECT_LT(rms(out, 2.0, kSize / 2, kSize / 2 + 1), 0.1);
}

// Nothing crosses a corner between two walls or a step in depth, however noisy the light.
TEST(Share, OtherSurfacesAreNotMixed) {
  for (const bool corner : {true, false}) {
    ShareGuides g = flat_guides();
    for (int y = 0; y < kSize; ++y)
      for (int x = kSize / 2; x < kSize; ++x) {
        const auto i = static_cast<std::size_t>(y * kSize + x);
        if (corner) {
          g.normals[0][i] = 1.0f;
          g.normals[2][i] = 0.0f;
        } else {
          g.positions[2][i] = 30.0f;
        }
      }
    const Illumination in = noisy([](int x, int) { return x < kSize / 2 ? 0.0f : 1.0f; }, 1.0f);
    const Illumination out = share_illumination(g, in);
    double left = 0.0, right = 0.0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        (x < kSize / 2 ? left : right) +=
            static_cast<double>(first_half(out, static_cast<std::size_t>(y * kSize + x))[1]);
    const double n = 0.5 * kSize * kSize;
    EXPECT_NEAR(left / n, 0.0, 4.0 / std::sqrt(n)) << corner;  // mean of n independent values
    EXPECT_NEAR(right / n, 1.0, 4.0 / std::sqrt(n)) << corner;
  }
}

}  // namespace
}  // namespace atrium::trace
