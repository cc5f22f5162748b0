// What a film makes of samples whose indirect light a field knows more or less well.
#include "film.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "picture_error.h"

namespace atrium::trace {
namespace {

constexpr int kSize = 64;
constexpr int kSamples = 8;  // of a pixel

/// A wall, or pixels that have no neighbour of the same surface; light is 1 everywhere.
struct Setting {
  bool wall = true;
  float noise = 0.3f;                    ///< of one sample
  std::function<float(int, int)> field;  ///< what it says of a pixel
};

struct Made {
  double error = 0.0;      ///< RMS of the picture
  ErrorEstimate estimate;  ///< what the film says of it
};

Made picture(const Setting& setting, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0f, setting.noise);
  Film film(kSize, kSize, {.shares = true});
  const material::SpectralBasis basis = material::SpectralBasis::grey();
  scene::Counters counters;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (std::size_t k = 0; k < kSamples; ++k) {
        const float light = 1.0f + normal(random), field = setting.field(x, y);
        PixelSample<1> s;
        s[Term::IndirectReflection] = Spectrum<1>(light);
        s.body_indirect = Spectrum<1>(light - field);
        s.body_field = Spectrum<1>(field);
        s.body_albedo = s.albedo = Spectrum<1>(0.5f);
        s.position = {static_cast<float>(x), static_cast<float>(y), 0.0f};
        s.normal = Vec3f::UnitZ();
        if (!setting.wall) s.position.z() = 1000.0f * static_cast<float>(x + kSize * y);
        s.depth = 50.0f;
        film.add(x, y, k % kReplicates, s, basis, counters);
      }
  const PictureSamples samples = film.develop();
  double squares = 0.0;
  for (const Rgb& pixel : samples.mean)
    squares += std::pow(static_cast<double>(pixel[1]) - 1.0, 2.0);
  return {std::sqrt(squares / (kSize * kSize)), estimate_error(samples)};
}

/// RMS over some seeds: of the error, and of what is said of it.
std::pair<double, double> found_and_stated(const Setting& setting) {
  constexpr unsigned kSeeds = 8;
  double found = 0.0, stated = 0.0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Made made = picture(setting, seed);
    found += made.error * made.error / kSeeds;
    stated += made.estimate.value * made.estimate.value / kSeeds;
  }
  constexpr double kScale = 1.05;  // light 1 and a twentieth of the median (error_scale.h)
  return {std::sqrt(found), kScale * std::sqrt(stated)};
}

/// What every element of 3x3 pixels is wrong by.
std::function<float(int, int)> elements(float sigma) {
  return [sigma](int x, int y) {
    std::mt19937 random(static_cast<unsigned>(x / 3 + 1000 * (y / 3)));
    random.discard(10);
    return 1.0f + std::normal_distribution<float>(0.0f, sigma)(random);
  };
}

const double kOwn = 0.3 / std::sqrt(double{kSamples});  // what a pixel's own samples have

// A tenth of the field's noise would be left if what it lacks were shared among few neighbours.
TEST(FilmShare, NoiseOfElementsIsNotSeenOnAWall) {
  const auto [found, stated] = found_and_stated({.field = elements(0.1f)});
  EXPECT_LT(found, 0.15 * kOwn);
  EXPECT_LT(found, 0.2 * 0.1);
  EXPECT_LT(found, 1.2 * stated);
}

TEST(FilmShare, FieldIsEnoughWhereItIsRightAndNothingHasNeighbours) {
  const auto [found, stated] = found_and_stated({.wall = false, .field = elements(0.01f)});
  EXPECT_LT(found, 0.4 * kOwn);
  EXPECT_LT(found, 1.2 * stated);
}

TEST(FilmShare, FieldIsNotTakenWhereItIsWrong) {
  const auto [found, stated] = found_and_stated({.wall = false, .field = elements(0.5f)});
  EXPECT_NEAR(found / kOwn, 1.0, 0.1);
  EXPECT_NEAR(stated / kOwn, 1.0, 0.1);
}

// What is chosen because it looks best must not be judged by what made it look so.
TEST(FilmShare, ErrorIsTheOneStatedWhereFieldAndSamplesAreAlike) {
  for (const float sigma : {0.05f, 0.1f, 0.15f}) {
    const auto [found, stated] = found_and_stated({.wall = false, .field = elements(sigma)});
    EXPECT_NEAR(found / stated, 1.0, 0.08) << sigma;
    EXPECT_LT(found, 1.1 * std::min(kOwn, static_cast<double>(sigma))) << sigma;
  }
}

}  // namespace
}  // namespace atrium::trace
