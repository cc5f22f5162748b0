#pragma once

#include <cstdint>

namespace atrium::app {

enum class Quality { Draft, Normal, High };

/// Effort that a quality stands for.
struct Effort {
  int samples;       ///< of every pixel: path tracing
  int mean_samples;  ///< of a pixel in the mean: all else (RenderOptions::spread)
  std::uint32_t max_elements;
  int row_rays, gather_rays, direct_samples;
  std::uint64_t caustic_photons;
};
[[nodiscard]] constexpr Effort effort_of(Quality quality) {
  switch (quality) {
    case Quality::Draft:
      return {16, 12, 15000, 32, 32, 8, 200000};
    case Quality::Normal:
      return {64, 14, 60000, 64, 128, 16, 1000000};
    case Quality::High:
      break;
  }
  return {256, 128, 150000, 128, 512, 32, 4000000};
}

}  // namespace atrium::app
