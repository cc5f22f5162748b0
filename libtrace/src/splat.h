#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "light_classes.h"
#include "pixel_sample.h"

namespace atrium::trace {

/// What one path from a light shows in one pixel; the pixel's radiance is the sum over all paths
/// divided by their number.
struct Splat {
  std::uint32_t pixel;  ///< of the film
  std::uint16_t replicate;
  std::uint16_t layer;  ///< kPictureLayer, or of a term or class of light paths
  Rgb radiance;
};
using Splats = std::vector<Splat>;

inline constexpr std::uint16_t kPictureLayer = 0;
[[nodiscard]] inline std::uint16_t layer_of(Term term) {
  return static_cast<std::uint16_t>(1U + static_cast<std::size_t>(term));
}
[[nodiscard]] inline std::uint16_t layer_of(LightClass c) {
  return static_cast<std::uint16_t>(1U + kTerms + static_cast<std::size_t>(c));
}

}  // namespace atrium::trace
