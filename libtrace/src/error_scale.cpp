#include "error_scale.h"

#include <algorithm>
#include <cstddef>

namespace atrium::trace {
namespace {

double median_of_lit(const std::vector<double>& luminance, const std::vector<std::uint8_t>& valid) {
  std::vector<double> lit;
  for (std::size_t i = 0; i < luminance.size(); ++i)
    if ((valid.empty() || valid[i] != 0) && luminance[i] > 0.0) lit.push_back(luminance[i]);
  if (lit.empty()) return 0.0;
  const auto half = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  std::nth_element(lit.begin(), half, lit.end());
  if (lit.size() % 2 == 1) return *half;
  return 0.5 * (*half + *std::max_element(lit.begin(), half));
}

}  // namespace

std::vector<double> error_scales(int width, int height, const std::vector<double>& luminance,
                                 const std::vector<std::uint8_t>& valid) {
  const double floor = 0.05 * median_of_lit(luminance, valid);
  std::vector<double> result(luminance.size(), 0.0);
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0.0, count = 0.0;
      for (int v = std::max(0, y - 2); v <= std::min(height - 1, y + 2); ++v) {
        for (int u = std::max(0, x - 2); u <= std::min(width - 1, x + 2); ++u) {
          if (!valid.empty() && valid[index(u, v)] == 0) continue;
          sum += luminance[index(u, v)];
          count += 1.0;
        }
      }
      result[index(x, y)] = (count > 0.0 ? sum / count : 0.0) + floor;
    }
  }
  return result;
}

}  // namespace atrium::trace
