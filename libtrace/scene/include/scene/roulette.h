#pragma once

#include <algorithm>

namespace atrium::scene {

/// Probability with which a path goes on that has scattered so many times, however much it still
/// carries; straight passages through panes do not count, they end by themselves. 1 for all but
/// the longest: between mirrors that lose nothing a path would never end, so after kLongPath events
/// it does with probability 2 / events. Then it has 2 kLongPath events on average, and the variance
/// stays finite for any loss: of n events survive (kLongPath / n)^2, which falls more slowly than
/// what they carry.
[[nodiscard]] inline float long_path_survival(int scattered) {
  constexpr int kLongPath = 1024;
  return scattered < kLongPath ? 1.0f : 1.0f - 2.0f / static_cast<float>(scattered);
}

}  // namespace atrium::scene
