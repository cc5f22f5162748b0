#pragma once

#include <span>
#include <vector>

namespace atrium::view {

/// Values that colours run over.
struct Range {
  double low = 0.0, high = 1.0;  ///< low < high; both above 0 if logarithmic
  bool logarithmic = false;

  /// Share of the way from low to high; below 0 or above 1 outside. Not above 0 on a logarithmic
  /// range: minus infinity.
  [[nodiscard]] double position(double value) const;
  friend bool operator==(const Range&, const Range&) = default;
};

/// A value and the area that has it [m^2].
struct Weighted {
  double value, area;
};

/// A range with round ends that suits values: from 0 (or the least, if there are negative ones) to
/// what 99 % of the area are below; logarithmic from what 1 % of the lit area are below, at most
/// four decades. So a lamp beside a wall does not make everything else blue. What is not finite
/// does not count; [0, 1] (logarithmic [0.1, 1]) without any value.
[[nodiscard]] Range automatic_range(std::span<const Weighted> values, bool logarithmic);

/// About `count` round values inside a range: multiples of 1, 2, 2.5 or 5 times a power of ten;
/// logarithmic ones of the series 1, 1.5, 2, 3, 5, 7.5 or a part of it.
[[nodiscard]] std::vector<double> round_levels(const Range& range, int count);

/// "500", "0.25", "1.2e+06": no more digits than it takes to tell levels apart.
[[nodiscard]] const char* level_format();

}  // namespace atrium::view
