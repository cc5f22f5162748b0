#include "material/off_specular.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace atrium::material {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

/// ln f_s in the plane of incidence, up to a constant: the facet at delta = (theta_r - theta_i)/2
/// is met under phi = (theta_r + theta_i)/2, so that
///   f_s ~ exp(-c^2 delta^2) min(1/cos theta_r, 2 cos delta / cos phi,
///                               2 cos delta cos theta_i / (cos phi cos theta_r)).
struct Lobe {
  double c, theta_i;

  /// Which of the three is smallest: 0 open, 1 masked towards the viewer, 2 shadowed.
  [[nodiscard]] int piece(double theta_r) const {
    const double delta = 0.5 * (theta_r - theta_i), phi = 0.5 * (theta_r + theta_i);
    const double facing = 2.0 * std::cos(delta) / std::cos(phi);
    const double cos_r = std::cos(theta_r), cos_i = std::cos(theta_i);
    if (facing * std::min(cos_r, cos_i) >= 1.0) return 0;
    return cos_r <= cos_i ? 1 : 2;
  }
  [[nodiscard]] double slope(double theta_r) const {
    const double delta = 0.5 * (theta_r - theta_i), phi = 0.5 * (theta_r + theta_i);
    const double gauss = -c * c * delta;
    const double facing = 0.5 * (std::tan(phi) - std::tan(delta));
    switch (piece(theta_r)) {
      case 0:
        return gauss + std::tan(theta_r);
      case 1:
        return gauss + facing;
      default:
        return gauss + facing + std::tan(theta_r);
    }
  }
  [[nodiscard]] double log_value(double theta_r) const {
    const double delta = 0.5 * (theta_r - theta_i), phi = 0.5 * (theta_r + theta_i);
    const double facing = std::log(2.0 * std::cos(delta) / std::cos(phi));
    const double open = -std::log(std::max(std::cos(theta_r), std::numeric_limits<double>::min()));
    const int at = piece(theta_r);
    const double shadow = std::log(std::cos(theta_i));
    const double factor = at == 0 ? open : at == 1 ? facing : facing + open + shadow;
    return factor - c * c * delta * delta;
  }
};

void require(bool good, const char* name, double value, const char* range) {
  if (!good)
    throw std::invalid_argument(std::string("off_specular_peak: ") + name + " is " +
                                std::to_string(value) + ", must be in " + range);
}

}  // namespace

double off_specular_peak(double c, double theta_i) {
  require(c >= 0.0 && c <= 1e6, "c", c, "[0, 1e6]");
  require(theta_i >= 0.0 && theta_i < kHalfPi, "theta_i", theta_i, "[0, pi/2)");
  const Lobe lobe{c, theta_i};
  // f_s is not larger on the side of the light. Maxima are where the slope turns negative, also
  // in the kinks between the pieces; the last one is the horizon itself.
  constexpr int kSteps = 512;
  double best = kHalfPi;
  double best_value = lobe.slope(kHalfPi) > 0.0 ? lobe.log_value(kHalfPi)
                                                : -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    double low = kHalfPi * i / kSteps, high = kHalfPi * (i + 1) / kSteps;
    if (!(lobe.slope(low) > 0.0) || lobe.slope(high) > 0.0) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (lobe.slope(middle) > 0.0 ? low : high) = middle;
    }
    if (lobe.log_value(low) > best_value) {
      best = low;
      best_value = lobe.log_value(low);
    }
  }
  // A peak at the normal itself (theta_i = 0, smooth enough) is no change of sign from the left.
  return lobe.slope(0.0) <= 0.0 && lobe.log_value(0.0) >= best_value ? 0.0 : best;
}

}  // namespace atrium::material
