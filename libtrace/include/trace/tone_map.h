#pragma once

#include <optional>

#include "scene/image.h"

namespace atrium::trace {

struct ToneMapOptions {
  enum class Curve {
    Filmic,  ///< soft shoulder and toe; middle grey 0.18 stays 0.18
    Srgb     ///< linear up to 1, then cut
  };
  Curve curve = Curve::Filmic;
  /// Exposure value at ISO 100: the luminance 1.2 * 2^ev [cd/m^2] becomes 1 before the curve
  /// (sunlit street 15, office 7, evening room 4). One more halves the brightness. Absent:
  /// automatic.
  std::optional<double> ev;
};

/// Exposure value that suits an image. The mean of log Y between the 20th and the 95th percentile
/// of the lit pixels becomes middle grey, 0.18: lamps in view and dark corners do not decide.
/// \param image  channels R, G, B [unit of the scene; nit if an absolute value shall mean
/// anything]. 0 for an image without light; non-finite pixels do not count. \throws
/// std::invalid_argument  without R, G, B.
[[nodiscard]] double automatic_ev(const scene::Image& image);

/// The luminance that becomes 1 before the curve, 1.2 * 2^ev [unit of the scene].
[[nodiscard]] double white_at(double ev);

/// Linear image to display values: exposure, curve per channel, sRGB encoding.
/// Returns R, G, B in [0, 1], ready for 8 bits; non-finite pixels become 0.
/// \throws std::invalid_argument  without R, G, B.
/// Source: exposure ISO 2720 / saturation speed ISO 12232; curve Narkowicz 2015 (fit of the ACES
/// reference transform); encoding IEC 61966-2-1.
[[nodiscard]] scene::Image tone_map(const scene::Image& image, const ToneMapOptions& options = {});

/// The filmic curve, for x >= 0; increases from 0 to 1.
[[nodiscard]] double filmic_curve(double x);

}  // namespace atrium::trace
