#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace atrium::trace {

/// Sums of a picture over rectangles, in constant time each (summed areas, in double precision).
class BoxSums {
 public:
  /// \param value  f(pixel number).
  template <class F>
  BoxSums(int width, int height, F&& value)
      : width_(width),
        height_(height),
        sums_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1), 0.0) {
    std::size_t i = 0;
    for (int y = 0; y < height; ++y) {
      double row = 0.0;
      for (int x = 0; x < width; ++x, ++i) {
        row += static_cast<double>(value(i));
        sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
      }
    }
  }

  /// Sum over the square of pixels up to `radius` away, as far as it is inside.
  [[nodiscard]] double around(int x, int y, int radius) const {
    const int x0 = std::max(0, x - radius), x1 = std::min(width_, x + radius + 1);
    const int y0 = std::max(0, y - radius), y1 = std::min(height_, y + radius + 1);
    return sums_[index(x1, y1)] - sums_[index(x0, y1)] - sums_[index(x1, y0)] +
           sums_[index(x0, y0)];
  }
  /// Number of pixels of that square.
  [[nodiscard]] double count(int x, int y, int radius) const {
    return count_around(width_, height_, x, y, radius);
  }
  [[nodiscard]] static double count_around(int width, int height, int x, int y, int radius) {
    const int columns = std::min(width, x + radius + 1) - std::max(0, x - radius);
    const int rows = std::min(height, y + radius + 1) - std::max(0, y - radius);
    return static_cast<double>(columns) * static_cast<double>(rows);
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<double> sums_;
};

}  // namespace atrium::trace
