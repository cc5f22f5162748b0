#pragma once

#include "material/models/common.h"
#include "material/models/phong.h"

namespace atrium::material {

/// C(p) that makes the albedo of C (n.h)^p exactly 1 at normal incidence. With b = n, l at 2 delta
/// and dw_l = 4 cos(delta) dw_h:
///   integral of (n.h)^p (n.l) dw_l = 8 pi * integral_{1/sqrt 2}^{1} t^(p+1) (2 t^2 - 1) dt
///                                  = 8 pi (p + 2^(-p/2)) / ((p + 2) (p + 4)).
/// Off normal the albedo is smaller (about cos^2 for large p): (n.h)^p without 1/(cos cos) darkens
/// towards grazing angles. C(0) = 1/pi, C -> (p + 6) / (8 pi) for large p.
template <class Real>
[[nodiscard]] Real blinn_phong_norm(Real p) {
  const Real pole = p + std::exp2(Real(-0.5) * p);
  return (p + Real(2)) * ((p + Real(4)) / (Real(8) * std::numbers::pi_v<Real> * pole));
}

/// f = kd / pi + ks C(p) (n.h)^p [1/sr]. Reciprocal; albedo <= kd + ks (kd, ks, p as Phong's).
/// Source: Blinn 1977, normalised here.
template <class Real>
[[nodiscard]] Real blinn_phong(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> kd,
                               Scalar<Real> ks, Scalar<Real> p) {
  if (!detail::above(l, b)) return Real(0);
  const detail::Halfway<Real> q(l, b);
  return kd * std::numbers::inv_pi_v<Real> +
         ks * blinn_phong_norm<Real>(p) * detail::cosine_power(q.xy2, q.z, p);
}

}  // namespace atrium::material
