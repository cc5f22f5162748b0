#include "material/spectral_value.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SampledSpectrum, IsLinearBetweenSamplesAndConstantBeyond) {
  const SampledSpectrum s = make_sampled_spectrum({400.0, 500.0, 520.0}, {1.0, 3.0, -1.0});
  EXPECT_DOUBLE_EQ(s.at(300.0), 1.0);
  EXPECT_DOUBLE_EQ(s.at(400.0), 1.0);
  EXPECT_DOUBLE_EQ(s.at(425.0), 1.5);
  EXPECT_DOUBLE_EQ(s.at(500.0), 3.0);
  EXPECT_DOUBLE_EQ(s.at(515.0), 0.0);
  EXPECT_DOUBLE_EQ(s.at(900.0), -1.0);
}

TEST(SampledSpectrum, RefusesWhatIsNoSpectrum) {
  EXPECT_THROW((void)make_sampled_spectrum({}, {}), std::invalid_argument);
  EXPECT_THROW((void)make_sampled_spectrum({400.0, 500.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_sampled_spectrum({400.0, 400.0}, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_sampled_spectrum({500.0, 400.0}, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_sampled_spectrum({400.0, kNan}, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_sampled_spectrum({400.0, 500.0}, {1.0, kNan}), std::invalid_argument);
}

TEST(SpectralValue, ExtremesAndKindsOfAllThreeForms) {
  const SpectralValue rgb = make_rgb(0.5, -1.0, 2.0);
  EXPECT_DOUBLE_EQ(max_value(rgb), 2.0);
  EXPECT_DOUBLE_EQ(min_value(rgb), -1.0);
  const SpectralValue sampled = make_sampled_spectrum({400.0, 500.0}, {0.25, 0.75});
  EXPECT_DOUBLE_EQ(max_value(sampled), 0.75);
  EXPECT_DOUBLE_EQ(min_value(sampled), 0.25);
  EXPECT_TRUE(is_sampled(sampled));
  EXPECT_FALSE(is_sampled(rgb));
  EXPECT_FALSE(is_achromatic(rgb));
  EXPECT_FALSE(is_achromatic(sampled));
  EXPECT_TRUE(is_achromatic(0.3));
  EXPECT_TRUE(is_achromatic(make_rgb(0.3, 0.3, 0.3)));
  EXPECT_TRUE(is_achromatic(make_sampled_spectrum({400.0, 500.0}, {2.0, 2.0})));
}

// Range checks are written on the extremes, so NaN in any place must come through.
TEST(SpectralValue, ExtremesReportNan) {
  for (int i = 0; i < 3; ++i) {
    Rgb c = make_rgb(0.1, 0.2, 0.3);
    c[i] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(max_value(c)));
    EXPECT_TRUE(std::isnan(min_value(c)));
    EXPECT_FALSE(is_achromatic(c));
  }
  EXPECT_TRUE(std::isnan(max_value(kNan)));
}

}  // namespace
}  // namespace atrium::material
