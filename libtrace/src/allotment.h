#pragma once

#include <cstdint>
#include <vector>

namespace atrium::trace {

/// What is known of every pixel when the next round is planned.
struct PixelCosts {
  int width = 0, height = 0;
  std::vector<float> noise;          ///< e^2 by noise now, itself uncertain
  std::vector<float> bias;           ///< e^2 by sharing: very uncertain, may be negative
  std::vector<std::uint32_t> count;  ///< samples so far, at least 1
  std::vector<float> cost;           ///< of one sample [rays]
};

struct RoundLimits {
  double goal = 0.0;       ///< RMS of e
  double growth = 2.0;     ///< most that the cost of the whole picture may be multiplied by
  std::uint32_t most = 0;  ///< samples of a pixel
};

/// Number of samples that every pixel should have after the next round, multiples of kReplicates
/// above what it has (or the same).
///
/// e^2 of a pixel is taken to fall as a / n; sum a / n at a cost of sum c n is least for n
/// proportional to sqrt(a / c) (Neyman 1934). a is what a pixel's neighbours have - never its own
/// samples, so that the number of samples says nothing about their mean - near by and, as prior for
/// light that few samples find, in the wider region.
[[nodiscard]] std::vector<std::uint32_t> allot_samples(const PixelCosts& pixels,
                                                       const RoundLimits& limits);

}  // namespace atrium::trace
