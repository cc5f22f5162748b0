#include "trace/tone_map.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using atrium::scene::Image;
using atrium::trace::automatic_ev;
using atrium::trace::filmic_curve;
using atrium::trace::tone_map;
using atrium::trace::ToneMapOptions;

Image grey(int width, int height, float value) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = {"R", "G", "B"};
  image.pixels.assign(image.pixel_count() * 3, value);
  return image;
}

void set_grey(Image& image, std::size_t pixel, float value) {
  for (std::size_t c = 0; c < 3; ++c) image.pixels[pixel * 3 + c] = value;
}

// EV 3: L_max = 1.2 * 8 = 9.6. L = 4.8 is 0.5 linear, sRGB code 1.055 * 0.5^(1/2.4) - 0.055 =
// 0.7354.
TEST(ToneMap, PlainSrgbFollowsExposureAndEncoding) {
  const ToneMapOptions options{.curve = ToneMapOptions::Curve::Srgb, .ev = 3.0};
  EXPECT_NEAR(tone_map(grey(2, 1, 4.8f), options).pixels[0], 0.735357, 1e-5);
  EXPECT_NEAR(tone_map(grey(2, 1, 9.6f), options).pixels[0], 1.0, 1e-5);
  EXPECT_FLOAT_EQ(tone_map(grey(2, 1, 96.0f), options).pixels[0], 1.0f);
  // In the linear toe: 9.6e-3 is 0.001 linear, code 0.01292.
  EXPECT_NEAR(tone_map(grey(2, 1, 9.6e-3f), options).pixels[0], 0.01292, 1e-6);
}

TEST(ToneMap, OneStopMoreHalvesTheLight) {
  const ToneMapOptions at3{.curve = ToneMapOptions::Curve::Srgb, .ev = 3.0};
  const ToneMapOptions at4{.curve = ToneMapOptions::Curve::Srgb, .ev = 4.0};
  EXPECT_NEAR(tone_map(grey(1, 1, 2.0f), at3).pixels[0], tone_map(grey(1, 1, 4.0f), at4).pixels[0],
              1e-6);
}

// The factor 0.72317 solves f(s * 0.18) = 0.18 to 5 digits.
TEST(FilmicCurve, KeepsMiddleGreyAndIncreasesFromZeroToOne) {
  EXPECT_DOUBLE_EQ(filmic_curve(0.0), 0.0);
  EXPECT_NEAR(filmic_curve(0.18), 0.18, 1e-5);
  double last = 0.0;
  for (int i = 1; i < 200; ++i) {
    const double y = filmic_curve(0.05 * i);
    EXPECT_GE(y, last);
    EXPECT_LE(y, 1.0);
    last = y;
  }
  EXPECT_DOUBLE_EQ(filmic_curve(1e9), 1.0);
}

// A uniform image of luminance L is mapped to middle grey: 2^ev * 1.2 * 0.18 = L.
TEST(AutomaticEv, PutsAUniformImageAtMiddleGrey) {
  const Image image = grey(10, 10, 54.0f);
  EXPECT_NEAR(std::exp2(automatic_ev(image)) * 1.2 * 0.18, 54.0, 1e-4);
  const Image shown = tone_map(image, {.curve = ToneMapOptions::Curve::Srgb, .ev = {}});
  EXPECT_NEAR(shown.pixels[0], 1.055 * std::pow(0.18, 1.0 / 2.4) - 0.055, 1e-5);
}

TEST(AutomaticEv, LampsInViewDarkCornersAndBrokenPixelsDoNotDecide) {
  Image image = grey(10, 10, 54.0f);
  const double ev = automatic_ev(image);
  for (std::size_t i = 0; i < 4; ++i) set_grey(image, i, 1e7f);     // 4 % lamps
  for (std::size_t i = 10; i < 25; ++i) set_grey(image, i, 1e-4f);  // 15 % nearly black
  for (std::size_t i = 30; i < 60; ++i) set_grey(image, i, 0.0f);   // background
  image.pixels[99 * 3] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[98 * 3] = std::numeric_limits<float>::infinity();
  // The lit pixels are now 68: 15 dark (22 %), 49 of 54, 4 lamps (5.9 %). What is left over of dark
  // and lamps after cutting 20 % below and 5 % above are 2 and 0 pixels of 51.
  const double shift = (2.0 * std::log2(1e-4 / 54.0)) / 51.0;
  EXPECT_NEAR(automatic_ev(image), ev + shift, 1e-3);
  EXPECT_GT(automatic_ev(image), ev - 1.0);
}

TEST(AutomaticEv, BlackImageIsNoError) {
  EXPECT_DOUBLE_EQ(automatic_ev(grey(4, 4, 0.0f)), 0.0);
  EXPECT_FLOAT_EQ(tone_map(grey(4, 4, 0.0f)).pixels[0], 0.0f);
}

TEST(ToneMap, NonFinitePixelsBecomeBlackAndMissingChannelsAreRefused) {
  Image image = grey(2, 1, 1.0f);
  image.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[1] = std::numeric_limits<float>::infinity();
  const Image shown = tone_map(image, {.ev = 0.0});
  EXPECT_FLOAT_EQ(shown.pixels[0], 0.0f);
  EXPECT_FLOAT_EQ(shown.pixels[1], 0.0f);
  EXPECT_GT(shown.pixels[2], 0.0f);
  image.channels = {"Y", "G", "B"};
  EXPECT_THROW((void)tone_map(image), std::invalid_argument);
}

}  // namespace
