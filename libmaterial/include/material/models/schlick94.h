#pragma once

#include "material/models/common.h"

namespace atrium::material {

struct Schlick1994Parameters {
  double f0 = 0.04;  ///< reflectance at normal incidence, in [0, 1]
  double r = 0.3;    ///< roughness, in [0, 1]: 0 mirror, 1 Lambertian
  double p = 1.0;    ///< isotropy, in [1e-4, 1]; 1 isotropic, small: stretched across x
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const Schlick1994Parameters& parameters);

/// Shares of the light by roughness: a Lambertian, b lobe, mirror; a + b + mirror = 1.
template <class Real>
struct Schlick1994Shares {
  Real diffuse, lobe, mirror;
  explicit Schlick1994Shares(Real r)
      : diffuse(r < Real(0.5) ? Real(0) : (Real(2) * r - Real(1)) * (Real(2) * r - Real(1))),
        lobe(Real(4) * r * (Real(1) - r)),
        mirror(r < Real(0.5) ? (Real(1) - Real(2) * r) * (Real(1) - Real(2) * r) : Real(0)) {}
};

template <class Real>
struct Schlick1994 {
  Real f;      ///< BRDF [1/sr] without the mirror part
  Real dirac;  ///< mirror weight S_u m_d of this pair; the mirror reflectance if l mirrors b
};

namespace detail {

/// A^2 = p / (p^2 - p^2 w^2 + w^2), w^2 = q_x^2 / (q_x^2 + q_y^2). At the pole, where the azimuth
/// has no meaning, w = 1.
template <class Real>
[[nodiscard]] Real schlick1994_azimuth(const Halfway<Real>& q, Real p) {
  if (!(p * p * q.xy2 > std::numeric_limits<Real>::min())) return p;
  return p * q.xy2 / (p * q.y * (p * q.y) + q.x * q.x);
}

/// D_d of Schlick 1994: facets seen unobstructed plus the Lambertian rest.
template <class Real>
[[nodiscard]] Real schlick1994_lobe(Real nl, Real nb, const Halfway<Real>& q, Real r, Real p) {
  const Real den_l = r + (Real(1) - r) * nl, den_b = r + (Real(1) - r) * nb;  // G = v / den
  // 1 - G(l) G(b) without cancellation.
  const Real blocked_l = r * (Real(1) - nl) / den_l, blocked_b = r * (Real(1) - nb) / den_b;
  const Real blocked = blocked_l + nl / den_l * blocked_b;
  const Real z = (r * q.z * q.z + q.xy2) / q.norm2;  // r t^2 + 1 - t^2
  const Real Z = r / (z * z);
  const Real A = std::sqrt(schlick1994_azimuth(q, p));
  return (Z * A / (Real(4) * den_l * den_b) + blocked) * std::numbers::inv_pi_v<Real>;
}

}  // namespace detail

/// f = S_u [a/pi + b D_d], S_u = f0 + (1 - f0)(1 - b.h)^5, with the azimuth of h counted from x.
/// Reciprocal. Albedo <= 1 at normal incidence, but above 1 towards grazing angles (1.57 for F = 1,
/// r = 0.3): G(l) G(b) Z A / (4 (n.l)(n.b)) is not normalised. r = 0 leaves the mirror only.
/// Source: Schlick 1994; MATERIAL_MODEL 9.6.
template <class Real>
[[nodiscard]] Schlick1994<Real> schlick1994(const Vec3<Real>& l, const Vec3<Real>& b,
                                            Scalar<Real> f0, Scalar<Real> r, Scalar<Real> p) {
  if (!detail::above(l, b)) return {Real(0), Real(0)};
  const detail::Halfway<Real> q(l, b);
  const Schlick1994Shares<Real> share(r);
  const Real S = f0 + (Real(1) - f0) * detail::pow5(Real(1) - q.cos_phi());
  Real f = share.diffuse * std::numbers::inv_pi_v<Real>;
  if (share.lobe > Real(0)) f += share.lobe * detail::schlick1994_lobe<Real>(l.z(), b.z(), q, r, p);
  return {S * f, S * share.mirror};
}

}  // namespace atrium::material
