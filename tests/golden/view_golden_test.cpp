// Pictures of the viewer against stored ones, drawn by software. What a picture of view/ shows is
// changed by ATRIUM_UPDATE_GOLDEN=1 build/release/bin/view_golden_test, after looking at it.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "scene/image_io.h"
#include "support/run_program.h"
#include "support/view_room.h"
#include "support/virtual_display.h"

namespace {

using atrium::scene::Image;
using atrium::scene::read_image;
using atrium::test::run_command;
using atrium::test::TempFolder;
using atrium::test::ViewRoom;

namespace fs = std::filesystem;

const fs::path kStored = fs::path(ATRIUM_SOURCE_DIR) / "tests/golden/view";

/// 8 bits as the eye has them: linear values make dark differences vanish.
double display(const Image& image, std::size_t i) {
  return std::pow(std::max(0.0, static_cast<double>(image.pixels[i])), 1.0 / 2.2);
}

/// Share of pixels that differ by more than 1/8 of the whole range in a channel, and the mean
/// difference as a share of it. 1 for images of different sizes.
struct Difference {
  double pixels = 1.0, mean = 1.0;
  /// Other versions of the rasteriser and of the font library move pixels at edges: 0.5 % of them
  /// may change (a line of contour at 160 x 120 has 1 % and more), by 0.4 % on average.
  [[nodiscard]] bool acceptable() const { return pixels <= 0.005 && mean <= 0.004; }
};

Difference difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return {};
  const std::size_t channels = a.channels.size();
  Difference d{0.0, 0.0};
  for (std::size_t p = 0; p < a.pixel_count(); ++p) {
    double largest = 0.0;
    for (std::size_t c = 0; c < std::min<std::size_t>(3, channels); ++c) {
      const double e = std::abs(display(a, p * channels + c) - display(b, p * channels + c));
      largest = std::max(largest, e);
      d.mean += e / 3.0;
    }
    d.pixels += largest > 0.125 ? 1.0 : 0.0;
  }
  d.pixels /= static_cast<double>(a.pixel_count());
  d.mean /= static_cast<double>(a.pixel_count());
  return d;
}

/// White where they are the same.
Image difference_image(const Image& a, const Image& b) {
  Image d = a;
  for (std::size_t i = 0; i < d.pixels.size() && i < b.pixels.size(); ++i)
    d.pixels[i] = static_cast<float>(1.0 - std::abs(display(a, i) - display(b, i)));
  return d;
}

class ViewGolden : public testing::Test {
 protected:
  void SetUp() override {
    ATRIUM_NEEDS_DISPLAY();
    atrium::scene::write_polygon_mesh(ViewRoom::mesh(), folder / "room.vtp");
  }

  Image picture(const std::string& name, const std::string& options) {
    const bool placed = options.find("--camera") != std::string::npos;
    const auto r = run_command(
        folder, std::string(ATRIUM_VIEW_PROGRAM) + " room.vtp --size 160x120 --screenshot " + name +
                    ".png " + options + (placed ? "" : " --camera 5.5,4,6:1.6,0.7,1.2:40"));
    EXPECT_EQ(r.code, 0) << r.err;
    return r.code == 0 ? read_image(folder / (name + ".png")) : Image{};
  }

  void expect_stored(const std::string& name, const std::string& options) {
    const Image image = picture(name, options);
    const fs::path stored = kStored / (name + ".png");
    if (std::getenv("ATRIUM_UPDATE_GOLDEN") != nullptr) {
      fs::copy_file(folder / (name + ".png"), stored, fs::copy_options::overwrite_existing);
      return;
    }
    const Image reference = read_image(stored);
    const Difference d = difference(image, reference);
    EXPECT_TRUE(d.acceptable()) << name << ": " << 100.0 * d.pixels << " % of the pixels, mean "
                                << 100.0 * d.mean << " %; " << keep(name, image, reference);
  }

  /// Writes image and difference where they stay.
  std::string keep(const std::string& name, const Image& image, const Image& reference) {
    const fs::path place = fs::temp_directory_path() / "atrium-view-golden";
    fs::create_directories(place);
    fs::copy_file(folder / (name + ".png"), place / (name + ".png"),
                  fs::copy_options::overwrite_existing);
    if (image.pixels.size() == reference.pixels.size())
      atrium::scene::write_image(difference_image(image, reference),
                                 place / (name + "-difference.png"));
    return "see " + (place / (name + ".png")).string() + " and -difference.png";
  }

  TempFolder folder;
};

const std::string kLux = "--field illuminance --range 0,600 ";

TEST_F(ViewGolden, TrueColour) { expect_stored("true_colour", "--exposure 4.5"); }
TEST_F(ViewGolden, Illuminance) { expect_stored("illuminance", kLux); }
TEST_F(ViewGolden, Logarithmic) {
  expect_stored("logarithmic", "--field illuminance --log --range 10,1000");
}
TEST_F(ViewGolden, ContoursWithLabels) {
  expect_stored("contours", kLux + "--contours 100,200,300,400");
}
TEST_F(ViewGolden, FlatWithEdges) { expect_stored("flat_edges", kLux + "--flat --edges"); }
TEST_F(ViewGolden, Back) {
  expect_stored("back",
                "--field illuminance --range 0,60 --camera -1.5,-2,-2:2,1,1.5:60 --no-legend");
}
TEST_F(ViewGolden, Error) { expect_stored("error", "--field error --range 0,16"); }
TEST_F(ViewGolden, Objects) { expect_stored("objects", "--field object"); }
TEST_F(ViewGolden, Clipped) { expect_stored("clipped", kLux + "--clip 'y<1.2' --clip 'x>0.8'"); }
TEST_F(ViewGolden, Weights) { expect_stored("weights", kLux + "--weights lamp=0.2"); }
TEST_F(ViewGolden, Plan) { expect_stored("plan", kLux + "--contours 5 --camera plan"); }

// What the comparison is for: each of these is another picture.
TEST_F(ViewGolden, ComparisonSeesWhatMatters) {
  const std::string look = kLux + "--contours 200,300,400 ";
  const Image image = picture("a", look);
  EXPECT_TRUE(difference(image, picture("same", look)).acceptable());
  for (const auto& [what, options] :
       {std::pair{"colours", "--field illuminance --range 0,700 --contours 200,300,400"},
        std::pair{"a contour is missing", "--field illuminance --range 0,600 --contours 200,300"},
        std::pair{"contours are elsewhere",
                  "--field illuminance --range 0,600 --contours 200,320,400"},
        std::pair{"camera",
                  "--field illuminance --range 0,600 --contours 200,300,400 --camera "
                  "5.6,4,6:1.6,0.7,1.2:40"},
        std::pair{"side", "--field illuminance --range 0,600 --contours 200,300,400 --side back"},
        std::pair{"legend",
                  "--field illuminance --range 0,600 --contours 200,300,400 --no-legend"}})
    EXPECT_FALSE(difference(image, picture("b", options)).acceptable()) << what;
}

}  // namespace
