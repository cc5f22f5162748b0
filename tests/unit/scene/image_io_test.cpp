#include "scene/image_io.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "material/error.h"
#include "support/temp_folder.h"

namespace {

using atrium::Error;
using atrium::scene::Image;
using atrium::scene::read_image;
using atrium::scene::write_image;
using atrium::test::TempFolder;

#define ATRIUM_NEEDS_MODULE() \
  if (!atrium::scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO"

/// Every value of every channel is another one.
Image sample_image(std::vector<std::string> channels, int width = 5, int height = 3) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = std::move(channels);
  for (std::size_t i = 0; i < image.pixel_count() * image.channels.size(); ++i) {
    image.pixels.push_back(0.37f * static_cast<float>(i) - 1.25f);
  }
  return image;
}

// Channels come back in another order than they were written in, so the names decide.
void expect_same(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    const int other = b.channel_index(a.channels[c]);
    ASSERT_GE(other, 0) << a.channels[c];
    for (int y = 0; y < a.height; ++y) {
      for (int x = 0; x < a.width; ++x) {
        EXPECT_EQ(a.at(x, y, static_cast<int>(c)), b.at(x, y, other)) << a.channels[c];
      }
    }
  }
}

TEST(ImageIo, ExrKeepsFloatsNamesAndMetadata) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  Image image = sample_image({"R", "G", "B", "normal.X", "C1.R", "depth.Z", "albedo.B"});
  image.metadata = {{"atrium:unit", "nit"}, {"atrium:command", "atrium render a.glb -o b.exr"}};
  write_image(image, folder / "a.exr");
  const Image back = read_image(folder / "a.exr");
  expect_same(image, back);
  EXPECT_EQ(back.metadata.at("atrium:unit"), "nit");
  EXPECT_EQ(back.metadata.at("atrium:command"), "atrium render a.glb -o b.exr");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(ImageIo, PfmIsExactAndUpright) {
  const TempFolder folder;
  const Image image = sample_image({"R", "G", "B"});
  write_image(image, folder / "a.pfm");
  expect_same(image, read_image(folder / "a.pfm"));
  // By the format's definition the first row of the file is the lowest: header "PF\n5 3\n-1.0\n".
  std::ifstream in(folder / "a.pfm", std::ios::binary);
  in.seekg(12);
  float first = 0.0f;
  in.read(reinterpret_cast<char*>(&first), sizeof first);
  EXPECT_EQ(first, image.at(0, 2, 0));
}

TEST(ImageIo, PfmOfBigEndianMachinesAndBrokenHeaders) {
  const TempFolder folder;
  folder.write("big.pfm",
               std::string("Pf\n1 1\n1.0\n") + std::string("\x40\x20\x00\x00", 4));  // 2.5
  EXPECT_EQ(read_image(folder / "big.pfm").pixels.at(0), 2.5f);
  folder.write("huge.pfm", "PF\n60000 60000\n-1.0\nabc");
  folder.write("zero.pfm", "PF\n0 3\n-1.0\n");
  folder.write("text.pfm", "hello");
  for (const char* name : {"huge.pfm", "zero.pfm", "text.pfm"}) {
    EXPECT_THROW((void)read_image(folder / name), Error) << name;
  }
}

// RGBE shares one exponent and has 8 bits each: 1/128 of the largest channel.
TEST(ImageIo, HdrKeepsAHighRange) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  Image image = sample_image({"R", "G", "B"}, 16, 4);
  for (float& v : image.pixels) v = std::exp2(v);
  write_image(image, folder / "a.hdr");
  const Image back = read_image(folder / "a.hdr");
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    const float largest = std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(back.pixels[i + c], image.pixels[i + c], largest / 128.0f);
    }
  }
}

// Display values are written as they are, 8 bits; reading decodes sRGB: code 0.5 (128/255) is
// ((0.50196 + 0.055) / 1.055)^2.4 = 0.21586.
TEST(ImageIo, PngAndJpegHoldDisplayValues) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  Image image = sample_image({"R", "G", "B"}, 16, 16);
  std::fill(image.pixels.begin(), image.pixels.end(), 128.0f / 255.0f);
  for (const char* name : {"a.png", "a.jpg"}) {
    write_image(image, folder / name);
    const Image back = read_image(folder / name);
    ASSERT_EQ(back.channels.size(), 3u);
    EXPECT_NEAR(back.pixels[100], 0.21586f, 1e-4f) << name;
  }
}

TEST(ImageIo, ExtraChannelsStayOutOfPlainFormatsAndMissingOnesAreErrors) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  write_image(sample_image({"depth.Z", "B", "G", "R"}), folder / "a.pfm");
  EXPECT_EQ(read_image(folder / "a.pfm").channels.size(), 3u);
  EXPECT_THROW(write_image(sample_image({"Y"}), folder / "b.png"), Error);
  EXPECT_THROW(write_image(sample_image({"R", "G", "B"}), folder / "b.xyz"), Error);
  EXPECT_THROW(write_image(sample_image({"R", "G", "B"}), folder / "none/b.exr"), Error);
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(ImageIo, TexturesFromMemoryKeepBytesAndUnmultipliedAlpha) {
  ATRIUM_NEEDS_MODULE();
  // A 2x1 RGBA PNG: (200, 100, 50, 128), (10, 20, 30, 0). Alpha must not darken the colours.
  const std::vector<std::uint8_t> png = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
      0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4,
      0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00, 0x11, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x38,
      0x91, 0x62, 0xd4, 0xc0, 0x25, 0x22, 0xc7, 0x00, 0x00, 0x0d, 0x51, 0x02, 0x1b, 0xb2, 0x47,
      0x23, 0x35, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const auto texture = atrium::scene::decode_texture(png, "embedded image 3");
  ASSERT_EQ(texture.width, 2);
  ASSERT_EQ(texture.height, 1);
  ASSERT_EQ(texture.channels, 4);
  EXPECT_EQ(texture.pixels, (std::vector<std::uint8_t>{200, 100, 50, 128, 10, 20, 30, 0}));
}

TEST(ImageIo, BrokenImagesAreErrorsOfOneLine) {
  ATRIUM_NEEDS_MODULE();
  const TempFolder folder;
  folder.write("a.png", "not a picture");
  folder.write("empty.exr", "");
  for (const char* name : {"a.png", "empty.exr", "missing.png"}) {
    try {
      (void)read_image(folder / name);
      FAIL() << name;
    } catch (const Error& e) {
      const std::string message = e.what();
      EXPECT_EQ(message.find((folder / name).string()), 0u) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  EXPECT_THROW((void)atrium::scene::decode_texture({1, 2, 3}, "x"), Error);
  EXPECT_THROW((void)atrium::scene::decode_texture({}, "x"), Error);
}

}  // namespace
