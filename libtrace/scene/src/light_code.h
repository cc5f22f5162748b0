#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace atrium::scene {

/// Light in 16 bits: 0 is 0, then 4095 steps of equal ratio up to the largest value, 0.4 % each
/// over 23 factors of two. The low four bits are 0, so that it compresses.
struct LightCode {
  static constexpr double kSteps = 4095.0;
  static constexpr double kOctaves = 23.0;
  double largest = 0.0;

  [[nodiscard]] std::uint16_t encode(double value) const {
    if (!(value > 0.0) || !(largest > 0.0)) return 0;
    const double x = 1.0 + std::log2(std::min(value / largest, 1.0)) / kOctaves;
    const double step = std::round(std::clamp(x, 0.0, 1.0) * kSteps);
    return static_cast<std::uint16_t>(static_cast<unsigned>(step) << 4U);
  }
  [[nodiscard]] double decode(std::uint16_t code) const {
    const unsigned step = code >> 4U;
    if (step == 0) return 0.0;
    return largest * std::exp2((step / kSteps - 1.0) * kOctaves);
  }
};

}  // namespace atrium::scene
