#pragma once

#include <array>
#include <vector>

#include "material/frame.h"
#include "material/spectrum.h"
#include "picture_samples.h"

namespace atrium::trace {

/// What the first surface of each pixel looks like: where samples may be shared.
struct ShareGuides {
  int width = 0, height = 0;
  std::vector<Vec3f> position;  ///< mean over the pixel
  std::vector<Vec3f> normal;    ///< mean shading normal; shorter than 1 at edges
  std::vector<float> depth;     ///< [m]; 0: nothing there
};

/// Illumination (radiance over albedo) of every pixel by independent replicates, and the variance
/// of the mean luminance of one half of them (0 and 1, or 2 and 3).
struct Illumination {
  std::array<std::vector<Rgb>, kReplicates> replicate;
  std::vector<float> variance;
};

/// Averages illumination over neighbouring pixels of the same surface, as far as their noise
/// allows: pixels that differ by more than their standard errors explain keep their own value.
///
/// Each half is averaged with weights that know nothing of it: they come from the other half,
/// averaged by its own weights. So what comes out is, given the weights, linear in the replicates:
/// it loses no light where few samples are bright and many dark, the two replicates of a half stay
/// independent, and what they differ by is the noise that is left.
/// Edge-avoiding a-trous wavelet (Dammertz et al. 2010) guided by variance (Schied et al. 2017).
[[nodiscard]] Illumination share_illumination(const ShareGuides& guides, Illumination illumination);

/// The light as it is and averaged by more and more levels of wavelets, up to all of them.
[[nodiscard]] std::vector<Illumination> share_by_levels(const ShareGuides& guides,
                                                        Illumination illumination);

}  // namespace atrium::trace
