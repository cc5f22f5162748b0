#pragma once

#include <limits>
#include <vector>

#include "picture_samples.h"

namespace atrium::trace {

/// The error measure of a picture (trace/compare.h), estimated from its own replicates.
struct ErrorEstimate {
  double value = 0.0;  ///< RMS over pixels and channels of e
  double noise = 0.0;  ///< its part by too few samples
  double bias = 0.0;   ///< its part by sharing between pixels
  double field = 0.0;  ///< its part by the field's own error; value^2 = noise^2 + bias^2 + field^2
  double least_field = 0.0;  ///< the same, 99.9 % certain to be there; 0 if it may be nothing
  /// Mean over channels of e^2 by pixel; right in the mean over many pixels only, bias_squares may
  /// be negative.
  std::vector<float> noise_squares, bias_squares;
};

/// The noise is what the replicates of a half differ by. The bias is what sharing changed in both
/// replicates alike; where the noise of single pixels hides it, its part that is common to
/// neighbouring pixels is looked for. Both are expectations of squares over many pixels: of a
/// picture of n pixels the noise is known to about sqrt(1 / n), the bias to sqrt(3 / n) of what the
/// picture would have without sharing.
/// \param expected_field  what the field's own error is thought to be before anything checks it
/// (field_error.h).
[[nodiscard]] ErrorEstimate estimate_error(
    const PictureSamples& samples, double expected_field = std::numeric_limits<double>::infinity());

/// RMS error of every pixel and channel, smoothed over 5x5 pixels: for the layers stderr.*.
[[nodiscard]] std::vector<Rgb> error_layer(const PictureSamples& samples);

}  // namespace atrium::trace
