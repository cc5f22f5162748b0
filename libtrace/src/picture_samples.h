#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "material/spectrum.h"

namespace atrium::trace {

/// A pixel's samples are drawn as this many independent replicates: two halves of two. What one
/// half says decides how the other is shared between pixels; how the replicates of a half differ
/// says how certain the picture is.
inline constexpr std::size_t kReplicates = 4;

/// A picture and what its replicates say of its error, by pixel. Everything but the mean is linear
/// in the errors, so sums over pixels are what the summed picture has.
struct PictureSamples {
  int width = 0, height = 0;
  std::vector<Rgb> mean;
  /// By half: independent deviations; the sum of their squares has the variance of the mean as
  /// expectation.
  std::array<std::vector<Rgb>, 2> deviation;
  /// [half][replicate]: what sharing between pixels changed. The noises of the two replicates of a
  /// half are independent and the weights came from the other half, so their product has the square
  /// of the bias of sharing as expectation. Empty if nothing is shared.
  std::array<std::array<std::vector<Rgb>, 2>, 2> change;

  /// By replicate: what paths found where the field was read, less what the field said
  /// (PixelSample::field_missed). Empty if nothing was checked.
  std::array<std::vector<Rgb>, kReplicates> missed;

  [[nodiscard]] bool checked() const { return !missed[0].empty(); }
  [[nodiscard]] bool shared() const { return !change[0][0].empty(); }
};

/// The picture averaged over squares of pixels; at the right and lower border over what is there.
[[nodiscard]] PictureSamples average_blocks(const PictureSamples& samples, int edge);

}  // namespace atrium::trace
