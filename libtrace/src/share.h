#pragma once

#include <array>
#include <vector>

#include "material/frame.h"
#include "material/spectrum.h"

namespace atrium::trace {

/// What the first surface of each pixel looks like: where samples may be shared.
struct ShareGuides {
  int width = 0, height = 0;
  std::vector<Vec3f> position;  ///< mean over the pixel
  std::vector<Vec3f> normal;    ///< mean shading normal; shorter than 1 at edges
  std::vector<float> depth;     ///< [m]; 0: nothing there
};

/// Illumination (radiance over albedo) of every pixel by two independent halves of its samples, and
/// the variance of the mean luminance of one half.
struct Illumination {
  std::array<std::vector<Rgb>, 2> half;
  std::vector<float> variance;
};

/// Averages illumination over neighbouring pixels of the same surface, as far as their noise
/// allows: pixels that differ by more than their standard errors explain keep their own value.
/// Each half is averaged with weights from the other: weights that follow the noise of what they
/// average would favour the many dark samples over the few bright ones and lose light.
/// Edge-avoiding a-trous wavelet (Dammertz et al. 2010) guided by variance (Schied et al. 2017).
[[nodiscard]] Illumination share_illumination(const ShareGuides& guides, Illumination illumination);

}  // namespace atrium::trace
