#pragma once

#include <string>
#include <vector>

#include "plot/plot.h"

namespace atrium::plot {

/// Value that can be drawn: finite (with room for sums), and positive on a logarithmic axis.
[[nodiscard]] bool drawable(double value, bool log);

/// A tick of a (logarithmic) axis.
struct Tick {
  double value = 0.0;
  std::string label;  ///< "" for a tick without
};

/// About `count` ticks at round values within `range`; all of them have as many decimals.
[[nodiscard]] std::vector<Tick> make_ticks(const Range& range, bool log, int count);

/// 1, 2 or 5 times a power of ten, the smallest that is not below `value` > 0.
[[nodiscard]] double round_step(double value);

/// What an axis shows if its range is not given; see Chart.
[[nodiscard]] Range x_extent(const Chart& chart);
[[nodiscard]] Range y_extent(const Chart& chart);

}  // namespace atrium::plot
