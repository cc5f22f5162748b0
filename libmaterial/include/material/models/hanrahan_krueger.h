#pragma once

#include "material/models/common.h"

namespace atrium::material {

struct HanrahanKruegerParameters {
  double n = 1.4;     ///< index of the slab relative to both sides, > 0
  double W = 0.8;     ///< single-scattering albedo, in [0, 1]
  double taud = 1.0;  ///< optical depth, >= 0, may be infinite
  double g = 0.0;     ///< mean cosine of the phase function, in (-1, 1); > 0 forward
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const HanrahanKruegerParameters& parameters);

namespace detail {

/// 1 - F of a dielectric from outside, as sums of positive terms: accurate where F tends to 1.
template <class Real>
[[nodiscard]] Real fresnel_transmittance(Real c, Real n) {
  if (n == Real(1)) return Real(1);
  const Real g2 = (n - Real(1)) * (n + Real(1)) + c * c;
  if (!(g2 > Real(0))) return Real(0);  // total reflection
  const Real g = std::sqrt(g2), n2 = n * n;
  const Real s = g + c, p = n2 * c + g;
  return Real(2) * g * c * (Real(1) / (s * s) + n2 / (p * p));
}

/// Cosine inside a medium of relative index n; 0 where none is reached.
template <class Real>
[[nodiscard]] Real refracted_cosine(Real c, Real n) {
  if (n == Real(1)) return c;
  const Real g2 = (n - Real(1)) * (n + Real(1)) + c * c;
  return g2 > Real(0) ? std::sqrt(g2) / n : Real(0);
}

/// Henyey-Greenstein phase function [1/sr], 1 over the sphere. One of |u - v|^2 and |u + v|^2 of
/// the unit travel directions enters, so that neither peak (g -> +-1) cancels.
template <class Real>
[[nodiscard]] Real henyey_greenstein(Real minus2, Real plus2, Real g) {
  const Real a = Real(1) - std::abs(g);
  const Real d = a * a + (g >= Real(0) ? g * minus2 : -g * plus2);
  return std::numbers::inv_pi_v<Real> / Real(4) * (Real(1) - g) * (Real(1) + g) /
         (d * std::sqrt(d));
}

/// Travel directions inside: |u - v|^2 and |u + v|^2 for transverse parts given by l and b outside.
template <class Real>
struct InsideDirections {
  Real mu_i, mu_o, minus2, plus2;
  /// \param transmitted  b leaves through the far face.
  InsideDirections(const Vec3<Real>& l, const Vec3<Real>& b, Real n, bool transmitted)
      : mu_i(refracted_cosine(std::abs(l.z()), n)), mu_o(refracted_cosine(std::abs(b.z()), n)) {
    const Real inv2 = Real(1) / (n * n);
    const Real sx = l.x() + b.x(), sy = l.y() + b.y(), dx = l.x() - b.x(), dy = l.y() - b.y();
    const Real sum = mu_i + mu_o;
    // mu_i - mu_o by the difference of squares, which refraction only scales.
    const Real zl = std::abs(l.z()), zb = std::abs(b.z());
    const Real difference = sum > Real(0) ? (zl - zb) * (zl + zb) * inv2 / sum : Real(0);
    const Real parallel = transmitted ? difference : sum;  // z part of u - v
    const Real opposed = transmitted ? sum : difference;
    minus2 = (sx * sx + sy * sy) * inv2 + parallel * parallel;
    plus2 = (dx * dx + dy * dy) * inv2 + opposed * opposed;
  }
};

}  // namespace detail

/// Single scattering in a slab, reflection:
///   f = (1-F(l)) (1-F(b)) / n^2 * W p(cos gamma) / (mu_i + mu_o) * (1 - e^{-t (1/mu_i + 1/mu_o)})
/// [1/sr], mu the cosines inside. Reciprocal; albedo <= W. Internal reflections are not part of it.
/// Source: Hanrahan & Krueger 1993, sec. 5; MATERIAL_MODEL 9.5.
template <class Real>
[[nodiscard]] Real hanrahan_krueger(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> n,
                                    Scalar<Real> W, Scalar<Real> taud, Scalar<Real> g) {
  if (!detail::above(l, b) || !(taud > Real(0))) return Real(0);
  const Real through =
      detail::fresnel_transmittance<Real>(l.z(), n) * detail::fresnel_transmittance<Real>(b.z(), n);
  if (!(through > Real(0))) return Real(0);
  const detail::InsideDirections<Real> in(l, b, n, false);
  const Real sum = in.mu_i + in.mu_o;
  const Real product = in.mu_i * in.mu_o;
  // Written so that neither 0 * infinity nor an overflowing quotient can occur.
  const bool deep = taud * sum >= detail::kLargestExponent<Real> * product;
  const Real share = deep ? Real(1) : -std::expm1(-taud * (sum / product));
  return through / (n * n) * W * detail::henyey_greenstein<Real>(in.minus2, in.plus2, g) / sum *
         share;
}

/// The same slab, transmission: b below the far face (b.z < 0), the same medium on both sides:
///   f_t = (1-F(l)) (1-F(b)) / n^2 * W p(cos gamma) (e^{-t/mu_i} - e^{-t/mu_o}) / (mu_i - mu_o).
/// Symmetric under exchange of l and b with the slab turned over. The unscattered part is
/// hanrahan_krueger_straight().
template <class Real>
[[nodiscard]] Real hanrahan_krueger_transmission(const Vec3<Real>& l, const Vec3<Real>& b,
                                                 Scalar<Real> n, Scalar<Real> W, Scalar<Real> taud,
                                                 Scalar<Real> g) {
  if (!(l.z() > detail::kHorizon<Real>) || !(-b.z() > detail::kHorizon<Real>)) return Real(0);
  if (!(taud > Real(0))) return Real(0);
  const Real through = detail::fresnel_transmittance<Real>(l.z(), n) *
                       detail::fresnel_transmittance<Real>(-b.z(), n);
  if (!(through > Real(0))) return Real(0);
  const detail::InsideDirections<Real> in(l, b, n, true);
  const Real larger = std::max(in.mu_i, in.mu_o), smaller = std::min(in.mu_i, in.mu_o);
  if (taud >= detail::kLargestExponent<Real> * larger) return Real(0);
  // (e^{-t/m} - e^{-t/s}) / (m - s) = e^{-t/m} t/(m s) (1 - e^-x)/x, x = t (m - s)/(m s); m - s
  // from the squares outside.
  const Real zl = l.z(), zb = -b.z();
  const Real difference = std::abs((zl - zb) * (zl + zb)) / (n * n * (larger + smaller));
  const Real ratio = taud / larger;
  const bool steep = ratio * difference >= detail::kLargestExponent<Real> * smaller;
  const Real x = steep ? detail::kLargestExponent<Real> : ratio * (difference / smaller);
  const Real path = steep ? Real(1) / difference
                          : ratio / smaller * (x > Real(0) ? -std::expm1(-x) / x : Real(1));
  return through / (n * n) * W * detail::henyey_greenstein<Real>(in.minus2, in.plus2, g) *
         std::exp(-ratio) * path;
}

/// Weight of the ray that passes the slab unscattered, direction kept: (1-F)^2 e^{-t/mu}.
template <class Real>
[[nodiscard]] Real hanrahan_krueger_straight(Real cos_theta, Scalar<Real> n, Scalar<Real> taud) {
  const Real T = detail::fresnel_transmittance<Real>(cos_theta, n);
  const Real mu = detail::refracted_cosine<Real>(cos_theta, n);
  if (!(T > Real(0)) || taud >= detail::kLargestExponent<Real> * mu) return Real(0);
  return T * T * std::exp(-taud / mu);
}

}  // namespace atrium::material
