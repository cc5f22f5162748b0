#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/image.h"

namespace atrium::trace {

/// One error with its 95 % confidence interval; relative, 0.02 = 2 %.
struct Measure {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// One term C1..C6 (or emission) of both images, as shares of the reference's whole mean luminance.
struct TermComparison {
  std::string name;
  double share = 0.0;       ///< of the term in the reference
  double difference = 0.0;  ///< image minus reference
};

/// One class of light paths (trace/light_classes.h) of both images, as shares of the reference's
/// whole mean luminance.
struct ClassComparison {
  std::string name;
  double share = 0.0;       ///< of the class in the reference
  double difference = 0.0;  ///< image minus reference
  double interval = 0.0;    ///< half width of its 95 % confidence interval, from both stderr layers
  double rms = 0.0;  ///< of the pixels' luminance, the noise of both subtracted in quadrature
};

/// How far an image I is from a reference R.
///
/// Per pixel and channel e = (I - R) / (Y5(R) + 0.05 * median of Y(R) over lit pixels), where Y5 is
/// the mean luminance of the 5x5 pixels around (fewer at the border); the error is the RMS of e
/// over pixels and channels. Block error: the same measure of both images averaged over 8x8 pixels.
struct Comparison {
  Measure pixel;            ///< as measured
  Measure block;            ///< after 8x8 averaging
  double bias = 0.0;        ///< mean Y(I) / mean Y(R) - 1
  double bias_error = 0.0;  ///< its standard error from the stderr.* layers that are there
  double max_abs = 0.0;     ///< largest |e|
  /// The noise of the reference (its stderr.* layers) is subtracted in quadrature from the values
  /// above; without those layers nothing is and these are 0.
  bool noise_known = false;
  double pixel_noise = 0.0;  ///< RMS of the reference's standard error, same units
  double block_noise = 0.0;
  std::vector<TermComparison> terms;     ///< of layers that both images have
  std::vector<ClassComparison> classes;  ///< the same
  std::size_t pixels = 0;                ///< compared
  std::size_t pixels_skipped = 0;        ///< not finite in one of the images
};

/// \throws std::invalid_argument  if sizes differ or R, G, B are missing.
/// The confidence intervals treat tiles of 16x16 pixels (blocks: of 2x2 blocks) as independent.
/// If noise is larger than the difference the value is 0 and `high` says what is still possible.
/// Source: DESIGN section 4.
[[nodiscard]] Comparison compare(const scene::Image& image, const scene::Image& reference);

/// e by pixel and channel (R, G, B), linear and signed. \throws as compare().
[[nodiscard]] scene::Image difference_image(const scene::Image& image,
                                            const scene::Image& reference);

/// For people: a difference as display values; grey is equal, `full_scale` becomes white or black.
[[nodiscard]] scene::Image show_difference(const scene::Image& difference, double full_scale);

}  // namespace atrium::trace
