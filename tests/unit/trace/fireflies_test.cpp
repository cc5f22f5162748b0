#include "trace/fireflies.h"

#include <gtest/gtest.h>

namespace atrium::trace {
namespace {

constexpr int kSize = 16;

/// A grey picture; with errors: of every pixel.
scene::Image grey(float value, float error) {
  scene::Image image;
  image.width = image.height = kSize;
  image.channels = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
  for (int i = 0; i < kSize * kSize; ++i)
    image.pixels.insert(image.pixels.end(), {value, value, value, error, error, error});
  return image;
}
void set(scene::Image& image, int x, int y, float value, float error) {
  const auto at = static_cast<std::size_t>(y * kSize + x) * 6;
  for (std::size_t c = 0; c < 3; ++c) {
    image.pixels[at + c] = value;
    image.pixels[at + 3 + c] = error;
  }
}

TEST(Fireflies, AnEvenPictureHasNone) { EXPECT_EQ(count_fireflies(grey(1.0f, 0.1f)), 0u); }

// One bright sample: the smoothed layer says a fifth of the pixel's value.
TEST(Fireflies, APixelOfOneBrightSampleIsOne) {
  scene::Image image = grey(1.0f, 0.1f);
  set(image, 8, 8, 20.0f, 4.0f);
  set(image, 0, 15, 20.0f, 4.0f);  // in the corner, too
  EXPECT_EQ(count_fireflies(image), 2u);
}

TEST(Fireflies, WhatIsCertainOrNotFarAboveIsNone) {
  scene::Image image = grey(1.0f, 0.1f);
  set(image, 4, 4, 20.0f, 0.2f);    // a small lamp: all samples agree
  set(image, 8, 8, 4.9f, 1.0f);     // below five times the median
  set(image, 12, 4, 20.0f, 30.0f);  // within its own standard error: noise that is stated
  EXPECT_EQ(count_fireflies(image), 0u);
}

// Half of a 5x5 square: an edge of a lamp is no firefly however unsure.
TEST(Fireflies, EdgesOfLampsAreNone) {
  scene::Image image = grey(1.0f, 0.1f);
  for (int y = 0; y < kSize; ++y)
    for (int x = 8; x < kSize; ++x) set(image, x, y, 100.0f, 20.0f);
  EXPECT_EQ(count_fireflies(image), 0u);
}

TEST(Fireflies, WithoutErrorsNothingIsSaid) {
  scene::Image image = scene::select_channels(grey(1.0f, 0.0f), {"R", "G", "B"});
  image.pixels[(8 * kSize + 8) * 3 + 1] = 100.0f;
  EXPECT_EQ(count_fireflies(image), 0u);
}

TEST(Fireflies, AReferenceTellsLampsFromFireflies) {
  scene::Image reference = grey(1.0f, 0.01f), image = grey(1.0f, 0.1f);
  set(reference, 4, 4, 50.0f, 0.1f);  // a lamp in both
  set(image, 4, 4, 52.0f, 0.1f);
  set(image, 10, 10, 30.0f, 6.0f);  // in one
  EXPECT_EQ(count_fireflies(image, reference), 1u);
  EXPECT_EQ(count_fireflies(scene::select_channels(image, {"R", "G", "B"}), reference), 1u);
  EXPECT_EQ(count_fireflies(reference, image), 0u);
  EXPECT_THROW((void)count_fireflies(image, scene::Image{}), std::invalid_argument);
}

}  // namespace
}  // namespace atrium::trace
