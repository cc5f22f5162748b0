#include "plot/axis_range.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace atrium::plot {
namespace {

/// Extent of one coordinate over the points of which both can be drawn (and, for y, are within the
/// range of x); min > max if there are none.
Range data_extent(const Chart& chart, bool of_x, const Range* x_range) {
  Range extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double x = curve.x[i], y = curve.y[i];
      if (!drawable(x, chart.log_x) || !drawable(y, chart.log_y)) continue;
      if (x_range != nullptr && (x < x_range->min || x > x_range->max)) continue;
      extent.min = std::min(extent.min, of_x ? x : y);
      extent.max = std::max(extent.max, of_x ? x : y);
    }
  }
  return extent;
}

/// No range is empty, so that a constant or absent curve has axes, too.
Range not_empty(const Range& extent, bool log) {
  if (!(extent.min <= extent.max)) return log ? Range{0.1, 10.0} : Range{0.0, 1.0};
  if (log) {
    return extent.max > 1.01 * extent.min ? extent : Range{extent.min / 2.0, extent.max * 2.0};
  }
  // Single precision, in which VTK draws, must still tell the ends apart.
  const double size = std::max(std::abs(extent.min), std::abs(extent.max));
  if (extent.max - extent.min > std::max(1e-5 * size, 1e-300)) return extent;
  const double room = size > 1e-300 ? 0.1 * size : 1.0;
  return {extent.min - room, extent.max + room};
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::vector<Tick> linear_ticks(const Range& range, int count) {
  const double step = round_step((range.max - range.min) / count);
  const double size = std::max(std::abs(range.min), std::abs(range.max));
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const bool scientific = size >= 1e6 || size < 1e-3;
  std::vector<Tick> ticks;
  for (double k = std::ceil(range.min / step - 1e-6); k * step <= range.max + 1e-6 * step; ++k) {
    const double value = k * step + 0.0;  // no -0
    char text[64];
    std::snprintf(text, sizeof text, "%.3g", value);
    ticks.push_back({value, scientific ? text : fixed(value, decimals)});
  }
  return ticks;
}

std::vector<Tick> log_ticks(const Range& range, int count) {
  const int first = static_cast<int>(std::floor(std::log10(range.min)));
  const int last = static_cast<int>(std::floor(std::log10(range.max) + 1e-9));
  const double decades = std::log10(range.max / range.min);
  const int every = std::max(1, static_cast<int>(std::ceil(decades / count)));
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, exponent);
      if (value < range.min * (1.0 - 1e-9) || value > range.max * (1.0 + 1e-9)) continue;
      if (digit > 1 && every > 1) continue;
      // Over less than two decades the powers of ten alone would be too few to read values from.
      const bool labelled = digit == 1
                                ? exponent % every == 0
                                : decades < 1.0 || (decades < 2.5 && (digit == 2 || digit == 5));
      char text[64];
      std::snprintf(text, sizeof text, "%.3g", value);
      ticks.push_back({value, labelled ? text : ""});
    }
  }
  return ticks;
}

}  // namespace

bool drawable(double value, bool log) { return std::abs(value) <= 1e300 && (!log || value > 0.0); }

double round_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

std::vector<Tick> make_ticks(const Range& range, bool log, int count) {
  return log ? log_ticks(range, count) : linear_ticks(range, count);
}

Range x_extent(const Chart& chart) {
  if (chart.x_range) return *chart.x_range;
  return not_empty(data_extent(chart, true, nullptr), chart.log_x);
}

Range y_extent(const Chart& chart) {
  if (chart.y_range) return *chart.y_range;
  const Range x_range = x_extent(chart);
  const Range extent = not_empty(data_extent(chart, false, &x_range), chart.log_y);
  if (chart.log_y) {
    const double room = std::pow(extent.max / extent.min, 0.05);
    return {extent.min / room, extent.max * room};
  }
  const double room = 0.05 * (extent.max - extent.min);
  const bool zero_is_near = extent.min >= 0.0 && extent.min < 0.3 * extent.max;
  return {zero_is_near ? 0.0 : extent.min - room, extent.max + room};
}

}  // namespace atrium::plot
