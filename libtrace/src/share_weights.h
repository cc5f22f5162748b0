#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "share.h"

namespace atrium::trace {

/// What weights of sharing are made of, number by number: [pixel, row by row].
struct WeightPlanes {
  std::array<std::vector<float>, 3> normal, position;
  std::vector<float> depth;
  std::vector<float> noise;                     ///< variance, blurred
  std::array<std::vector<float>, 2> luminance;  ///< by guiding half

  /// Surfaces alone; noise and luminance are those of a level.
  explicit WeightPlanes(const ShareGuides& guides);
};

/// How much of the light of pixels from q on those from p on take, and the other way round, times a
/// factor: as far as they are of one surface and differ by no more than noise explains.
/// \param weights  by guiding half, `count` of each.
void find_weights(const WeightPlanes& planes, std::size_t p, std::size_t q, std::size_t count,
                  float factor, const std::array<float*, 2>& weights);

}  // namespace atrium::trace
