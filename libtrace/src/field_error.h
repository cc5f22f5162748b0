#pragma once

#include <vector>

#include "picture_samples.h"

namespace atrium::trace {

/// What the field's own error adds to a picture's mean of e^2, and how certain that is.
struct FieldSquare {
  double mean = 0.0;   ///< right in the mean, so it may be negative
  double error = 0.0;  ///< its standard error
};

/// What this says of the mean of e^2 to somebody who expects an RMS error of about `expected`: the
/// mean of the posterior distribution, with an exponential prior of mean expected^2 and the
/// measurement's error taken as normal. A measurement that is far more certain than that counts as
/// it is, at least 0; one that is far less certain counts little. Expecting infinity, nothing is
/// known before; nor is it if the measurement has no error.
[[nodiscard]] double likely_square(const FieldSquare& measured, double expected);

/// The samples that check the field say how much light each pixel misses or has too much
/// (PictureSamples::missed), right in the mean but very noisy. The field's error has little detail
/// - gather rays from neighbouring pixels end in the same places - so means over regions tell it:
/// products of two independent replicates of such a mean have its square as expectation. Small
/// regions miss less of it, large ones are less noisy: the smallest are taken whose noise is small
/// beside the rest of the picture's e^2.
/// \param scale  by pixel (error_scale.h). \param other  the rest.
[[nodiscard]] FieldSquare field_square(const PictureSamples& samples,
                                       const std::vector<double>& scale, double other);

}  // namespace atrium::trace
