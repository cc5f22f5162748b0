#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "share.h"

namespace atrium::trace {

/// What of the light at a level of sharing its weights are made of, by pixel.
struct ShareNoise {
  std::vector<float> variance;                  ///< blurred
  std::array<std::vector<float>, 2> luminance;  ///< by guiding half
};

/// How much of the light of pixels from q on those from p on take, and the other way round, times a
/// factor: as far as they are of one surface and differ by no more than noise explains.
/// \param weights  by guiding half, `count` of each.
void find_weights(const ShareGuides& guides, const ShareNoise& light, std::size_t p, std::size_t q,
                  std::size_t count, float factor, const std::array<float*, 2>& weights);

}  // namespace atrium::trace
