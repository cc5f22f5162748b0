#pragma once

#include <cstdint>
#include <vector>

namespace atrium::trace {

/// What differences between pictures are divided by, for every pixel: the mean luminance of the 5x5
/// pixels round it (fewer at the border) plus 5 % of the median luminance of the lit pixels. 0 only
/// where the whole picture is black.
/// \param luminance  Y by pixel.  \param valid  pixels that count; empty: all.
/// Source: docs/architecture.md, Error measures.
[[nodiscard]] std::vector<double> error_scales(int width, int height,
                                               const std::vector<double>& luminance,
                                               const std::vector<std::uint8_t>& valid = {});

/// A difference by its scale, with 0 / 0 = 0 (black in a black picture) and anything else / 0
/// infinite.
[[nodiscard]] inline double relative(double difference, double scale) {
  return difference == 0.0 ? 0.0 : difference / scale;
}

}  // namespace atrium::trace
