#pragma once

#include "material/models/common.h"

namespace atrium::material {

struct OrenNayarParameters {
  double rho = 0.5;  ///< facet reflectance, in [0, 1]
  double s = 0.3;    ///< standard deviation of the facet angle [rad], in [0, 1]
  bool full = true;  ///< with masking terms and interreflection; else the qualitative model
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const OrenNayarParameters& parameters);

/// f = (rho/pi) [A + B max(0, cos psi) sin(alpha) tan(beta)] [1/sr], alpha and beta the larger and
/// the smaller polar angle. Reciprocal. rho is a facet's reflectance: the albedo is smaller at
/// normal incidence and may exceed rho slightly towards grazing angles (full: 1.05 rho, s = 0.3).
/// Source: Oren & Nayar 1994, Eq. 30; MATERIAL_MODEL 9.4.
template <class Real>
[[nodiscard]] Real oren_nayar_qualitative(const Vec3<Real>& l, const Vec3<Real>& b,
                                          Scalar<Real> rho, Scalar<Real> s) {
  if (!detail::above(l, b)) return Real(0);
  const Real s2 = s * s;
  const Real A = Real(1) - Real(0.5) * s2 / (s2 + Real(0.33L));
  const Real B = Real(0.45L) * s2 / (s2 + Real(0.09L));
  // cos(psi) sin(alpha) sin(beta) is the dot product of the projections.
  const Real projected = detail::difference_of_products(l.x(), b.x(), -l.y(), b.y());
  const Real lobe = std::max(Real(0), projected) / std::max(l.z(), b.z());
  return rho * std::numbers::inv_pi_v<Real> * (A + B * lobe);
}

/// The full model: f = (rho/pi) [C1 + cos psi C2 tan beta + (1 - |cos psi|) C3 tan((alpha+beta)/2)]
/// + 0.17 (rho^2/pi) s^2/(s^2+0.13) [1 - cos psi (2 beta/pi)^2]. Reciprocal; a fit, slightly
/// negative for dark rough surfaces where both angles graze and face each other.
/// Source: Oren & Nayar 1994, Eqs. 27 to 29; MATERIAL_MODEL 9.4.
template <class Real>
[[nodiscard]] Real oren_nayar_full(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> rho,
                                   Scalar<Real> s) {
  if (!detail::above(l, b)) return Real(0);
  const bool l_lower = l.z() < b.z();
  const Vec3<Real>& va = l_lower ? l : b;  // alpha, the larger angle
  const Vec3<Real>& vb = l_lower ? b : l;
  const Real sin_a = std::sqrt(detail::sin2(va)), sin_b = std::sqrt(detail::sin2(vb));
  const Real sines = sin_a * sin_b;
  Real cos_psi = Real(1), sin2_psi = Real(0);  // at the pole every term with psi vanishes
  if (sines > std::numeric_limits<Real>::min()) {
    const Real cross = detail::difference_of_products(l.x(), b.y(), l.y(), b.x()) / sines;
    cos_psi = detail::difference_of_products(l.x(), b.x(), -l.y(), b.y()) / sines;
    cos_psi = std::clamp(cos_psi, Real(-1), Real(1));
    sin2_psi = cross * cross;
  }
  const Real one_minus_cos = sin2_psi / (Real(1) + std::abs(cos_psi));  // 1 - |cos psi|
  constexpr Real two_over_pi = Real(2) * std::numbers::inv_pi_v<Real>;
  const Real x = two_over_pi * std::atan2(sin_b, vb.z());     // 2 beta / pi
  const Real y = two_over_pi * std::atan2(sin_a, va.z());     // 2 alpha / pi
  const Real rest = two_over_pi * std::atan2(vb.z(), sin_b);  // 1 - x, accurate at grazing angles
  // tan of half the sum of the angles, by the sum of sines over the sum of cosines.
  const Real tan_half = (sin_a + sin_b) / (va.z() + vb.z());
  const Real s2 = s * s, s2_009 = s2 + Real(0.09L);
  const Real C1 = Real(1) - Real(0.5) * s2 / (s2 + Real(0.33L));
  // sin(alpha) - x^3 = [1 - (1 - rest)^3] - [1 - sin(alpha)]: both tend to 0 at grazing angles.
  const Real below =
      rest * (Real(3) + rest * (rest - Real(3))) - va.z() * va.z() / (Real(1) + sin_a);
  const Real C2 = Real(0.45L) * s2 / s2_009 * (cos_psi >= Real(0) ? sin_a : below);
  const Real C3 = Real(0.125) * s2 / s2_009 * (x * y) * (x * y);
  const Real direct = C1 + cos_psi * C2 * (sin_b / vb.z()) + one_minus_cos * C3 * tan_half;
  const Real twice = Real(0.17L) * s2 / (s2 + Real(0.13L)) * (Real(1) - cos_psi * x * x);
  return rho * std::numbers::inv_pi_v<Real> * (direct + rho * twice);
}

}  // namespace atrium::material
