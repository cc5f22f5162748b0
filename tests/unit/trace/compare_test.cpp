#include "trace/compare.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using atrium::scene::Image;
using atrium::trace::compare;
using atrium::trace::Comparison;
using atrium::trace::difference_image;

Image flat(int width, int height, float value, bool with_noise = false, float noise = 0.0f) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = {"R", "G", "B"};
  if (with_noise) image.channels.insert(image.channels.end(), {"stderr.R", "stderr.G", "stderr.B"});
  const std::size_t n = image.channels.size();
  image.pixels.assign(image.pixel_count() * n, value);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (i % n >= 3) image.pixels[i] = noise;
  }
  return image;
}

// R = 2 everywhere: Y5 = median = 2, so the scale is 2 + 0.05 * 2 = 2.1. I = 2.21: e = 0.1 in every
// pixel, channel and block; the bias of the mean is 2.21 / 2 - 1 = 0.105.
TEST(Compare, UniformOffset) {
  const Comparison c = compare(flat(24, 16, 2.21f), flat(24, 16, 2.0f));
  EXPECT_NEAR(c.pixel.value, 0.1, 1e-6);
  EXPECT_NEAR(c.block.value, 0.1, 1e-6);
  EXPECT_NEAR(c.max_abs, 0.1, 1e-6);
  EXPECT_NEAR(c.bias, 0.105, 1e-6);
  EXPECT_FALSE(c.noise_known);
  EXPECT_EQ(c.pixels, 24u * 16u);
}

// One red value off by 1 in a 3x3 image of 1: Y5 = 1 everywhere (the window is cut at the border),
// scale 1.05, e = 1/1.05 in one of 27 values.
TEST(Compare, OnePixelAndTheBorderWindow) {
  Image image = flat(3, 3, 1.0f);
  image.pixels[4 * 3] = 2.0f;
  const Comparison c = compare(image, flat(3, 3, 1.0f));
  EXPECT_NEAR(c.pixel.value, 1.0 / 1.05 / std::sqrt(27.0), 1e-7);
  // The one block is the mean of 9 pixels: e = (1/9)/1.05 in one of 3 channels.
  EXPECT_NEAR(c.block.value, 1.0 / 9.0 / 1.05 / std::sqrt(3.0), 1e-7);
  EXPECT_NEAR(difference_image(image, flat(3, 3, 1.0f)).pixels[12], 1.0 / 1.05, 1e-6);
}

// A 6x1 reference 0 0 0 0 0 30: lit median 30, floor 1.5. Windows of +-2: pixel 3 sees {1..5} (mean
// 30/5 = 6), pixel 5 sees {3, 4, 5} (mean 10). I adds 1.5 to all channels of pixel 0 (window
// {0, 1, 2}, mean 0): e = 1. Adding 7.5 to pixel 3: e = 1. Adding 23 to pixel 5: e = 23/11.5 = 2.
TEST(Compare, DarkPixelsHaveTheFloorAndNeighboursCount) {
  Image reference = flat(6, 1, 0.0f);
  for (std::size_t c = 0; c < 3; ++c) reference.pixels[15 + c] = 30.0f;
  Image image = reference;
  for (std::size_t c = 0; c < 3; ++c) {
    image.pixels[c] += 1.5f;
    image.pixels[9 + c] += 7.5f;
    image.pixels[15 + c] += 23.0f;
  }
  const Image e = difference_image(image, reference);
  EXPECT_NEAR(e.pixels[0], 1.0, 1e-5);
  EXPECT_NEAR(e.pixels[9], 1.0, 1e-5);
  EXPECT_NEAR(e.pixels[15], 2.0, 1e-5);
  EXPECT_NEAR(compare(image, reference).pixel.value, std::sqrt((1.0 + 1.0 + 4.0) / 6.0), 1e-5);
}

// R = truth + N(0, s), I = truth + d, truth = 1: as measured RMS^2 is (d^2 + s^2) / 1.05^2, after
// subtraction d / 1.05 per pixel and per block. 192^2 pixels, s = 0.2, d = 0.05: the mean square of
// 110592 values has a relative deviation of sqrt(2 / 110592) = 0.4 %, so d^2 = 0.0025 is known to
// 0.0425 * 0.004 = 1.8e-4, 7 %: d within 4 %. The 5x5 mean adds s^2/25 = 0.16 % to the scale's
// square. Four times that is the tolerance; 95 % intervals may miss: the seed is fixed.
TEST(Compare, NoiseOfTheReferenceIsSubtracted) {
  const int size = 192;
  const double s = 0.2, d = 0.05;
  Image reference = flat(size, size, 1.0f, true, static_cast<float>(s));
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, s);
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    if (i % 6 < 3) reference.pixels[i] += static_cast<float>(normal(random));
  }
  const Comparison c = compare(flat(size, size, static_cast<float>(1.0 + d)), reference);
  ASSERT_TRUE(c.noise_known);
  EXPECT_NEAR(c.pixel.value, d / 1.05, 0.16 * d);
  EXPECT_LT(c.pixel.low, d / 1.05);
  EXPECT_GT(c.pixel.high, d / 1.05);
  EXPECT_NEAR(c.pixel_noise, s / 1.05, 0.01 * s);
  // Block noise s/8 = 0.025 of d = 0.05: 1728 values, d^2 known to (0.003125) sqrt(2/1728) = 4 %.
  EXPECT_NEAR(c.block.value, d / 1.05, 0.08 * d);
  EXPECT_NEAR(c.block_noise, s / 8.0 / 1.05, 0.01 * s / 8.0);
  // Bias: the standard error of a mean of N pixels whose channels share their paths is s / size.
  EXPECT_NEAR(c.bias_error, s / size, 0.01 * s / size);
  EXPECT_NEAR(c.bias, d, 4.0 * c.bias_error);
}

TEST(Compare, EqualImagesBelowTheNoiseGiveZeroWithAnUpperBound) {
  const Image reference = flat(64, 64, 1.0f, true, 0.1f);
  const Comparison c = compare(flat(64, 64, 1.0f), reference);
  EXPECT_DOUBLE_EQ(c.pixel.value, 0.0);
  EXPECT_DOUBLE_EQ(c.pixel.low, 0.0);
}

TEST(Compare, NonFinitePixelsAreSkippedAndCounted) {
  Image image = flat(16, 16, 1.0f);
  image.pixels[5] = std::numeric_limits<float>::quiet_NaN();
  const Comparison c = compare(image, flat(16, 16, 1.0f));
  EXPECT_EQ(c.pixels_skipped, 1u);
  EXPECT_DOUBLE_EQ(c.pixel.value, 0.0);
}

TEST(Compare, ABlackReferenceIsNoDivisionByZeroUnlessTheImageIsLit) {
  EXPECT_DOUBLE_EQ(compare(flat(8, 8, 0.0f), flat(8, 8, 0.0f)).pixel.value, 0.0);
  EXPECT_TRUE(std::isinf(compare(flat(8, 8, 1.0f), flat(8, 8, 0.0f)).pixel.value));
}

// Classes of light paths: the class has 0.5 of 2.0 in the reference and 0.6 in the image, noise 0.3
// and 0.4 in each of 384 pixels: share 0.25, difference 0.05, half width 1.96 sqrt(0.25 / 384) / 2.
// Half the pixels of another one are 1 brighter, half 1 darker: RMS sqrt(1 - 0.25) / 2.
TEST(Compare, ClassesHaveDifferencesWithIntervals) {
  Image image = flat(24, 16, 2.0f), reference = flat(24, 16, 2.0f);
  const auto add = [](Image& i, const std::string& name, float value, float noise, float swing) {
    Image wide = i;
    for (const char* c : {".R", ".G", ".B"}) wide.channels.push_back(name + c);
    wide.channels.push_back("stderr." + name + ".Y");
    wide.pixels.clear();
    const std::size_t stride = i.channels.size();
    for (std::size_t p = 0; p < i.pixel_count(); ++p) {
      wide.pixels.insert(wide.pixels.end(),
                         i.pixels.begin() + static_cast<std::ptrdiff_t>(p * stride),
                         i.pixels.begin() + static_cast<std::ptrdiff_t>((p + 1) * stride));
      const float v = value + (p % 2 == 0 ? swing : -swing);
      wide.pixels.insert(wide.pixels.end(), {v, v, v, noise});
    }
    i = wide;
  };
  add(image, "LDE", 0.6f, 0.3f, 0.0f);
  add(reference, "LDE", 0.5f, 0.4f, 0.0f);
  add(image, "LSDE", 1.4f, 0.3f, 1.0f);
  add(reference, "LSDE", 1.4f, 0.4f, 0.0f);
  const Comparison c = compare(image, reference);
  ASSERT_EQ(c.classes.size(), 2u);
  EXPECT_EQ(c.classes[0].name, "LDE");
  EXPECT_NEAR(c.classes[0].share, 0.25, 1e-6);
  EXPECT_NEAR(c.classes[0].difference, 0.05, 1e-6);
  EXPECT_NEAR(c.classes[0].interval, 1.959964 * std::sqrt(0.25 / 384.0) / 2.0, 1e-6);
  EXPECT_EQ(c.classes[0].rms, 0.0);
  EXPECT_EQ(c.classes[1].name, "LSDE");
  EXPECT_NEAR(c.classes[1].difference, 0.0, 1e-6);
  EXPECT_NEAR(c.classes[1].rms, std::sqrt(0.75) / 2.0, 1e-6);
}

TEST(Compare, DifferentSizesOrMissingChannelsAreRefused) {
  EXPECT_THROW((void)compare(flat(8, 8, 1.0f), flat(8, 9, 1.0f)), std::invalid_argument);
  Image grey = flat(8, 8, 1.0f);
  grey.channels = {"X", "G", "B"};
  EXPECT_THROW((void)compare(grey, flat(8, 8, 1.0f)), std::invalid_argument);
}

}  // namespace
