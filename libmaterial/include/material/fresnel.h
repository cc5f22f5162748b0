#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace atrium::material {

/// Reflectances of the two polarisations; unpolarised light sees their mean.
template <class Real>
struct FresnelTerms {
  Real s, p;
  [[nodiscard]] Real mean() const { return Real(0.5) * (s + p); }
};

/// Fresnel reflectance of a smooth interface to a medium of relative complex index n + i k.
///
/// \param c  cosine of the angle of incidence, clamped to [0, 1].
/// \param n  n_transmitted / n_incident, > 0.  \param k  n kappa, relative too, >= 0.
/// Exact over the whole domain, total reflection included. n = 1 and k = 0 reflects nothing at any
/// angle; otherwise F(90 deg) = 1. Relative error of s and of the mean, for exactly these
/// arguments, next to total reflection and to n = 1 too: 3e-15 in double, 1e-6 in float; of p: the
/// same relative to the mean (its zero at Brewster's angle keeps no digits). n and k above 1e9
/// (float) or 1e70 (double) count as that.
/// Source: docs/materials.md, Eq. F2; Born & Wolf, sec. 14.2.
template <class Real>
[[nodiscard]] FresnelTerms<Real> fresnel(Real c, Real n, Real k);

/// The same for k = 0 (Blinn 1977, docs/materials.md, Eq. F1).
template <class Real>
[[nodiscard]] FresnelTerms<Real> fresnel_dielectric(Real c, Real n);

/// Unpolarised reflectance, (s + p) / 2 of fresnel(), in one piece and without a difference of
/// nearly equal terms: the cheapest exact form. Same domain and errors.
/// Source: docs/materials.md, Eq. F5.
template <class Real>
[[nodiscard]] Real fresnel_unpolarised(Real c, Real n, Real k);

/// Cosine mean over the hemisphere, 2 * integral of F(mu) mu dmu, to 1e-10.
[[nodiscard]] double fresnel_mean(double n, double k);

// ---- inline ----

namespace fresnel_detail {

/// Keeps fourth powers (double) or squares (float) from overflowing.
template <class Real>
inline constexpr Real kLargestIndex = std::numeric_limits<Real>::max_exponent > 200 ? Real(1e70)
                                                                                    : Real(1e9);

/// n^2 - k^2 - s^2 = (n - 1)(n + 1) + (c - k)(c + k), s the sine, to a few roundings of itself.
[[nodiscard]] inline double refracted_square(double c, double n, double k) {
  const double u = (n - 1.0) * (n + 1.0);
  const double t = u + (c - k) * (c + k);
  if (std::abs(t) > 0.125 * std::abs(u)) return t;
  // Next to total reflection the two cancel, and F follows the root of what is left: sum the exact
  // squares with their rounding errors. [Ogita, Rump & Oishi 2005, algorithm 4.4]
  double sum = -1.0, lost = 0.0;
  const auto add_square = [&](double x, double sign) {
    const double square = x * x;
    const double term = sign * square;
    const double next = sum + term;
    const double part = next - sum;
    lost += (sum - (next - part)) + (term - part) + sign * std::fma(x, x, -square);
    sum = next;
  };
  add_square(n, 1.0);
  add_square(c, 1.0);
  add_square(k, -1.0);
  return sum + lost;
}
[[nodiscard]] inline float refracted_square(float c, float n, float k) {
  const double cd = c, nd = n, kd = k;  // squares of float are exact in double
  return static_cast<float>((nd * nd - 1.0) + (cd * cd - kd * kd));
}

/// The arguments in their domain and sqrt(N^2 - s^2) = a + i b, without cancellation in a or b.
template <class Real>
struct Refraction {
  Real c, n, k, s2, a, b, modulus;  ///< modulus: |N^2 - s^2| = a^2 + b^2

  Refraction(Real c_in, Real n_in, Real k_in)
      : c(std::clamp(c_in, Real(0), Real(1))),
        n(std::min(n_in, kLargestIndex<Real>)),
        k(std::min(k_in, kLargestIndex<Real>)) {
    s2 = (Real(1) - c) * (Real(1) + c);
    const Real t = refracted_square(c, n, k);
    const Real nk = n * k;
    modulus = std::sqrt(t * t + Real(4) * nk * nk);
    const Real big = std::sqrt(Real(0.5) * (modulus + std::abs(t)));
    const Real small = nk / (big + std::numeric_limits<Real>::min());  // 0 where both are
    a = t >= Real(0) ? big : small;
    b = t >= Real(0) ? small : big;
  }
  /// |N^2 - 1|^2 / x^2 = |N - 1|^2 |N + 1|^2 / x^2; x = 0, where everything underflows, gives 0.
  [[nodiscard]] Real contrast(Real x) const {
    const Real minus = (n - Real(1)) * (n - Real(1)) + k * k;
    const Real plus = (n + Real(1)) * (n + Real(1)) + k * k;
    x += Real(4) * std::numeric_limits<Real>::min();
    return (minus / x) * (plus / x);
  }
};

}  // namespace fresnel_detail

template <class Real>
FresnelTerms<Real> fresnel_dielectric(Real c, Real n) {
  if (n == Real(1)) return {Real(0), Real(0)};
  c = std::clamp(c, Real(0), Real(1));
  n = std::min(n, fresnel_detail::kLargestIndex<Real>);
  const Real g2 = fresnel_detail::refracted_square(c, n, Real(0));
  if (!(g2 > Real(0)) || c == Real(0)) return {Real(1), Real(1)};  // total reflection, grazing
  const Real g = std::sqrt(g2);
  const Real s2 = (Real(1) - c) * (Real(1) + c);
  const Real rs = (n - Real(1)) / (g + c) * ((n + Real(1)) / (g + c));  // (g - c) / (g + c)
  const Real q = (c * g - s2) / (c * g + s2);
  const Real rs2 = std::min(rs * rs, Real(1));
  return {rs2, rs2 * q * q};
}

template <class Real>
FresnelTerms<Real> fresnel(Real c, Real n, Real k) {
  if (k == Real(0)) return fresnel_dielectric(c, n);
  if (!(c > Real(0))) return {Real(1), Real(1)};
  const fresnel_detail::Refraction<Real> w(c, n, k);
  // |w - c| / |w + c| loses what it has near N = 1; (w - c)(w + c) = N^2 - 1 does not.
  const Real rs = std::min(w.contrast((w.a + w.c) * (w.a + w.c) + w.b * w.b), Real(1));
  const Real ac = w.a * w.c;
  const Real bc = w.b * w.c;
  constexpr Real tiny = std::numeric_limits<Real>::min();  // never 0 / 0
  const Real q =
      ((ac - w.s2) * (ac - w.s2) + bc * bc + tiny) / ((ac + w.s2) * (ac + w.s2) + bc * bc + tiny);
  return {rs, rs * q};
}

template <class Real>
Real fresnel_unpolarised(Real c, Real n, Real k) {
  if (n == Real(1) && k == Real(0)) return Real(0);
  if (!(c > Real(0))) return Real(1);
  const fresnel_detail::Refraction<Real> w(c, n, k);
  const Real e = Real(2) * w.a * w.c;
  // Never 0 / 0, as for c = 1 and an index whose square underflows.
  const Real p = w.modulus * w.c * w.c + w.s2 * w.s2 + std::numeric_limits<Real>::min();
  return std::min(w.contrast(w.modulus + w.c * w.c + e) * (p / (p + e * w.s2)), Real(1));
}

}  // namespace atrium::material
