#pragma once

#include <algorithm>
#include <cmath>

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
/// Exact over the whole domain, total reflection included (k = 0: Blinn's dielectric form).
/// n = 1 and k = 0 reflects nothing at any angle; otherwise F(90 deg) = 1.
/// Source: MATERIAL_MODEL Eq. F2; Born & Wolf, sec. 14.2.
template <class Real>
[[nodiscard]] FresnelTerms<Real> fresnel(Real c, Real n, Real k);

/// Dielectric only, k = 0: Blinn 1977 in the form that keeps relative accuracy for n -> 1.
template <class Real>
[[nodiscard]] FresnelTerms<Real> fresnel_dielectric(Real c, Real n);

/// Cosine mean over the hemisphere, 2 * integral of F(mu) mu dmu.
[[nodiscard]] double fresnel_mean(double n, double k);

// ---- inline ----

template <class Real>
FresnelTerms<Real> fresnel_dielectric(Real c, Real n) {
  c = std::clamp(c, Real(0), Real(1));
  if (n == Real(1)) return {Real(0), Real(0)};
  // Of the two equal forms the one whose terms cancel less.
  const Real g2 =
      n < c ? n * n - (Real(1) - c) * (Real(1) + c) : (n - Real(1)) * (n + Real(1)) + c * c;
  if (!(g2 > Real(0))) return {Real(1), Real(1)};  // total reflection
  const Real g = std::sqrt(g2);
  const Real gc = g + c;
  const Real a = (n - Real(1)) * (n + Real(1)) / (gc * gc);  // (g - c) / (g + c)
  const Real gmc = (n - Real(1)) * (n + Real(1)) / gc;       // g - c
  const Real b = (c * gc - Real(1)) / (c * gmc + Real(1));
  return {a * a, a * a * b * b};
}

template <class Real>
FresnelTerms<Real> fresnel(Real c, Real n, Real k) {
  if (k == Real(0)) return fresnel_dielectric(c, n);
  c = std::clamp(c, Real(0), Real(1));
  const Real s2 = (Real(1) - c) * (Real(1) + c);
  const Real t = (n - k) * (n + k) - s2;
  const Real A = std::hypot(t, Real(2) * n * k);
  const Real big = std::sqrt(Real(0.5) * (A + std::abs(t)));
  const Real small = big > Real(0) ? n * k / big : Real(0);
  const Real a = t >= Real(0) ? big : small;
  const Real b = t >= Real(0) ? small : big;
  const Real rs = ((a - c) * (a - c) + b * b) / ((a + c) * (a + c) + b * b);
  const Real ac = a * c;
  const Real bc = b * c;
  const Real q = ((ac - s2) * (ac - s2) + bc * bc) / ((ac + s2) * (ac + s2) + bc * bc);
  return {rs, rs * q};
}

}  // namespace atrium::material
