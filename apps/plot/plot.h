#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace atrium::plot {

/// As a screen shows it: encoded sRGB, each in [0, 1]; not the linear RGB of the libraries.
struct Color {
  double r = 0.0, g = 0.0, b = 0.0;
};

struct Range {
  double min = 0.0, max = 1.0;
};

enum class LegendPlace { TopRight, TopLeft, BottomRight, BottomLeft, None };

/// Points joined by lines in the order given. A point that cannot be drawn (not finite, beyond
/// 1e300, or not positive on a logarithmic axis) is a gap, so that a pole or an undefined value
/// stays visible as such.
struct Curve {
  std::string name;  ///< in the legend; "" keeps the curve out of it
  std::vector<double> x, y;
  std::optional<Color> color = {};  ///< default: the next of a palette safe for colour blindness
  bool dashed = false;
};

/// A rectangle of one colour with its name beneath.
struct Swatch {
  std::string name;
  Color color;
};

/// Curves over x and y axes.
struct Chart {
  std::string title, x_title, y_title;
  bool log_x = false, log_y = false;
  /// Default: the extent of what can be drawn (y with some room; from 0 if 0 is near). A curve is
  /// cut where it leaves a range.
  std::optional<Range> x_range = {}, y_range = {};
  std::vector<Curve> curves;
  std::vector<Swatch> swatches = {};  ///< a row below the chart
  LegendPlace legend = LegendPlace::TopRight;
};

/// Lobes: radius over the angle from the normal, which points up; positive angles to the right,
/// equal scales. Curve::x is the angle [deg] in [-180, 180], Curve::y the radius >= 0. The picture
/// is the upper half disc, or the whole disc as soon as an angle is beyond 90.
struct PolarChart {
  std::string title;
  std::string r_title;               ///< what the radius is, with its unit
  std::optional<double> r_max = {};  ///< radii beyond are left out; default: a round number that
                                     ///< holds all
  std::vector<Curve> curves;
  std::vector<Swatch> swatches = {};
  LegendPlace legend = LegendPlace::TopRight;
};

/// Nothing but swatches, row by row.
struct SwatchChart {
  std::string title;
  int columns = 4;
  std::vector<Swatch> swatches;
};

using Panel = std::variant<Chart, PolarChart, SwatchChart>;

struct Picture {
  int width = 720, height = 480;  ///< of the whole picture, in units of SVG (CSS pixels)
  int columns = 1;                ///< panels are placed row by row
  int pixel_ratio = 2;            ///< PNG only: pixels per unit, 1 to 4
};

/// Draws the panels into `file`: .svg (text stays text) or .png, on a white ground. Needs no
/// display; VTK is in a module that is loaded on first use. Complete or absent, as write_image().
/// Text is UTF-8.
/// \throws Error                  for an unknown ending, a folder that is not there
/// \throws std::invalid_argument  for no panels, x and y of different lengths, colours or angles
///                                out of range, negative radii, ranges that are empty, too narrow
///                                or not positive on log axes
/// \throws RuntimeFailure         if the module is missing, not built, or cannot write
void write_plot(const std::filesystem::path& file, const std::vector<Panel>& panels,
                const Picture& picture = {});

[[nodiscard]] bool plot_available();
/// Does the ending name a format that write_plot() knows?
[[nodiscard]] bool is_plot_ending(const std::filesystem::path& file);

}  // namespace atrium::plot
