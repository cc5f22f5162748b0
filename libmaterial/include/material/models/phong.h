#pragma once

#include "material/models/common.h"

namespace atrium::material {

struct PhongParameters {
  double kd = 0.5;  ///< in [0, 1]
  double ks = 0.5;  ///< in [0, 1], kd + ks <= 1
  double p = 20.0;  ///< exponent, in [0, 1e8]
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const PhongParameters& parameters);

/// max(0, r.b)^p, r = 2 (n.l) n - l the mirror image of l. Symmetric in l and b. The angle is taken
/// from cross and dot product, so that a high exponent does not magnify rounding.
template <class Real>
[[nodiscard]] Real phong_cosine_power(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> p) {
  const Vec3<Real> r(-l.x(), -l.y(), l.z());
  const Real x = detail::difference_of_products(r.y(), b.z(), r.z(), b.y());
  const Real y = detail::difference_of_products(r.z(), b.x(), r.x(), b.z());
  const Real z = detail::difference_of_products(r.x(), b.y(), r.y(), b.x());
  return detail::cosine_power(x * x + y * y + z * z, r.dot(b), p);
}

/// The original: light sent to the viewer per source intensity, kd (n.l) + ks max(0, r.b)^p, cosine
/// included. Not a BRDF: neither reciprocal nor energy conserving (p < 1 may return up to 2 ks).
/// Source: Phong 1975; MATERIAL_MODEL 9.1.
template <class Real>
[[nodiscard]] Real phong_1975(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> kd,
                              Scalar<Real> ks, Scalar<Real> p) {
  return detail::above(l, b) ? kd * l.z() + ks * phong_cosine_power(l, b, p) : Real(0);
}

/// Energy-normalised: f = kd / pi + ks (p + 2) / (2 pi) max(0, r.b)^p [1/sr]. Reciprocal; albedo
/// <= kd + ks, reached by the lobe at normal incidence only. Source: Lafortune & Willems 1994.
template <class Real>
[[nodiscard]] Real phong_lafortune(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> kd,
                                   Scalar<Real> ks, Scalar<Real> p) {
  if (!detail::above(l, b)) return Real(0);
  const Real lobe = Real(0.5) * (p + Real(2)) * phong_cosine_power(l, b, p);
  return (kd + ks * lobe) * std::numbers::inv_pi_v<Real>;
}

}  // namespace atrium::material
