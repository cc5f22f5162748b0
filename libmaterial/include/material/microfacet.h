#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "material/frame.h"

namespace atrium::material {

/// N(c) = 1 / (pi I(c)), I = integral of exp(-c^2 d^2) sin(2 d) over [0, pi/2], to 1e-13 relative
/// for c in [0, 1e6].
[[nodiscard]] double gaussian_facets_norm(double c);

/// Share of the projected facet area with an angle below delta [rad]: the distribution function of
/// delta under the density D cos(delta).
[[nodiscard]] double gaussian_facets_cdf(double c, double delta);

/// Angle between a vector of any length and the z axis, in [0, pi]; keeps its digits near 0.
template <class Real>
[[nodiscard]] Real angle_to_normal(const Vec3<Real>& h) {
  return std::atan2(std::sqrt(h.x() * h.x() + h.y() * h.y()), h.z());
}

/// The paper's facet distribution D(delta) = N(c) exp(-c^2 delta^2), delta the angle between facet
/// and surface normal [rad], normalised so that D cos(delta) integrates to 1 over the hemisphere.
/// Large c is smooth. c in [0, 1e6].  Source: MATERIAL_MODEL 5.1 and 6.
template <class Real>
class GaussianFacets {
 public:
  explicit GaussianFacets(double c);

  [[nodiscard]] Real c() const { return c_; }
  /// D [1/sr] at an angle delta [rad]; 0 from pi/2 on.
  [[nodiscard]] Real density(Real delta) const;
  /// D(h) [1/sr] for a facet normal of any length in local coordinates; 0 below the surface.
  [[nodiscard]] Real density(const Vec3<Real>& h) const;
  /// delta by the truncated Rayleigh density. \param u in [0, 1).
  [[nodiscard]] Real sample_delta(Real u) const;
  /// Facet normal: sample_delta(u.x), azimuth uniform.
  [[nodiscard]] Vec3<Real> sample(const Vec2<Real>& u) const;
  /// Density of sample() [1/sr] at an angle delta; 0 beyond pi/2.
  [[nodiscard]] Real pdf(Real delta) const;
  [[nodiscard]] Real pdf(const Vec3<Real>& h) const;

 private:
  Real c_;
  Real norm_;  // N(c)
  Real q_;     // 1 - exp(-pi^2 c^2 / 4)
};

/// Geometric attenuation of V-cavities (Torrance & Sparrow 1967); absolute cosines, so that it
/// serves transmission too.
template <class Real>
[[nodiscard]] Real g_vcavity(Real nl, Real nb, Real nh, Real lh, Real bh) {
  if (!(bh > Real(0)) || !(lh > Real(0))) return Real(0);
  return std::min(Real(1), std::min(Real(2) * nh * nb / bh, Real(2) * nh * nl / lh));
}

// ---- inline ----

template <class Real>
GaussianFacets<Real>::GaussianFacets(double c)
    : c_(static_cast<Real>(c)),
      norm_(static_cast<Real>(gaussian_facets_norm(c))),
      q_(static_cast<Real>(-std::expm1(-0.25 * std::numbers::pi * std::numbers::pi * c * c))) {}

template <class Real>
Real GaussianFacets<Real>::density(Real delta) const {
  if (!(delta < Real(0.5) * std::numbers::pi_v<Real>)) return Real(0);
  const Real x = c_ * delta;
  return norm_ * std::exp(-x * x);
}

template <class Real>
Real GaussianFacets<Real>::density(const Vec3<Real>& h) const {
  if (!(h.z() > Real(0))) return Real(0);
  const Real x = c_ * angle_to_normal(h);
  return norm_ * std::exp(-x * x);
}

template <class Real>
Real GaussianFacets<Real>::sample_delta(Real u) const {
  // delta = sqrt(-log(1 - u q)) / c tends to (pi / 2) sqrt(u) for c -> 0; below c = 1e-15 the two
  // agree to all digits, and farther down c^2 would underflow.
  constexpr Real half_pi = Real(0.5) * std::numbers::pi_v<Real>;
  const Real delta =
      c_ < Real(1e-15) ? half_pi * std::sqrt(u) : std::sqrt(-std::log1p(-u * q_)) / c_;
  return std::min(delta, half_pi);
}

template <class Real>
Vec3<Real> GaussianFacets<Real>::sample(const Vec2<Real>& u) const {
  const Real delta = sample_delta(u.x());
  const Real phi = Real(2) * std::numbers::pi_v<Real> * u.y();
  const Real s = std::sin(delta);
  return {s * std::cos(phi), s * std::sin(phi), std::max(Real(0), std::cos(delta))};
}

template <class Real>
Real GaussianFacets<Real>::pdf(Real delta) const {
  constexpr Real pi = std::numbers::pi_v<Real>;
  if (!(delta <= Real(0.5) * pi)) return Real(0);
  const Real x = c_ * delta;
  const Real ratio = delta > Real(1e-4) ? delta / std::sin(delta) : Real(1) + delta * delta / 6;
  const Real scale = c_ < Real(1e-15) ? Real(4) / (pi * pi) : c_ * c_ / q_;
  return scale / pi * ratio * std::exp(-x * x);
}

template <class Real>
Real GaussianFacets<Real>::pdf(const Vec3<Real>& h) const {
  if (!(h.z() >= Real(0))) return Real(0);
  return pdf(std::min(angle_to_normal(h), Real(0.5) * std::numbers::pi_v<Real>));
}

}  // namespace atrium::material
