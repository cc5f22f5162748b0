#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "material/frame.h"

namespace atrium::material {

/// A parameter beside vectors: converts to their scalar type instead of taking part in deduction.
template <class Real>
using Scalar = std::type_identity_t<Real>;

/// What the comparison models share. Directions are unit and point away from the surface, z is the
/// normal. The halfway vector is used un-normalised, q = l + b: each of its components is one
/// rounded sum, so that ratios of them (tan delta) keep full relative accuracy next to the mirror
/// direction and |q| / 2 is the cosine of the facet's angle of incidence without cancellation.
namespace detail {

/// Smallest cosine that still counts as above the horizon; 1 / cos^2 times the highest permitted
/// peak of a lobe stays finite.
template <class Real>
inline constexpr Real kHorizon = std::is_same_v<Real, float> ? Real(1e-13L) : Real(1e-60L);

/// Exponents beyond this give 0: e^-x is below the smallest normal number.
template <class Real>
inline constexpr Real kLargestExponent = std::is_same_v<Real, float> ? Real(87) : Real(708);

template <class Real>
[[nodiscard]] bool above(const Vec3<Real>& l, const Vec3<Real>& b) {
  return l.z() > kHorizon<Real> && b.z() > kHorizon<Real>;  // false for NaN
}

/// e^-x for x >= 0, exactly 0 where the result would be subnormal.
template <class Real>
[[nodiscard]] Real exp_minus(Real x) {
  return x < kLargestExponent<Real> ? std::exp(-x) : Real(0);
}

/// a b - c d to about one rounding (Kahan): products of float are exact in double, those of double
/// are corrected by fused multiply-add.
template <class Real>
[[nodiscard]] Real difference_of_products(Real a, Real b, Real c, Real d) {
  if constexpr (std::is_same_v<Real, float>) {
    return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) -
                              static_cast<double>(c) * static_cast<double>(d));
  } else {
    const Real cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
  }
}

/// max(0, cos)^p of the angle between two vectors with |cross product|^2 and dot product given:
/// independent of their lengths, relative error about (1 - p ln cos) roundings. 0^0 = 1.
template <class Real>
[[nodiscard]] Real cosine_power(Real cross2, Real dot, Real p) {
  if (p == Real(0)) return Real(1);
  if (!(dot > std::numeric_limits<Real>::min())) return Real(0);
  const Real dot2 = dot * dot;
  const Real log_cos = cross2 < dot2 ? Real(-0.5) * std::log1p(cross2 / dot2)
                                     : std::log(dot / std::sqrt(cross2 + dot2));
  return exp_minus(-p * log_cos);
}

/// q = l + b.
template <class Real>
struct Halfway {
  Real x, y, z;
  Real xy2;    ///< x^2 + y^2
  Real norm2;  ///< |q|^2
  Halfway(const Vec3<Real>& l, const Vec3<Real>& b)
      : x(l.x() + b.x()),
        y(l.y() + b.y()),
        z(l.z() + b.z()),
        xy2(x * x + y * y),
        norm2(xy2 + z * z) {}
  [[nodiscard]] Real cos_phi() const { return std::min(Real(1), Real(0.5) * std::sqrt(norm2)); }
  [[nodiscard]] Real tan2_delta() const { return xy2 / (z * z); }
};

/// G / ((n.l)(n.b)) with the G of V-cavities, min(1, 2 (n.h)(n.b)/(b.h), 2 (n.h)(n.l)/(b.h)):
/// finite at grazing angles, where G / cos stays bounded.
template <class Real>
[[nodiscard]] Real vcavity_over_cosines(Real nl, Real nb, const Halfway<Real>& q) {
  // (n.h)/(b.h) = 2 q_z / |q|^2; the smaller of the two ratios belongs to the larger cosine.
  return Real(1) / std::max(nl * nb, std::max(nl, nb) * (q.norm2 / (Real(4) * q.z)));
}

template <class Real>
[[nodiscard]] Real pow5(Real x) {
  const Real x2 = x * x;
  return x2 * x2 * x;
}

/// x^2 + y^2 = sin^2 of the polar angle, without the cancellation of 1 - z^2.
template <class Real>
[[nodiscard]] Real sin2(const Vec3<Real>& v) {
  return v.x() * v.x() + v.y() * v.y();
}

}  // namespace detail
}  // namespace atrium::material
