#pragma once

#include "material/models/common.h"

namespace atrium::material {

/// All lengths in one unit; wavelength in the incident medium.
struct He1991Parameters {
  double sigma0 = 0.1;      ///< rms height, >= 0
  double tau = 1.0;         ///< autocorrelation length, > 0
  double lambda = 0.55;     ///< wavelength, > 0
  double n = 1.5, k = 0.0;  ///< index relative to the incident medium, n > 0, k >= 0
  double a = 0.0;           ///< constant BRDF f_ud [1/sr] of multiple scattering, in [0, 1/pi]
};
/// \throws std::invalid_argument  names parameter, value and range; NaN is refused.
void validate(const He1991Parameters& parameters);

/// W(e^x) for any x, the principal branch: the w > 0 with w + ln w = x, to 1e-15 relative where
/// it is a normal number. The logarithm as argument reaches far beyond the range of double.
[[nodiscard]] double lambert_w_of_exp(double x);

/// Sum over m >= 1 of g^m e^-g / (m! m) e^{-B/m} for g, B >= 0: 1e-12 relative for g up to 1e10 as
/// long as the result is a normal number, 0 below. At most about 150 terms at any g: below a mode
/// of 50 outward from the largest term by recurrence, above it by the trapezoidal rule over m with
/// steps wider than one (sum and integral of the nearly Gaussian summand agree to
/// exp(-2 pi^2 s^2), s its width; Poisson's summation formula).
/// Source: He et al. 1991, Eq. 78.
[[nodiscard]] double he_sum(double g, double B);

/// Effective rms height sigma = sigma0 / sqrt(1 + W(A^2)) of the surface as seen and lit under the
/// polar angles theta_i, theta_r in [0, pi/2]: shadowed valleys do not count.
/// Source: He et al. 1991, Eqs. 80 to 82; MATERIAL_MODEL 9.3.
[[nodiscard]] double he_sigma(double theta_i, double theta_r, double sigma0, double tau);

/// The parts of He's model for a pair of directions; 0 where one is at or below the horizon.
template <class Real>
struct He1991 {
  Real dd;         ///< directional-diffuse BRDF f_dd [1/sr]
  Real specular;   ///< F(theta) e^-g S, theta of b: mirror reflectance if l is b's mirror image
  Real sigma_eff;  ///< unit of sigma0
  Real g;          ///< [(2 pi sigma / lambda)(n.l + n.b)]^2
  Real S;          ///< shadowing and masking
  Real D;          ///< distribution
  Real G;          ///< (q.q / q_z)^2 = 4 cos^2 phi / cos^2 delta
};

/// What does not depend on the wavelength: once per pair of directions, for all lanes.
struct HeGeometry {
  bool above = false;
  double cos_theta = 0, cos_phi = 0;  ///< of b; of the facet
  double sum_cos2 = 0;                ///< (n.l + n.b)^2
  double q_xy2 = 0;                   ///< |(q_x, q_y)|^2
  double sigma = 0, S = 0, G = 0;
  double S_over_cosines = 0;  ///< S / ((n.l)(n.b)), finite at grazing angles
  HeGeometry() = default;
  HeGeometry(const Vec3d& l, const Vec3d& b, double sigma0, double tau);
};

/// Unpolarised; the sum runs in double for float too (its terms need the exponent).
[[nodiscard]] He1991<double> he1991(const HeGeometry& geometry, double tau, double lambda, double n,
                                    double k);

/// Its mirror part F e^-g S alone, without the sum.
[[nodiscard]] double he1991_specular(const HeGeometry& geometry, double lambda, double n, double k);

/// f = mirror * Dirac + f_dd + a, from rms height sigma0, autocorrelation length tau and wavelength
/// lambda in one unit, index n + i k relative to the incident medium. Reciprocal. For F = 1 the
/// albedo with the mirror part is 1.000 at normal incidence and may exceed 1 off normal: 1.012 up
/// to 75 deg, 1.04 at 81 deg (sigma/lambda 0.3, tau/lambda 6). Source: He, Torrance, Sillion,
/// Greenberg 1991.
template <class Real>
[[nodiscard]] He1991<Real> he1991(const Vec3<Real>& l, const Vec3<Real>& b, Scalar<Real> sigma0,
                                  Scalar<Real> tau, Scalar<Real> lambda, Scalar<Real> n,
                                  Scalar<Real> k) {
  const HeGeometry geometry(l.template cast<double>(), b.template cast<double>(),
                            static_cast<double>(sigma0), static_cast<double>(tau));
  const He1991<double> h = he1991(geometry, static_cast<double>(tau), static_cast<double>(lambda),
                                  static_cast<double>(n), static_cast<double>(k));
  const auto real = [](double x) {
    return static_cast<Real>(std::min(x, static_cast<double>(std::numeric_limits<Real>::max())));
  };
  return {real(h.dd), real(h.specular), real(h.sigma_eff), real(h.g),
          real(h.S),  real(h.D),        real(h.G)};
}

}  // namespace atrium::material
