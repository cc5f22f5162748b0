#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/luminaire.h"
#include "support/temp_folder.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;

struct Ldt {
  int symmetry = 0;
  std::vector<double> planes{0, 90, 180, 270};
  std::size_t first = 0, count = 4;  // planes of the table
  int gammas = 91;                   // in steps of 2 degrees
  std::string lamps = "1", flux = "2000", ratio = "80", conversion = "1";
  std::function<double(double c, double gamma)> per_klm = [](double, double) { return 100.0; };
};

std::string text_of(const Ldt& l) {
  std::string s = "maker\r\n1\r\n" + std::to_string(l.symmetry) + "\r\n" +
                  std::to_string(l.planes.size()) + "\r\n0\r\n" + std::to_string(l.gammas) +
                  "\r\n2\r\nreport\r\nname of it\r\n\r\n\r\n\r\n600\r\n300\r\n50\r\n"
                  "550\r\n250\r\n0\r\n0\r\n10\r\n0\r\n100\r\n" +
                  l.ratio + "\r\n" + l.conversion + "\r\n0\r\n1\r\n" + l.lamps + "\r\nLED\r\n" +
                  l.flux + "\r\n\r\n\r\n20\r\n";
  for (int i = 0; i < 10; ++i) s += "0,5\r\n";
  for (const double c : l.planes) s += std::to_string(c) + "\r\n";
  for (int g = 0; g < l.gammas; ++g) s += std::to_string(2 * g) + "\r\n";
  for (std::size_t k = 0; k < l.count; ++k)
    for (int g = 0; g < l.gammas; ++g)
      s += std::to_string(l.per_klm(l.planes[(l.first + k) % l.planes.size()] * kPi / 180.0,
                                    2.0 * g * kPi / 180.0)) +
           "\r\n";
  return s;
}

Luminaire read(const test::TempFolder& folder, const Ldt& l) {
  folder.write("a.ldt", text_of(l));
  return read_luminaire(folder / "a.ldt");
}

// Each symmetry with a distribution that has it, against the same planes written in full. Planes
// every 15 degrees, and crowded round 90 and 270 as of a road luminaire.
TEST(Eulumdat, SymmetriesUnfoldToTheFullTable) {
  const test::TempFolder folder;
  std::vector<double> even, uneven;
  for (int i = 0; i < 24; ++i) even.push_back(15.0 * i);
  for (const double base : {0.0, 180.0})
    for (const double c : {0.0, 30.0, 60.0, 80.0, 90.0, 100.0, 120.0, 150.0})
      uneven.push_back(base + c);
  for (const std::vector<double>& planes : {even, uneven}) {
    const std::size_t n = planes.size();
    struct Case {
      int symmetry;
      std::size_t first, count;
      std::function<double(double)> shape;
    };
    const Case cases[] = {{1, 0, 1, [](double) { return 1.0; }},
                          {2, 0, n / 2 + 1, [](double c) { return 2.0 + std::cos(c); }},
                          {3, 3 * n / 4, n / 2 + 1, [](double c) { return 2.0 + std::sin(c); }},
                          {4, 0, n / 4 + 1, [](double c) { return 2.0 + std::cos(2.0 * c); }}};
    for (const Case& k : cases) {
      SCOPED_TRACE(k.symmetry);
      Ldt l{.planes = planes, .first = 0, .count = n};
      l.per_klm = [&](double c, double gamma) {
        return 50.0 * k.shape(c) * (1.0 + std::cos(gamma));
      };
      const Luminaire full = read(folder, l);
      l.symmetry = k.symmetry;
      l.first = k.first;
      l.count = k.count;
      const Luminaire folded = read(folder, l);
      for (double c = 0.0; c < 360.0; c += 3.7)
        for (double gamma = 0.0; gamma <= 180.0; gamma += 9.1)
          ASSERT_NEAR(folded.profile.at(gamma, c), full.profile.at(gamma, c), 1e-3) << c;
      EXPECT_NEAR(folded.profile.flux() / full.profile.flux(), 1.0, 1e-6);
    }
  }
}

// I = 1000 ratio cos(gamma) / pi per 1000 lm has the flux that the light output ratio states; the
// two ways agree to the error of a table in steps of 2 degrees, 1e-4.
TEST(Eulumdat, FluxOfTheTableIsTheFluxStated) {
  const test::TempFolder folder;
  Ldt l;
  l.per_klm = [](double, double gamma) {
    return std::max(0.0, 0.8 * 1000.0 / kPi * std::cos(gamma));
  };
  const Luminaire a = read(folder, l);
  EXPECT_EQ(a.lamp_flux, 2000.0);
  EXPECT_EQ(a.stated_flux, 1600.0);
  EXPECT_NEAR(a.profile.flux() / 1600.0, 1.0, 5e-4);
  EXPECT_EQ(a.name, "name of it");
  EXPECT_NEAR((a.opening - Vec3d(0.25, 0.55, 0.01)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(opening_angle(a.profile, 0.0, 0.5), 120.0, 0.05);
  EXPECT_NEAR(opening_angle(a.profile, 90.0, 0.1), 2.0 * std::acos(0.1) * 180.0 / kPi, 0.05);

  l.conversion = "0,5";  // decimal comma
  EXPECT_NEAR(read(folder, l).profile.flux() / 800.0, 1.0, 5e-4);
  l.conversion = "1";
  l.lamps = "-1";  // absolute photometry: no lamps to relate to
  EXPECT_FALSE(read(folder, l).lamp_flux.has_value());
  EXPECT_NEAR(read(folder, l).profile.flux() / 1600.0, 1.0, 5e-4);
}

TEST(OpeningAngle, BeamsUpwardsAndDark) {
  const IntensityProfile up{{0.0, 150.0, 180.0}, {0.0}, {0.0, 0.0, 10.0}};
  EXPECT_NEAR(opening_angle(up, 0.0, 0.5), 30.0, 0.05);  // linear: half at 165
  EXPECT_EQ(opening_angle({{0.0, 180.0}, {0.0}, {0.0, 0.0}}, 0.0, 0.5), 0.0);
  EXPECT_EQ(opening_angle({{0.0, 180.0}, {0.0}, {1.0, 1.0}}, 0.0, 0.5), 360.0);
}

std::string message_of(const test::TempFolder& folder, const std::string& text) {
  folder.write("bad.ldt", text);
  try {
    (void)read_luminaire(folder / "bad.ldt");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Eulumdat, MessagesNameFileAndLine) {
  const test::TempFolder folder;
  const std::string good = text_of({});
  ASSERT_EQ(message_of(folder, good), "");
  const auto with_line = [&](int line, const std::string& value) {
    std::size_t at = 0;
    for (int i = 1; i < line; ++i) at = good.find('\n', at) + 1;
    return message_of(folder, good.substr(0, at) + value + good.substr(good.find('\r', at)));
  };
  EXPECT_NE(with_line(3, "5").find("bad.ldt:3: symmetry"), std::string::npos);
  EXPECT_NE(with_line(4, "x").find("bad.ldt:4: expected a number"), std::string::npos);
  EXPECT_NE(with_line(6, "1e9").find("bad.ldt:6:"), std::string::npos);
  EXPECT_NE(with_line(24, "0").find("bad.ldt:24: the conversion factor"), std::string::npos);
  EXPECT_NE(with_line(29, "-5").find("bad.ldt:29: flux of lamps"), std::string::npos);
  EXPECT_NE(with_line(44, "0").find("bad.ldt:44: angle of C planes must increase"),
            std::string::npos);
  EXPECT_NE(with_line(47, "nan").find("bad.ldt:47:"), std::string::npos);
  EXPECT_NE(message_of(folder, good.substr(0, good.size() - 40)).find("the file ends before"),
            std::string::npos);
  EXPECT_NE(message_of(folder, "").find("bad.ldt:1: the file ends"), std::string::npos);
  Ldt skew{.symmetry = 2, .planes = {0, 80, 180, 270}, .first = 0, .count = 3};
  EXPECT_NE(message_of(folder, text_of(skew)).find("symmetry indicator"), std::string::npos);
  EXPECT_THROW((void)read_luminaire("lamp.xyz"), Error);
}

class EulumdatFiles : public testing::TestWithParam<const char*> {};

// The table's integral against lamps' flux times light output ratio: what the file itself says.
TEST_P(EulumdatFiles, FluxAsStated) {
  const auto file = std::filesystem::path(ATRIUM_SOURCE_DIR) / "../shared/ies" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no file " << GetParam();
  const Luminaire l = read_luminaire(file);
  ASSERT_TRUE(l.stated_flux.has_value());
  EXPECT_NEAR(l.profile.flux() / *l.stated_flux, 1.0, 0.01);
}
INSTANTIATE_TEST_SUITE_P(Shared, EulumdatFiles,
                         testing::Values("fluorescent_luminaire.ldt", "road_luminaire.ldt"));

}  // namespace
}  // namespace atrium::scene
