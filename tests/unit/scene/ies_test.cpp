#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/luminaire.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path_(std::filesystem::path(testing::TempDir()) / ("atrium_ies_" + name)) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string message_of(const std::string& name, const std::string& text) {
  const TemporaryFile file(name, text);
  try {
    (void)read_ies(file.path());
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

// Midpoint rule over the sphere: an independent way to the flux.
double flux_by_sampling(const IntensityProfile& profile, int steps) {
  double sum = 0.0;
  for (int t = 0; t < steps; ++t) {
    const double theta = (t + 0.5) / steps * kPi;
    for (int p = 0; p < steps; ++p) {
      sum += profile.at(theta * 180.0 / kPi, (p + 0.5) / steps * 360.0) * std::sin(theta);
    }
  }
  return sum * kPi / steps * 2.0 * kPi / steps;
}

TEST(IntensityProfile, ConstantIsFourPi) {
  const IntensityProfile profile{{0.0, 45.0, 180.0}, {0.0}, {7.0, 7.0, 7.0}};
  EXPECT_NEAR(profile.flux(), 4.0 * kPi * 7.0, 1e-12);
  EXPECT_EQ(profile.at(90.0, 123.0), 7.0);
}

// I = theta on [0, pi/2]: the integral of theta sin(theta) is 1, times 2 pi.
TEST(IntensityProfile, LinearTableIsIntegratedExactly) {
  const IntensityProfile profile{{0.0, 90.0}, {0.0}, {0.0, kPi / 2.0}};
  EXPECT_NEAR(profile.flux(), 2.0 * kPi, 1e-12);
  EXPECT_EQ(profile.at(90.1, 0.0), 0.0);
  EXPECT_EQ(profile.at(std::nan(""), 0.0), 0.0);
}

TEST(IntensityProfile, BilinearInBothAngles) {
  const IntensityProfile profile{{0.0, 90.0}, {0.0, 180.0, 360.0}, {1, 1, 3, 5, 1, 1}};
  EXPECT_NEAR(profile.at(45.0, 90.0), 0.25 * (1 + 1 + 3 + 5), 1e-12);
  EXPECT_NEAR(profile.at(45.0, -90.0), profile.at(45.0, 270.0), 1e-12);
  EXPECT_NEAR(profile.at(45.0, 450.0), profile.at(45.0, 90.0), 1e-12);
  // Midpoint rule with n^2 cells: the relative error is about 1/n^2.
  EXPECT_NEAR(flux_by_sampling(profile, 400) / profile.flux(), 1.0, 1e-4);
}

const std::filesystem::path kFolder = std::filesystem::path(ATRIUM_SOURCE_DIR) / "../shared/ies";

struct Expected {
  const char* file;
  double flux;
};
class IesFiles : public testing::TestWithParam<Expected> {};

TEST_P(IesFiles, FluxWithinOnePercent) {
  const std::filesystem::path file = kFolder / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no file " << GetParam().file;
  const IntensityProfile profile = read_ies(file).profile;
  EXPECT_NEAR(profile.flux() / GetParam().flux, 1.0, 0.01);
  EXPECT_NEAR(flux_by_sampling(profile, 720) / profile.flux(), 1.0, 0.003);
}
INSTANTIATE_TEST_SUITE_P(Shared, IesFiles,
                         testing::Values(Expected{"ledalite_examp1.ies", 5296.7},
                                         Expected{"bega_50277.ies", 13773.0},
                                         Expected{"nvidia_rimlight.ies", 18.8},
                                         // 1.10001 is its file generation type
                                         Expected{"babylon_lm63_2019.ies", 9624.8 / 1.10001},
                                         Expected{"own_cosine_lm63_2002.ies", 3141.1},
                                         Expected{"own_1986_tilt_include.ies", 2514.1}));

// The file's table is 2000 exp(-(V/25)^2 - (H/40)^2) cd over V, H in degrees, type B.
TEST(Ies, TypeBKeepsFluxAndAxis) {
  const std::filesystem::path file = kFolder / "own_type_b_flood.ies";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no file own_type_b_flood.ies";
  const IntensityProfile profile = read_ies(file).profile;
  double flux = 0.0;  // d omega = cos(H) dH dV on the grid's own bilinear table
  const auto table = [](double x, double width) {
    const double low = std::floor(x / 10.0) * 10.0;
    const double t = (x - low) / 10.0;
    const auto f = [&](double y) { return std::exp(-(y / width) * (y / width)); };
    return (1.0 - t) * f(low) + t * f(low + 10.0);
  };
  for (double v = -89.75; v < 90.0; v += 0.5) {
    for (double h = -89.75; h < 90.0; h += 0.5) {
      flux += 2000.0 * table(v, 25.0) * table(h, 40.0) * std::cos(h * kPi / 180.0);
    }
  }
  flux *= std::pow(0.5 * kPi / 180.0, 2);
  EXPECT_NEAR(profile.flux() / flux, 1.0, 0.005);
  EXPECT_NEAR(profile.at(0.0, 0.0), 2000.0, 1.0);
  EXPECT_NEAR(profile.at(20.0, 0.0), 2000.0 * std::exp(-0.25), 2.0);   // H = 20, along x
  EXPECT_NEAR(profile.at(20.0, 90.0), 2000.0 * std::exp(-0.64), 2.0);  // V = 20, along y
  EXPECT_EQ(profile.at(120.0, 10.0), 0.0);
}

std::string type_c(const std::string& horizontal, int count, const std::string& candela) {
  return "IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n1 -1 1 2 " + std::to_string(count) +
         " 1 2 0 0 0\n1 1 10\n0 90\n" + horizontal + "\n" + candela + "\n";
}

TEST(Ies, SymmetriesUnfold) {
  const TemporaryFile quadrant("quadrant.ies", type_c("0 90", 2, "1 1 5 5"));
  const IntensityProfile q = read_ies(quadrant.path()).profile;
  for (const double phi : {45.0, 135.0, 225.0, 315.0}) EXPECT_NEAR(q.at(30.0, phi), 3.0, 1e-12);
  EXPECT_NEAR(q.at(30.0, 270.0), 5.0, 1e-12);

  const TemporaryFile half("half.ies", type_c("0 90 180", 3, "1 1 5 5 9 9"));
  const IntensityProfile h = read_ies(half.path()).profile;
  EXPECT_NEAR(h.at(30.0, 135.0), 7.0, 1e-12);
  EXPECT_NEAR(h.at(30.0, 225.0), 7.0, 1e-12);
  EXPECT_NEAR(h.at(30.0, 300.0), h.at(30.0, 60.0), 1e-12);

  const TemporaryFile other("other.ies", type_c("90 180 270", 3, "1 1 5 5 9 9"));
  const IntensityProfile o = read_ies(other.path()).profile;
  EXPECT_NEAR(o.at(30.0, 135.0), 3.0, 1e-12);
  EXPECT_NEAR(o.at(30.0, 45.0), 3.0, 1e-12);  // mirrored at the plane 90-270
  EXPECT_NEAR(o.at(30.0, 315.0), 7.0, 1e-12);
  EXPECT_NEAR(o.at(30.0, 0.0), 5.0, 1e-12);

  const TemporaryFile full("full.ies", type_c("0 120 240", 3, "1 1 5 5 9 9"));
  EXPECT_NEAR(read_ies(full.path()).profile.at(30.0, 300.0), 5.0, 1e-12);  // 240 and 360 = 0
}

TEST(Ies, FactorsMultiply) {
  const TemporaryFile file("factors.ies",
                           "IESNA:LM-63-1995\r\nTILT=NONE\r\n1 1000 2 2 1 1 2 0 0 0\r\n"
                           "0.5, 3, 10\r\n0 180\r\n0\r\n10 10\r\n");
  EXPECT_NEAR(read_ies(file.path()).profile.flux(), 4.0 * kPi * 10.0 * 2.0 * 0.5 * 3.0, 1e-9);
}

TEST(Ies, TiltTableInAFileOfItsOwn) {
  const TemporaryFile tilt("lamp.tlt", "1\n2\n0 90\n0.5 0.25\n");
  const std::string text =
      "TILT=atrium_ies_lamp.tlt\n1 1 1 2 1 1 2 0 0 0\n1 1 1\n0 180\n0\n10 10\n";
  const TemporaryFile file("tilted.ies", text);
  EXPECT_NEAR(read_ies(file.path()).profile.flux(), 4.0 * kPi * 5.0, 1e-9);
  EXPECT_NE(message_of("outside.ies", "TILT=../x.tlt\n1").find(":1: TILT must be"),
            std::string::npos);
}

TEST(Ies, MessagesNameFileAndLine) {
  EXPECT_NE(message_of("none.ies", "hello\nworld\n").find("no TILT= line"), std::string::npos);
  EXPECT_NE(message_of("empty.ies", "").find("no TILT= line"), std::string::npos);
  EXPECT_NE(message_of("word.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 x\n").find(":3: "),
            std::string::npos);
  EXPECT_NE(message_of("short.ies", type_c("0", 1, "1")).find("the file ends before"),
            std::string::npos);
  EXPECT_NE(message_of("order.ies", type_c("90 0", 2, "1 1 1 1")).find("must increase"),
            std::string::npos);
  EXPECT_NE(message_of("negative.ies", type_c("0", 1, "1 -1")).find("must not be negative"),
            std::string::npos);
  EXPECT_NE(message_of("nan.ies", type_c("0", 1, "1 nan")).find("expected a number"),
            std::string::npos);
  EXPECT_NE(
      message_of("huge.ies", "TILT=NONE\n1 -1 1 999999999 1 1 2 0 0 0\n").find("whole number"),
      std::string::npos);
  EXPECT_THROW((void)read_ies("no_such_file.ies"), Error);
}

}  // namespace
}  // namespace atrium::scene
