#pragma once

#include <array>
#include <functional>
#include <vector>

#include "material/frame.h"
#include "material/spectrum.h"
#include "picture_samples.h"

namespace atrium::trace {

/// What the first surface of each pixel looks like: where samples may be shared.
struct ShareGuides {
  int width = 0, height = 0;
  // By pixel, row by row; vectors number by number, as weights are found for many pixels at once.
  std::array<std::vector<float>, 3> positions = {};  ///< mean over the pixel
  std::array<std::vector<float>, 3> normals = {};  ///< mean shading normal; shorter than 1 at edges
  std::vector<float> depth = {};                   ///< [m]; 0: nothing there to share

  [[nodiscard]] bool shows_body(std::size_t pixel) const { return depth[pixel] > 0.0f; }

  /// The next pixel.
  void add(const Vec3f& position, const Vec3f& normal, float depth_there) {
    for (std::size_t c = 0; c < 3; ++c) {
      positions[c].push_back(position[static_cast<int>(c)]);
      normals[c].push_back(normal[static_cast<int>(c)]);
    }
    depth.push_back(depth_there);
  }
  [[nodiscard]] Vec3f position(std::size_t pixel) const {
    return {positions[0][pixel], positions[1][pixel], positions[2][pixel]};
  }
  [[nodiscard]] Vec3f normal(std::size_t pixel) const {
    return {normals[0][pixel], normals[1][pixel], normals[2][pixel]};
  }
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
[[nodiscard]] Illumination share_illumination(const ShareGuides& guides,
                                              const Illumination& illumination);

/// The light averaged by 1, 3 and 5 levels of wavelets. \param most  no more levels than that.
void share_by_levels(const ShareGuides& guides, const Illumination& illumination, int most,
                     const std::function<void(Illumination&&)>& take);
inline constexpr int kShareLevels = 5;  // reach: 2 * (1 + 2 + 4 + 8 + 16) pixels

}  // namespace atrium::trace
