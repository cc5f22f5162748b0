#pragma once

#include "material/fresnel.h"
#include "material/models/common.h"

namespace atrium::material {

struct CookTorranceParameters {
  double kd = 0.0, ks = 1.0;  ///< in [0, 1], kd + ks <= 1
  double rho = 0.5;           ///< body reflectance, in [0, 1]
  double m = 0.2;             ///< rms slope, in [1e-6, 100]
  double n = 1.5, k = 0.0;    ///< index relative to the incident medium, n > 0, k >= 0
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const CookTorranceParameters& parameters);

/// Beckmann's D = exp(-tan^2 delta / m^2) / (pi m^2 cos^4 delta) [1/sr]; D cos integrates to 1.
/// \param tan2  tan^2 delta.
template <class Real>
[[nodiscard]] Real beckmann_density(Real tan2, Real m) {
  const Real m2 = m * m;
  if (!(tan2 < detail::kLargestExponent<Real> * m2)) return Real(0);
  const Real c = Real(1) + tan2;  // 1 / cos^2
  return std::exp(-tan2 / m2) * (c * c) / (std::numbers::pi_v<Real> * m2);
}

/// D G / (4 (n.l)(n.b)) with Beckmann's D and the G of V-cavities: Cook-Torrance for F = 1.
template <class Real>
[[nodiscard]] Real cook_torrance_facets(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> m) {
  if (!detail::above(l, b)) return Real(0);
  const detail::Halfway<Real> q(l, b);
  return Real(0.25) * beckmann_density<Real>(q.tan2_delta(), m) *
         detail::vcavity_over_cosines(l.z(), b.z(), q);
}

/// Specular part f = F D G / (4 (n.l)(n.b)) [1/sr], with D normalised; what the 1982 article prints
/// (D without 1/pi, over pi cos cos) is four times this. Reciprocal, albedo <= 1.
/// Source: Cook & Torrance 1982; MATERIAL_MODEL 9.2.
template <class Real>
[[nodiscard]] Real cook_torrance(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> m,
                                 Scalar<Real> n, Scalar<Real> k) {
  const Real facets = cook_torrance_facets(l, b, m);
  if (!(facets > Real(0))) return Real(0);
  return facets * fresnel<Real>(detail::Halfway<Real>(l, b).cos_phi(), n, k).mean();
}

}  // namespace atrium::material
