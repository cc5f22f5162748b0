#include "material/texture.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "material/material.h"

namespace atrium::material {
namespace {

// 2 x 2 grey, linear: 0 51 / 102 255 (0, 0.2, 0.4, 1).
Texture small(Texture::Wrap wrap) {
  Texture t;
  t.width = t.height = 2;
  t.channels = 1;
  t.srgb = false;
  t.pixels = {0, 51, 102, 255};
  t.wrap_u = t.wrap_v = wrap;
  return t;
}

TEST(Texture, IsBilinearBetweenPixelCentresFromTheTopLeft) {
  const Texture t = small(Texture::Wrap::Clamp);
  EXPECT_NEAR(t.rgb({0.25f, 0.25f})[0], 0.0f, 1e-6f);
  EXPECT_NEAR(t.rgb({0.75f, 0.25f})[1], 0.2f, 1e-6f);
  EXPECT_NEAR(t.rgb({0.25f, 0.75f})[2], 0.4f, 1e-6f);
  EXPECT_NEAR(t.rgb({0.5f, 0.5f})[0], 0.4f, 1e-6f);      // mean of the four
  EXPECT_NEAR(t.rgb({0.375f, 0.25f})[0], 0.05f, 1e-6f);  // a quarter of the way
}

TEST(Texture, WrapsAsAsked) {
  const Texture repeat = small(Texture::Wrap::Repeat);
  EXPECT_NEAR(repeat.rgb({0.0f, 0.25f})[0], 0.1f, 1e-6f);  // between the two columns, over the edge
  EXPECT_NEAR(repeat.rgb({-2.25f, 5.25f})[0], 0.2f, 1e-5f);
  const Texture clamp = small(Texture::Wrap::Clamp);
  EXPECT_NEAR(clamp.rgb({-3.0f, 0.25f})[0], 0.0f, 1e-6f);
  EXPECT_NEAR(clamp.rgb({7.0f, 9.0f})[0], 1.0f, 1e-6f);
  const Texture mirror = small(Texture::Wrap::Mirror);
  for (const float u : {0.1f, 0.3f, 0.62f, 0.9f}) {
    EXPECT_NEAR(mirror.rgb({-u, 0.25f})[0], mirror.rgb({u, 0.25f})[0], 1e-6f);
    EXPECT_NEAR(mirror.rgb({2.0f - u, 0.25f})[0], mirror.rgb({u, 0.25f})[0], 1e-6f);
    EXPECT_NEAR(mirror.rgb({2.0f + u, 0.25f})[0], mirror.rgb({u, 0.25f})[0], 1e-5f);
  }
}

TEST(Texture, AnyCoordinateReadsInsideTheImage) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto wrap : {Texture::Wrap::Repeat, Texture::Wrap::Mirror, Texture::Wrap::Clamp}) {
    const Texture t = small(wrap);
    for (const float u : {0.0f, 1.0f, -1e-9f, 0.99999994f, 1e30f, -3.4e38f, 1e-38f}) {
      const float v = t.rgb({u, u})[0];
      EXPECT_TRUE(v >= 0.0f && v <= 1.0f) << u;
    }
    for (const float u : {inf, -inf, nan}) EXPECT_EQ(t.rgb({u, 0.3f}), t.rgb({0.0f, 0.0f}));
  }
}

// IEC 61966-2-1; interpolation happens after decoding, so a half-way point is the linear mean.
TEST(Texture, DecodesSrgbBeforeInterpolating) {
  Texture t;
  t.width = 2;
  t.height = 1;
  t.channels = 3;
  t.pixels = {0, 10, 188, 255, 10, 188};
  t.wrap_u = t.wrap_v = Texture::Wrap::Clamp;
  EXPECT_NEAR(t.rgb({0.5f, 0.5f})[0], 0.5f, 1e-6f);
  EXPECT_NEAR(t.rgb({0.1f, 0.5f})[1], 10.0f / 255.0f / 12.92f, 1e-7f);
  EXPECT_NEAR(t.rgb({0.1f, 0.5f})[2], std::pow((188.0 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_NEAR(t.channel({0.1f, 0.5f}, 2), 188.0f / 255.0f, 1e-6f);  // never decoded
  EXPECT_EQ(t.channel({0.1f, 0.5f}, 3), 1.0f);
  EXPECT_EQ(t.channel({0.1f, 0.5f}, 4), 0.0f);
  const Rgb mean = t.mean_rgb();
  EXPECT_NEAR(mean[0], 0.5f, 1e-6f);
  EXPECT_NEAR(mean[1], t.rgb({0.1f, 0.5f})[1], 1e-7f);
}

TEST(Texture, GreyWithAlphaRepeatsGreyAndKeepsAlpha) {
  Texture t;
  t.width = t.height = 1;
  t.channels = 2;
  t.srgb = false;
  t.pixels = {51, 204};
  EXPECT_EQ(t.rgb({0.3f, 0.3f}), Rgb(0.2f));
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(t.channel({0.3f, 0.3f}, i), 0.2f);
  EXPECT_FLOAT_EQ(t.channel({0.3f, 0.3f}, 3), 0.8f);
  EXPECT_EQ(t.mean_rgb(), Rgb(0.2f));
}

// uv' = offset + R(scale * uv). With v down, counter-clockwise takes u (right) to -v (up).
TEST(TextureSlot, TransformsInTheOrderScaleRotateOffset) {
  TextureSlot slot;
  EXPECT_EQ(slot.transform({0.3f, 0.4f}), Vec2f(0.3f, 0.4f));
  slot.scale = {2.0f, 3.0f};
  slot.offset = {0.5f, -1.0f};
  EXPECT_LT((slot.transform({1.0f, 1.0f}) - Vec2f(2.5f, 2.0f)).norm(), 1e-6f);
  slot.rotation = 0.5f * std::numbers::pi_v<float>;
  EXPECT_LT((slot.transform({1.0f, 0.0f}) - Vec2f(0.5f, -3.0f)).norm(), 1e-6f);
  EXPECT_LT((slot.transform({0.0f, 1.0f}) - Vec2f(3.5f, -1.0f)).norm(), 1e-6f);
}

}  // namespace
}  // namespace atrium::material
