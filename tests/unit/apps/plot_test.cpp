#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/image_io.h"
#include "support/temp_folder.h"

namespace {

using namespace atrium::plot;
using atrium::Error;
using atrium::test::TempFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr Color kRed{1.0, 0.0, 0.0};
const std::string kRedStroke = "stroke=\"#ff0000\"";

/// No test may depend on a display.
#define ATRIUM_NEEDS_MODULE() \
  ::unsetenv("DISPLAY");      \
  if (!plot_available()) GTEST_SKIP() << "built without VTK"

std::string svg_of(const std::vector<Panel>& panels, const Picture& picture = {}) {
  const TempFolder folder;
  write_plot(folder / "plot.svg", panels, picture);
  std::ifstream in(folder / "plot.svg");
  return {std::istreambuf_iterator<char>(in), {}};
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

struct Xy {
  double x, y;
};

/// The points of the polylines drawn in `stroke`, y downwards, in the order of the file.
std::vector<std::vector<Xy>> polylines(const std::string& svg, const std::string& stroke) {
  std::vector<std::vector<Xy>> lines;
  std::istringstream in(svg);
  for (std::string line; std::getline(in, line);) {
    const std::string start = "<polyline points=\"";
    if (!line.starts_with(start) || line.find(stroke) == std::string::npos) continue;
    std::istringstream points(
        line.substr(start.size(), line.find('"', start.size()) - start.size()));
    lines.emplace_back();
    char comma = 0;
    for (Xy p{}; points >> p.x >> comma >> p.y;) lines.back().push_back(p);
  }
  return lines;
}

/// The longest of them: the curve and not its sample in the legend.
std::vector<Xy> curve_in(const std::string& svg, const std::string& stroke = kRedStroke) {
  const auto lines = polylines(svg, stroke);
  if (lines.empty()) return {};
  return *std::max_element(lines.begin(), lines.end(),
                           [](const auto& a, const auto& b) { return a.size() < b.size(); });
}

/// Anchor of the first of such texts.
double text_x(const std::string& svg, const std::string& text) {
  const std::string start = "translate(";
  const auto at = svg.rfind(start, svg.find(">" + text + "</text>"));
  return at == std::string::npos ? kNan : std::stod(svg.substr(at + start.size()));
}

Chart sample_chart() {
  Chart chart;
  chart.title = "Metals & <glass>";
  chart.x_title = "wavelength [nm]";
  chart.y_title = "θ [rad]";
  chart.curves = {{"gold", {400, 500, 600, 700}, {0.2, 0.3, 0.8, 0.9}, kRed},
                  {"dashed one", {400, 700}, {0.1, 0.5}, {}, true}};
  chart.swatches = {{"some colour", {0.2, 0.4, 0.6}}};
  return chart;
}

TEST(Plot, SvgHoldsTitlesNamesCurvesAndSwatches) {
  ATRIUM_NEEDS_MODULE();
  const std::string svg = svg_of({sample_chart()});
  for (const char* text : {"Metals &amp; &lt;glass&gt;", "wavelength [nm]", "θ [rad]", "gold",
                           "dashed one", "some colour", "500", "0.4"}) {
    EXPECT_EQ(count(svg, ">" + std::string(text) + "</text>"), 1) << text;
  }
  EXPECT_EQ(count(svg, kRedStroke), 2) << "the curve and its sample in the legend";
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2);
  EXPECT_EQ(count(svg, "fill=\"#336699\""), 1);
  EXPECT_EQ(count(svg, "<svg "), 1);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(Plot, CurvesAreWhereTheTicksSay) {
  ATRIUM_NEEDS_MODULE();
  Chart chart;
  chart.x_range = {0.0, 4.0};
  chart.y_range = {-1.0, 1.0};
  chart.curves = {{"", {0, 1, 2, 4}, {-1, 0.5, 0, 1}, kRed},
                  {"", {0, 4}, {-1, -1}, Color{0, 0, 1}},
                  {"", {0, 0}, {-1, 1}, Color{0, 1, 0}}};
  const std::string svg = svg_of({chart});
  const auto p = curve_in(svg);
  ASSERT_EQ(p.size(), 4u);
  // The frame is drawn by curves of its own; 0.02: the digits of the file.
  const auto bottom = curve_in(svg, "#0000ff"), left = curve_in(svg, "#00ff00");
  ASSERT_EQ(bottom.size(), 2u);
  ASSERT_EQ(left.size(), 2u);
  const double width = bottom[1].x - bottom[0].x, height = left[0].y - left[1].y;
  EXPECT_GT(width, 600.0);
  EXPECT_GT(height, 350.0);
  EXPECT_NEAR(text_x(svg, "2.0"), bottom[0].x + 0.5 * width, 1.0);
  EXPECT_NEAR(text_x(svg, "3.0"), bottom[0].x + 0.75 * width, 1.0);
  const double x[] = {0, 0.25, 0.5, 1}, y[] = {0, 0.75, 0.5, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(p[i].x, bottom[0].x + x[i] * width, 0.02);
    EXPECT_NEAR(p[i].y, left[0].y - y[i] * height, 0.02);
  }
}

TEST(Plot, APowerIsAStraightLineOnLogarithmicAxes) {
  ATRIUM_NEEDS_MODULE();
  Chart chart{"", "", "", true, true, {}, {}, {{"", {}, {}, kRed}}};
  for (double x = 1e-3; x < 2e3; x *= 10) {
    chart.curves[0].x.push_back(x);
    chart.curves[0].y.push_back(std::pow(x, -3));
  }
  const auto p = curve_in(svg_of({chart}));
  ASSERT_EQ(p.size(), 7u);
  for (std::size_t i = 1; i < 7; ++i) {
    EXPECT_NEAR(p[i].x - p[0].x, (p[6].x - p[0].x) * static_cast<double>(i) / 6.0, 0.02);
    EXPECT_NEAR(p[i].y - p[0].y, (p[6].y - p[0].y) * static_cast<double>(i) / 6.0, 0.02);
  }
  EXPECT_GT(p[6].y, p[0].y + 300.0) << "falls";
}

TEST(Plot, LobesHaveEqualScalesAndAnglesFromTheNormal) {
  ATRIUM_NEEDS_MODULE();
  for (const Picture picture : {Picture{300, 600}, Picture{900, 300}}) {
    for (const double last : {90.0, 180.0}) {
      PolarChart chart;
      chart.r_max = 2.0;
      chart.curves = {{"", {}, {}, kRed}};
      for (double theta = -last; theta <= last; theta += 5) {
        chart.curves[0].x.push_back(theta);
        chart.curves[0].y.push_back(1.5);
      }
      const auto p = curve_in(svg_of({chart}, picture));
      ASSERT_EQ(p.size(), chart.curves[0].x.size());
      const std::size_t middle = p.size() / 2, quarter = static_cast<std::size_t>(90 / 5);
      const double radius = 0.5 * (p[middle + quarter].x - p[middle - quarter].x);
      const Xy center{p[middle].x, p[middle].y + radius};
      EXPECT_GT(radius, 40.0);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const double angle = chart.curves[0].x[i] * std::numbers::pi / 180.0;
        EXPECT_NEAR(p[i].x, center.x + radius * std::sin(angle), 0.03);
        EXPECT_NEAR(p[i].y, center.y - radius * std::cos(angle), 0.03);
      }
    }
  }
}

TEST(Plot, LobesBeyondTheLargestRadiusAreLeftOut) {
  ATRIUM_NEEDS_MODULE();
  PolarChart chart;
  chart.r_max = 1.0;
  chart.curves = {{"", {-60, -40, -20, 0, 20, 40}, {0.5, 0.5, 0.5, 7, 0.5, 0.5}, kRed}};
  const auto lines = polylines(svg_of({chart}), kRedStroke);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].size(), 3u);
  EXPECT_EQ(lines[1].size(), 2u);
}

TEST(Plot, WhatCannotBeDrawnIsAGap) {
  ATRIUM_NEEDS_MODULE();
  Chart chart;
  chart.curves = {{"", {0, 1, 2, 3, 4, 5, 6, kNan, 8}, {1, 2, kNan, 2, 1, kInf, 3, 4, 5}, kRed}};
  std::string svg = svg_of({chart});
  auto lines = polylines(svg, kRedStroke);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].size(), 2u);
  EXPECT_EQ(lines[1].size(), 2u);
  for (const std::size_t dot : {2u, 3u}) {
    ASSERT_EQ(lines[dot].size(), 2u) << "a point without neighbours";
    EXPECT_EQ(lines[dot][0].x, lines[dot][1].x);
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  chart.log_y = true;
  chart.curves = {{"", {0, 1, 2, 3, 4, 5}, {1, 2, 0, -1, 4, 5}, kRed}};
  EXPECT_EQ(polylines(svg_of({chart}), kRedStroke).size(), 2u);
}

TEST(Plot, CurvesWithNothingToDrawKeepTheirEntryInTheLegend) {
  ATRIUM_NEEDS_MODULE();
  for (const bool log : {false, true}) {
    Chart chart;
    chart.log_x = chart.log_y = log;
    chart.curves = {{"empty", {}, {}}, {"undefined", {0, 1}, {kNan, kNan}, kRed}};
    const std::string svg = svg_of({chart});
    EXPECT_EQ(count(svg, ">empty</text>"), 1);
    EXPECT_EQ(count(svg, ">undefined</text>"), 1);
    EXPECT_EQ(polylines(svg, kRedStroke).size(), 1u);
  }
}

TEST(Plot, CurvesAreCutNearTheRange) {
  ATRIUM_NEEDS_MODULE();
  Chart chart;
  chart.x_range = {0.0, 1.0};
  chart.y_range = {0.0, 1.0};
  // Leaves through the top, returns, passes by outside.
  chart.curves = {{"", {0, 0.4, 0.8, 1, 1e9, 1e9}, {0, 1e30, 0.5, 0.5, 0.5, 1e300}, kRed}};
  const auto lines = polylines(svg_of({chart}), kRedStroke);
  ASSERT_EQ(lines.size(), 2u);
  for (const auto& line : lines) {
    for (const Xy& p : line) {
      EXPECT_LT(std::abs(p.x), 2000.0);
      EXPECT_LT(std::abs(p.y), 2000.0);
    }
  }
  EXPECT_NEAR(lines[0][0].x, lines[0][1].x, 0.02) << "as steep as the uncut one";
}

TEST(Plot, AnyMagnitudeHasAxesAndCurves) {
  ATRIUM_NEEDS_MODULE();
  for (const double size : {1e-320, 1e-200, 1e-30, 1.0, 1e30, 1e200, 1e300}) {
    for (const double offset : {0.0, 1.0, 1e12}) {
      Chart chart;
      chart.curves = {{"", {0, 1, 2}, {offset * size, (offset + 1) * size, offset * size}, kRed}};
      PolarChart polar;
      polar.curves = {{"", {-10, 0, 10}, {size, 0.5 * size, size}, Color{0, 0, 1}}};
      if (!(std::abs(chart.curves[0].y[1]) <= 1e300)) continue;
      const std::string svg = svg_of({chart, polar});
      EXPECT_EQ(curve_in(svg).size(), 3u) << size << ' ' << offset;
      EXPECT_EQ(curve_in(svg, "#0000ff").size(), 3u) << size;
      const auto p = curve_in(svg);
      if (size > 1e-300 && offset < 1e6) {
        EXPECT_GT(p[0].y - p[1].y, 100.0) << size << ' ' << offset;
      }
    }
  }
}

TEST(Plot, PanelsFormAGrid) {
  ATRIUM_NEEDS_MODULE();
  SwatchChart swatches{"table", 2, {}};
  for (const char* name : {"A", "B", "C"}) swatches.swatches.push_back({name, kRed});
  PolarChart polar;
  polar.title = "lobes";
  const std::string svg = svg_of({sample_chart(), polar, swatches}, {800, 600, 2});
  // Titles are centred in their panels.
  EXPECT_EQ(count(svg, "translate(200 "), 1 + 1 + 0) << "first and third title";
  EXPECT_NE(svg.find(">lobes</text>"), std::string::npos);
  EXPECT_EQ(count(svg, "fill=\"#ff0000\""), 3);
  EXPECT_NE(svg.find("viewBox=\"0 0 800 600\""), std::string::npos);
}

TEST(Plot, PngHasTheColorsOnWhite) {
  ATRIUM_NEEDS_MODULE();
  if (!atrium::scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  const TempFolder folder;
  const SwatchChart swatches{"", 1, {{"", kRed}, {"", Color{0, 0, 1}}}};
  Chart chart;
  chart.x_range = chart.y_range = Range{0.0, 1.0};
  chart.curves = {{"", {0, 1}, {0.5, 0.5}, Color{0, 1, 0}}};
  // An ending in capitals is the same format.
  write_plot(folder / "plot.PNG", {swatches, chart}, {300, 200, 2, 3});
  const auto image = atrium::scene::read_image(folder / "plot.PNG");
  ASSERT_EQ(image.width, 900);
  ASSERT_EQ(image.height, 600);
  const auto is = [&](int x, int y, float r, float g, float b) {
    return image.at(x, y, 0) == r && image.at(x, y, 1) == g && image.at(x, y, 2) == b;
  };
  EXPECT_TRUE(is(225, 120, 1, 0, 0));
  EXPECT_TRUE(is(225, 390, 0, 0, 1));
  EXPECT_TRUE(is(3, 3, 1, 1, 1));
  int green = 0;
  for (int y = 0; y < image.height; ++y) green += is(700, y, 0, 1, 0) ? 1 : 0;
  EXPECT_GE(green, 4) << "1.8 units are 5.4 pixels";
  EXPECT_LE(green, 6);
}

TEST(Plot, RefusesBadInputAndLeavesNothingBehind) {
  const TempFolder folder;
  const auto refused = [&](const Panel& panel, const Picture& picture = {}) {
    EXPECT_THROW(write_plot(folder / "a.svg", {panel}, picture), std::invalid_argument);
  };
  try {
    write_plot(folder / "a.jpg", {sample_chart()});
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(".svg .png"), std::string::npos) << e.what();
  }
  EXPECT_THROW(write_plot(folder / "none/a.svg", {sample_chart()}), Error);
  EXPECT_THROW(write_plot(folder / "a.svg", {}), std::invalid_argument);
  Chart chart = sample_chart();
  chart.curves[0].y.pop_back();
  refused(chart);
  chart = sample_chart();
  chart.curves[0].color = Color{0.0, kNan, 0.0};
  refused(chart);
  chart = sample_chart();
  chart.swatches[0].color.r = 1.01;
  refused(chart);
  for (const Range& range : {Range{1, 1}, Range{2, 1}, Range{0, kNan}, Range{0, kInf},
                             Range{1.0, 1.0 + 1e-12}, Range{0, 1e-310}}) {
    chart = sample_chart();
    chart.x_range = range;
    refused(chart);
  }
  chart = sample_chart();
  chart.log_y = true;
  chart.y_range = Range{0.0, 1.0};
  refused(chart);
  PolarChart polar;
  polar.curves = {{"", {181.0}, {1.0}}};
  refused(polar);
  polar.curves = {{"", {0.0}, {-1.0}}};
  refused(polar);
  polar.curves.clear();
  polar.r_max = 0.0;
  refused(polar);
  refused(SwatchChart{"", 0, {}});
  refused(sample_chart(), {50, 480});
  refused(sample_chart(), {720, 480, 0});
  refused(sample_chart(), {720, 480, 1, 9});
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(Plot, TheModuleIsThereIfItWasBuilt) {
#ifdef ATRIUM_WITH_VTK
  EXPECT_TRUE(plot_available()) << "the other tests were skipped";
#else
  const TempFolder folder;
  try {
    write_plot(folder / "a.svg", {sample_chart()});
    ADD_FAILURE() << "no error";
  } catch (const atrium::RuntimeFailure& e) {
    EXPECT_NE(std::string(e.what()).find("without VTK"), std::string::npos) << e.what();
  }
  EXPECT_EQ(folder.file_count(), 0);
#endif
}

}  // namespace
