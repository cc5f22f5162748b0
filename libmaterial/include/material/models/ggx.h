#pragma once

#include "material/fresnel.h"
#include "material/models/common.h"

namespace atrium::material {

struct GgxParameters {
  double alpha = 0.3;       ///< width (glTF: roughness^2), in [1e-4, 1]
  double n = 1.5, k = 0.0;  ///< index relative to the incident medium, n > 0, k >= 0
  double f0 = -1.0;  ///< in [0, 1]: Schlick's Fresnel with this F(0) replaces n, k; -1: unused
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const GgxParameters& parameters);

/// D = alpha^2 / (pi (alpha^2 cos^2 delta + sin^2 delta)^2) [1/sr]; D cos integrates to 1.
template <class Real>
[[nodiscard]] Real ggx_density(const detail::Halfway<Real>& q, Scalar<Real> alpha) {
  const Real a2 = alpha * alpha;
  const Real ratio = q.norm2 / (q.z * q.z + q.xy2 / a2);
  return ratio * ratio / (std::numbers::pi_v<Real> * a2);
}

/// D G / (4 (n.l)(n.b)): GGX for F = 1. G is Smith's, height-correlated:
/// 1 / (1 + Lambda(l) + Lambda(b)). Reciprocal, albedo <= 1.
/// Source: Walter et al. 2007, Eq. 33; Heitz 2014, Eq. 99.
template <class Real>
[[nodiscard]] Real ggx_facets(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> alpha) {
  if (!detail::above(l, b)) return Real(0);
  const detail::Halfway<Real> q(l, b);
  const Real a2 = alpha * alpha;
  const Real nl = l.z(), nb = b.z();
  // cos (1 + 2 Lambda) = sqrt(cos^2 + alpha^2 sin^2)
  const Real to_l = nb * std::sqrt(nl * nl + a2 * detail::sin2(l));
  const Real to_b = nl * std::sqrt(nb * nb + a2 * detail::sin2(b));
  return ggx_density(q, alpha) / (Real(2) * (to_l + to_b));
}

/// f = F D G / (4 (n.l)(n.b)) [1/sr] with the exact Fresnel reflectance of n + i k.
template <class Real>
[[nodiscard]] Real ggx(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> alpha, Scalar<Real> n,
                       Scalar<Real> k) {
  const Real cos_phi = detail::Halfway<Real>(l, b).cos_phi();
  return ggx_facets(l, b, alpha) * fresnel<Real>(cos_phi, n, k).mean();
}

/// As glTF 2.0 has it: Schlick's F = f0 + (1 - f0)(1 - cos phi)^5.
template <class Real>
[[nodiscard]] Real ggx_schlick(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> alpha,
                               Scalar<Real> f0) {
  const Real cos_phi = detail::Halfway<Real>(l, b).cos_phi();
  return ggx_facets(l, b, alpha) * (f0 + (Real(1) - f0) * detail::pow5(Real(1) - cos_phi));
}

}  // namespace atrium::material
