#include "picture_error.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "error_scale.h"
#include "field_error.h"

namespace atrium::trace {
namespace {

constexpr int kSize = 96;
constexpr std::size_t kPixels = std::size_t{kSize} * kSize;

/// Uniform light of 1 with known noise of the mean and, if anything is shared, a known bias by
/// pixel and the noise that sharing has taken away.
template <class Bias>
PictureSamples synthetic(double sigma, bool shared, double noise_before, Bias&& bias,
                         unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  PictureSamples s;
  s.width = s.height = kSize;
  s.mean.resize(kPixels);
  for (auto& d : s.deviation) d.resize(kPixels);
  if (shared)
    for (auto& half : s.change)
      for (auto& c : half) c.resize(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    s.mean[i] = Rgb(static_cast<float>(1.0 + sigma * normal(random)));
    // Two halves: each has half of the variance.
    for (auto& d : s.deviation)
      d[i] = Rgb(static_cast<float>(sigma * std::sqrt(0.5) * normal(random)));
    if (!shared) continue;
    for (auto& half : s.change)
      for (auto& c : half)
        c[i] = Rgb(static_cast<float>(bias(i) + 2.0 * noise_before * normal(random)));
  }
  return s;
}

// Noise of 3 % of a picture of luminance 1: the scale is 1.05, the error 3 % / 1.05. The estimate
// of the variance has the relative standard error sqrt(2 / 2 n): 1 %; five of them are allowed.
TEST(PictureError, FindsTheNoiseOfReplicates) {
  const ErrorEstimate e = estimate_error(synthetic(
      0.03, false, 0.0, [](std::size_t) { return 0.0; }, 1));
  EXPECT_NEAR(e.value * 1.05 / 0.03, 1.0, 0.03);
  EXPECT_EQ(e.bias, 0.0);
  double sum = 0.0;
  for (const float v : e.noise_squares) sum += static_cast<double>(v);
  EXPECT_NEAR(std::sqrt(sum / kPixels), e.noise, 1e-6);
}

// A bias that a whole region has is found below the noise of single pixels.
TEST(PictureError, FindsTheBiasOfSharing) {
  const auto half_dark = [](std::size_t i) { return i % kSize < kSize / 2 ? -0.02 : 0.0; };
  const double truth = 0.02 / std::sqrt(2.0) / 1.05;
  const ErrorEstimate e = estimate_error(synthetic(0.001, true, 0.04, half_dark, 2));
  EXPECT_NEAR(e.bias / truth, 1.0, 0.15);
  EXPECT_NEAR(e.value, std::hypot(e.noise, e.bias), 1e-9);
}

// Where sharing changes nothing but noise, little bias is claimed: the square has the standard
// error 4 noise^2 / sqrt(2 n) for single pixels, sqrt(25) / 25 of it over squares of 25.
TEST(PictureError, ClaimsNoBiasThatIsNotThere) {
  const ErrorEstimate e = estimate_error(synthetic(
      0.001, true, 0.04, [](std::size_t) { return 0.0; }, 3));
  EXPECT_LT(e.bias, std::sqrt(3.0 * 4.0 * 0.04 * 0.04 / std::sqrt(2.0 * kPixels) / 5.0));
}

// One bright sample in one pixel: its error counts in full although it makes its surroundings
// bright. Mean 1, one pixel of 26 (a bright half of one replicate): the honest scale is 1.05.
TEST(PictureError, ABrightSampleDoesNotHideItself) {
  PictureSamples s = synthetic(
      0.0, false, 0.0, [](std::size_t) { return 0.0; }, 4);
  const std::size_t middle = kPixels / 2 + kSize / 2;
  s.mean[middle] = Rgb(26.0f);
  s.deviation[0][middle] = Rgb(25.0f);
  const ErrorEstimate e = estimate_error(s);
  EXPECT_NEAR(e.value, 25.0 / 1.05 / std::sqrt(static_cast<double>(kPixels)), 0.05 * e.value);
}

// Means of 8x8 pixels with independent noise have an eighth of it; with common noise all of it.
TEST(PictureError, BlocksKeepWhatPixelsHaveInCommon) {
  const PictureSamples s = synthetic(
      0.08, false, 0.0, [](std::size_t) { return 0.0; }, 5);
  const ErrorEstimate blocks = estimate_error(average_blocks(s, 8));
  EXPECT_NEAR(blocks.value * 1.05 / 0.01, 1.0, 0.25);  // 144 blocks: 6 % for one standard error
  PictureSamples common = s;
  for (auto& d : common.deviation) d.assign(kPixels, Rgb(0.03f));
  EXPECT_NEAR(estimate_error(average_blocks(common, 8)).value * 1.05, 0.03 * std::sqrt(2.0), 0.001);
}

/// What checks say where the field has `error` of the light too much: one sample of 32 checks, and
/// paths find rare large values (log-normal).
PictureSamples checked(double error, unsigned seed) {
  constexpr double kWidth = 1.5, kShare = 1.0 / 32.0;
  PictureSamples s = synthetic(
      0.01, false, 0.0, [](std::size_t) { return 0.0; }, seed);
  std::mt19937 random(seed + 1000);
  std::uniform_real_distribution<double> uniform;
  std::lognormal_distribution<double> found(-0.5 * kWidth * kWidth, kWidth);  // mean 1
  for (auto& missed : s.missed) {
    missed.resize(kPixels);
    for (Rgb& m : missed)
      if (uniform(random) < kShare)
        m = Rgb(static_cast<float>((found(random) - (1.0 + error)) / kShare));
  }
  return s;
}

// The question whether the field is too coarse is asked in every round, and the answer yes is dear:
// noise of checks alone hardly ever says so (of 400 pictures 1, with two standard errors 9), what
// is there does.
TEST(PictureError, RareLargeChecksAreNoCertainError) {
  int certain = 0;
  for (unsigned seed = 0; seed < 400; ++seed)
    if (estimate_error(checked(0.0, seed)).least_field > 0.0) ++certain;
  RecordProperty("certain", certain);
  EXPECT_LE(certain, 4);
  const ErrorEstimate wrong = estimate_error(checked(0.8, 7));
  EXPECT_GT(wrong.least_field, 0.2);
  EXPECT_LT(wrong.least_field, 0.8 / 1.05);
}

// The layer's squares, relative to the scale, have the mean that the estimate has.
TEST(PictureError, LayerAndEstimateAgree) {
  const PictureSamples s = synthetic(
      0.05, false, 0.0, [](std::size_t) { return 0.0; }, 6);
  const std::vector<Rgb> layer = error_layer(s);
  std::vector<double> y;
  for (const Rgb& c : s.mean) y.push_back(static_cast<double>(luminance(c)));
  const std::vector<double> scale = error_scales(kSize, kSize, y);
  double sum = 0.0;
  for (std::size_t i = 0; i < kPixels; ++i)
    sum += std::pow(static_cast<double>(layer[i][1]) / scale[i], 2.0);
  EXPECT_NEAR(std::sqrt(sum / kPixels), estimate_error(s).value, 0.03 * 0.05);
}

// The mean of the posterior, against its integrals.
TEST(LikelySquare, IsTheMeanOfItsDistribution) {
  constexpr double kExpected = 0.008, kPrior = kExpected * kExpected;
  for (const double mean : {-4e-4, 0.0, 1e-5, 1e-4, 1.5e-3})
    for (const double error : {1e-6, 3e-5, 5e-4}) {
      const FieldSquare measured{mean, error};
      // From the largest value of the density on, so that nothing underflows.
      const double top = std::max(0.0, mean - error * error / kPrior);
      const auto exponent = [&](double x) {
        return -0.5 * std::pow((x - mean) / error, 2.0) - x / kPrior;
      };
      const double width = std::min(error, top > 0.0 ? error : kPrior);
      double sum = 0.0, first = 0.0;
      for (int i = 0; i < 400000; ++i) {
        const double x = std::max(0.0, top - 20.0 * width) + (i + 0.5) * 1e-4 * width;
        const double density = std::exp(exponent(x) - exponent(top));
        sum += density;
        first += density * x;
      }
      EXPECT_NEAR(likely_square(measured, kExpected) / (first / sum), 1.0, 2e-3)
          << mean << " " << error;
    }
}

TEST(LikelySquare, CertainMeasurementsCountAsTheyAre) {
  EXPECT_NEAR(likely_square({1e-3, 1e-7}, 0.008), 1e-3, 1e-8);
  EXPECT_LT(likely_square({1.5e-3, 5e-4}, 0.008), 2e-4) << "no certainty, no surprise";
  EXPECT_NEAR(likely_square({0.0, 1.0}, 0.008), 6.4e-5, 1e-6) << "what is expected";
  for (const double unknown : {0.0, 1e-3})
    EXPECT_EQ(likely_square({unknown, 5e-4}, std::numeric_limits<double>::infinity()), unknown);
  EXPECT_EQ(likely_square({-1e-3, 5e-4}, std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(likely_square({1e-3, 0.0}, 0.008), 1e-3);
}

}  // namespace
}  // namespace atrium::trace
