#pragma once

#include "material/models/common.h"

namespace atrium::material {

struct LambertParameters {
  double rho = 0.5;  ///< reflectance, in [0, 1]
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const LambertParameters& parameters);

/// Lambert 1760: f = rho / pi [1/sr]. Albedo rho.
/// All models: l to the light, b to the viewer; 0 unless both are above the horizon.
template <class Real>
[[nodiscard]] Real lambert(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> rho) {
  return detail::above(l, b) ? rho * std::numbers::inv_pi_v<Real> : Real(0);
}

}  // namespace atrium::material
