#pragma once

#include <cstdint>
#include <vector>

#include "share.h"

namespace atrium::trace {

/// Which of several averages of the same light every pixel takes: the one whose squared error,
/// noise and bias of averaging as its replicates show them, is least in the pixel's surroundings.
/// Where light has edges finer than its noise, that is its own samples. \param candidates  the
/// first is the light as sampled. \param weight  by pixel: what a difference of illumination is
/// multiplied by to be an error.
[[nodiscard]] std::vector<std::uint8_t> choose_shares(int width, int height,
                                                      const std::vector<Illumination>& candidates,
                                                      const std::vector<Rgb>& weight);

}  // namespace atrium::trace
