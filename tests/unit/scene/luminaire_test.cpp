// Photometric files of all editions, of the same luminaire in both formats, and broken ones.
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/luminaire.h"
#include "support/temp_folder.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

std::string ies(const std::string& head, const std::string& ballast = "1 1 20") {
  return head + "1 -1 1 3 1 1 2 0.6 1.2 0\n" + ballast + "\n0 90 180\n0\n10 10 10\n";
}

Luminaire read(const test::TempFolder& folder, const std::string& name, const std::string& text) {
  folder.write(name, text);
  return read_luminaire(folder / name);
}

// What the number after the ballast factor is: the ballast-lamp photometric factor up to 1991, "for
// future use" (1) in 1995 and 2002, the file generation type from 2019 on.
TEST(IesEditions, HeadersAndTheNumberAfterTheBallastFactor) {
  struct Case {
    const char *head, *format;
    bool factor;
  };
  const Case cases[] = {
      {"A LABEL\nANOTHER ONE\nTILT=NONE\n", "LM-63-1986", true},
      {"IES REPORT 1234\nTILT=NONE\n", "LM-63-1986", true},
      {"IESNA91\n[TEST] 1\n[MANUFAC] x\n[MORE] y\nTILT=NONE\n", "LM-63-1991", true},
      {"IESNA95\n[TEST] 1\nTILT=NONE\n", "LM-63-1995", true},
      {"IESNA:LM-63-1995\n[TEST] 1\n[BLOCK]\n[ENDBLOCK]\nTILT=NONE\n", "LM-63-1995", true},
      {"IESNA:LM-63-2002\r\n[TEST] 1\r\n[ISSUEDATE] 1\r\nTILT=NONE\r\n", "LM-63-2002", true},
      {"IES:LM-63-2019\n[TEST] 1\n[TESTLAB] y\nTILT=NONE\n", "LM-63-2019", false},
      {"\xef\xbb\xbfIES:LM-63-19\n[TEST] 1\nTILT=NONE\n", "LM-63-2019", false}};
  const test::TempFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.head);
    const Luminaire l = read(folder, "a.ies", ies(c.head, "0.5 1.10001 20"));
    EXPECT_EQ(l.format, c.format);
    EXPECT_NEAR(l.profile.at(45.0, 0.0), 10.0 * 0.5 * (c.factor ? 1.10001 : 1.0), 1e-12);
    EXPECT_FALSE(l.lamp_flux.has_value());
    EXPECT_NEAR((l.opening - Vec3d(0.6, 1.2, 0.0)).norm(), 0.0, 1e-12);
  }
}

// The same table of tilt factors inside and beside the file; NONE leaves them out.
TEST(IesEditions, TiltInsideAndBesideTheFile) {
  const test::TempFolder folder;
  const std::string table = "1\n3\n0 45 90\n0.9 0.8 0.7\n";
  folder.write("lamp.tlt", table);
  const Luminaire none = read(folder, "a.ies", ies("IESNA:LM-63-2002\nTILT=NONE\n"));
  const Luminaire inside = read(folder, "b.ies", ies("IESNA:LM-63-2002\nTILT=INCLUDE\n" + table));
  const Luminaire beside = read(folder, "c.ies", ies("IESNA:LM-63-2002\nTILT=lamp.tlt\n"));
  EXPECT_EQ(inside.profile.candela, beside.profile.candela);
  EXPECT_NEAR(inside.profile.flux() / none.profile.flux(), 0.9, 1e-12);
}

// Type A has its poles above and below, type B to the left and right of the beam; turned by a
// right angle they swap V and H. I = 1000 cos(V) cos(H) is a Lambertian source in both, of flux
// 1000 pi; grid of 2.5 degrees, resampled on 1 x 3 degrees.
TEST(IesEditions, TypesAandBOfALambertianSource) {
  const test::TempFolder folder;
  std::string angles, candela;
  for (int i = -36; i <= 36; ++i) angles += std::to_string(2.5 * i) + " ";
  for (int h = -36; h <= 36; ++h)
    for (int v = -36; v <= 36; ++v)
      candela += std::to_string(std::max(
                     0.0, 1000.0 * std::cos(2.5 * h * kDegree) * std::cos(2.5 * v * kDegree))) +
                 "\n";
  for (const int type : {2, 3}) {
    const Luminaire l = read(folder, "a.ies",
                             "IESNA:LM-63-1995\nTILT=NONE\n1 -1 1 73 73 " + std::to_string(type) +
                                 " 2 0 0 0\n1 1 20\n" + angles + "\n" + angles + "\n" + candela);
    EXPECT_EQ(l.type, type == 2 ? 'B' : 'A');
    EXPECT_NEAR(l.profile.flux() / (1000.0 * kPi), 1.0, 2e-3);
    for (const double phi : {0.0, 33.0, 90.0, 200.0, 315.0})
      for (const double theta : {0.0, 20.0, 61.0, 85.0, 110.0})
        EXPECT_NEAR(l.profile.at(theta, phi), 1000.0 * std::max(0.0, std::cos(theta * kDegree)),
                    1.5)
            << theta << ' ' << phi;
  }
}

struct LampSet {
  std::string lamps, flux, watts;
};

/// I = f(C, gamma) cd per 1000 lm in planes of 15 and steps of 5 degrees.
std::string ldt(const std::vector<LampSet>& sets, const std::string& conversion,
                const std::function<double(double, double)>& f) {
  std::string s =
      "maker\n1\n0\n24\n15\n37\n5\nreport\nname\n\n\n\n600\n300\n50\n550\n250\n0\n0\n10\n0\n100\n80"
      "\n" +
      conversion + "\n15\n" + std::to_string(sets.size()) + "\n";
  for (const LampSet& l : sets)
    s += l.lamps + "\nT16\n" + l.flux + "\n3000 K\n80\n" + l.watts + "\n";
  for (int i = 0; i < 10; ++i) s += "0.5\n";
  for (int c = 0; c < 24; ++c) s += std::to_string(15 * c) + "\n";
  for (int g = 0; g <= 36; ++g) s += std::to_string(5 * g) + "\n";
  for (int c = 0; c < 24; ++c)
    for (int g = 0; g <= 36; ++g)
      s += std::to_string(f(15.0 * c * kDegree, 5.0 * g * kDegree)) + "\n";
  return s;
}

double lopsided(double c, double gamma) {
  return 100.0 * (2.0 + std::cos(c - 0.4)) * (1.0 + std::cos(gamma));
}

// Sets are alternatives; the table holds for each per 1000 lm of it. The tilt it was measured at
// (15 degrees here) changes nothing.
TEST(Eulumdat, FirstOfSeveralSetsOfLampsBurns) {
  const test::TempFolder folder;
  const LampSet two{"2", "2700", "56"}, one{"1", "4450", "53"}, absolute{"-1", "3000", "25"};
  const Luminaire a = read(folder, "a.ldt", ldt({two, one, absolute}, "1", lopsided));
  const Luminaire b = read(folder, "b.ldt", ldt({one, two}, "1", lopsided));
  const Luminaire c = read(folder, "c.ldt", ldt({absolute, two}, "1", lopsided));
  const Luminaire d = read(folder, "d.ldt", ldt({two}, "0.5", lopsided));
  EXPECT_EQ(a.lamp_flux, 2700.0);
  EXPECT_EQ(b.lamp_flux, 4450.0);
  EXPECT_FALSE(c.lamp_flux.has_value());
  EXPECT_NEAR(*a.stated_flux, 0.8 * 2700.0, 1e-9);
  EXPECT_NEAR(*c.stated_flux, 0.8 * 3000.0, 1e-9);
  EXPECT_NEAR(b.profile.flux() / a.profile.flux(), 4450.0 / 2700.0, 1e-12);
  EXPECT_NEAR(c.profile.flux() / a.profile.flux(), 3000.0 / 2700.0, 1e-12);
  EXPECT_NEAR(d.profile.flux() / a.profile.flux(), 0.5, 1e-12);
}

// One luminaire written in both formats reads as one: planes, angles and units agree.
TEST(Luminaires, EulumdatAndIesOfTheSameLuminaire) {
  const test::TempFolder folder;
  const Luminaire a = read(folder, "a.ldt", ldt({{"2", "2700", "56"}}, "1", lopsided));
  std::string text = "IES:LM-63-2019\nTILT=NONE\n2 1350 2.7 37 25 1 2 0.25 0.55 0.01\n1 1.1 56\n";
  for (int g = 0; g <= 36; ++g) text += std::to_string(5 * g) + " ";
  for (int c = 0; c <= 24; ++c) text += std::to_string(15 * c) + "\n";
  for (int c = 0; c <= 24; ++c)
    for (int g = 0; g <= 36; ++g)
      text += std::to_string(lopsided(15.0 * c * kDegree, 5.0 * g * kDegree)) + " ";
  const Luminaire b = read(folder, "a.ies", text + "\n");
  EXPECT_EQ(a.lamp_flux, b.lamp_flux);
  EXPECT_NEAR((a.opening - b.opening).norm(), 0.0, 1e-12);
  for (double phi = 0.0; phi < 360.0; phi += 7.3)
    for (double theta = 0.0; theta <= 180.0; theta += 3.9)
      ASSERT_NEAR(a.profile.at(theta, phi), b.profile.at(theta, phi), 1e-5) << theta << ' ' << phi;
  EXPECT_NEAR(a.profile.flux() / b.profile.flux(), 1.0, 1e-7);
}

// ---- broken files ----

/// Reads, or refuses with an Error that begins FILE:LINE: and is one line of text. True: was read.
bool reads_or_refuses(const test::TempFolder& folder, const std::string& name,
                      const std::string& text) {
  folder.write(name, text);
  const std::string file = (folder / name).string();
  try {
    const IntensityProfile p = read_luminaire(file).profile;
    EXPECT_EQ(p.candela.size(), p.theta_deg.size() * p.phi_deg.size());
    for (const std::vector<double>* angles : {&p.theta_deg, &p.phi_deg})
      for (std::size_t i = 1; i < angles->size(); ++i) EXPECT_LT((*angles)[i - 1], (*angles)[i]);
    for (const double c : p.candela) EXPECT_TRUE(c >= 0.0 && std::isfinite(c)) << c;
    const bool resampled = p.candela.size() > 1000;
    EXPECT_TRUE(resampled || std::isfinite(p.flux()));
    return true;
  } catch (const Error& e) {
    const std::string what = e.what();
    EXPECT_TRUE(what.starts_with(file + ":")) << what;
    int line = 0;
    const char* digits = what.data() + std::min(what.size(), file.size() + 1);
    const auto [end, code] = std::from_chars(digits, what.data() + what.size(), line);
    EXPECT_TRUE(code == std::errc() && *end == ':' && line > 0) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    return false;
  }
}

struct Broken {
  const char* name;
  std::string text;
};

std::vector<Broken> files_to_break() {
  return {
      {"c.ies",
       "IES:LM-63-2019\n[TEST] 1\nTILT=INCLUDE\n1\n2\n0 90\n1 0.9\n1 1000 1 3 2 1 2 0 0 0\n"
       "1 1.1 20\n0 45 90\n0 90\n1 2 3\n4 5 6\n"},
      {"b.ies", "IESNA91\nTILT=NONE\n1 -1 1 3 2 2 1 1 1 0\n1 1 20\n-90 0 90\n0 90\n1 2 3\n4 5 6\n"},
      {"l.ldt",
       "m\n1\n4\n4\n90\n3\n90\nr\nn\n\n\n\n600\n300\n50\n550\n250\n0\n0\n10\n0\n100\n80\n1\n0\n2\n"
       "1\nT\n2000\n\n\n20\n2\nT\n1800\n\n\n36\n.1\n.2\n.3\n.4\n.5\n.6\n.7\n.8\n.9\n1\n"
       "0\n90\n180\n270\n0\n90\n180\n9\n8\n7\n6\n5\n4\n"}};
}

TEST(BrokenLuminaires, CutOffAnywhere) {
  const test::TempFolder folder;
  for (const Broken& b : files_to_break()) {
    SCOPED_TRACE(b.name);
    ASSERT_TRUE(reads_or_refuses(folder, b.name, b.text));
    for (std::size_t n = 0; n + 2 < b.text.size(); ++n)
      EXPECT_FALSE(reads_or_refuses(folder, b.name, b.text.substr(0, n))) << n;
  }
}

// Each number in turn is replaced by what does harm to careless readers.
TEST(BrokenLuminaires, AnyNumberReplaced) {
  const test::TempFolder folder;
  const char* values[] = {"nan", "inf", "-1", "1e300",  "1e999", "0",
                          "1e9", "0.5", "x",  "1e-320", ""};
  int read = 0, refused = 0;
  for (const Broken& b : files_to_break()) {
    for (std::size_t begin = 0; begin < b.text.size();) {
      const std::size_t end = std::min(b.text.find_first_of(" \n", begin), b.text.size());
      if (end > begin)
        for (const char* value : values) {
          SCOPED_TRACE(std::string(b.name) + " at " + std::to_string(begin) + ": " + value);
          (reads_or_refuses(folder, b.name, b.text.substr(0, begin) + value + b.text.substr(end))
               ? read
               : refused)++;
        }
      begin = end + 1;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(read, 100);  // many a number may be 0.5
}

// Noise and zero bytes in any place.
TEST(BrokenLuminaires, BytesFlipped) {
  const test::TempFolder folder;
  std::uint32_t state = 1;
  const auto random = [&](std::size_t below) {
    state = state * 1664525U + 1013904223U;
    return static_cast<std::size_t>(state >> 8U) % below;
  };
  for (const Broken& b : files_to_break())
    for (int i = 0; i < 100; ++i) {
      std::string text = b.text;
      for (std::size_t k = 1 + random(3); k > 0; --k)
        text[random(text.size())] = static_cast<char>(random(256));
      (void)reads_or_refuses(folder, b.name, text);
    }
}

}  // namespace
}  // namespace atrium::scene
