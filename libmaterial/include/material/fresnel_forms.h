#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "material/fresnel.h"
#include "material/spectrum.h"

namespace atrium::material {

// ---- Approximations of the unpolarised reflectance, one wavelength ----
//
// Arguments as of fresnel(): c in [0, 1] (not clamped here), n > 0 and k >= 0 relative to the
// incident medium, 0.01 to 1e6. Results are kept in [0, 1]. All are made for metals; only Schlick
// and its correction are of use for dielectrics, and only from the thinner side.

/// F(0) = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), exact.
template <class Real>
[[nodiscard]] Real fresnel_normal(Real n, Real k);

/// F(0) + (1 - F(0)) (1 - c)^5. With F(0) of a metal this is also the form of Lazanyi &
/// Szirmay-Kalos 2005 without its fitted term.  Source: Schlick 1994; docs/materials.md, Eq. F6.
template <class Real>
[[nodiscard]] Real fresnel_schlick(Real c, Real n, Real k);

/// Schlick - A c (1 - c)^6 with A from the exact value at c = 1/7, where c (1 - c)^6 is largest
/// (82 degrees).  Source: docs/materials.md, Eq. F7.
template <class Real>
[[nodiscard]] Real fresnel_f82(Real c, Real n, Real k);

/// Order 0 (Drude): sqrt(N^2 - s^2) = N.  Source: docs/materials.md, Eq. F8.
template <class Real>
[[nodiscard]] Real fresnel_drude0(Real c, Real n, Real k);

/// Order 1: sqrt(N^2 - s^2) = N - s^2 / (2 N), real part not below 0.
/// Source: docs/materials.md, Eq. F9.
template <class Real>
[[nodiscard]] Real fresnel_series1(Real c, Real n, Real k);

/// Order 2: sqrt(N^2 - s^2) = N - s^2 / (2 N) - s^4 / (8 N^3), real part not below 0.
template <class Real>
[[nodiscard]] Real fresnel_series2(Real c, Real n, Real k);

template <class Real>
struct ComplexIndex {
  Real n, k;
};

/// Complex index of a metal from its reflectance r at normal incidence and its edge tint g.
///
/// \param r  F(0), in [0, 1).  \param g  in [0, 1]: 0 gives the largest n, 1 the smallest.
/// Artist's parameters: F(0) is exact, the rise towards grazing follows g.
/// \throws std::invalid_argument  outside these ranges.
/// Source: Gulbrandsen 2014, JCGT 3(4); rearranged without differences of nearly equal terms.
template <class Real>
[[nodiscard]] ComplexIndex<Real> gulbrandsen_index(Real r, Real g);

// ---- A form per material, chosen by a bound on the error ----

enum class FresnelForm { Exact, Schlick, SchlickCorrected, Order0, Order1, Order2, Table };

/// "exact", "schlick", "schlick-corrected", "order-0", "order-1", "order-2", "table".
[[nodiscard]] std::string_view name(FresnelForm form);

namespace fresnel_detail {

/// Coefficients per lane; three lanes are kept as four so that one register holds them.
template <int N>
inline constexpr int kWidth = N == 3 ? 4 : N;
template <int N, class Real = float>
using Lanes = std::array<Real, static_cast<std::size_t>(kWidth<N>)>;

template <int N>
struct ExactLanes {
  Lanes<N, double> q;     ///< n^2 - 1 - k^2; in double, as F follows a root of it plus c^2
  Lanes<N> nk, contrast;  ///< n k, |N^2 - 1|
};
template <int N>
struct SchlickLanes {
  Lanes<N> f0;
};
template <int N>
struct SchlickCorrectedLanes {
  Lanes<N> f0, a;
};
template <int N>
struct Order0Lanes {
  Lanes<N> modulus, twice_n;  ///< |N|^2, 2 n
};
template <int N>
struct Order1Lanes {
  Lanes<N> n, k, h;  ///< 1 / (2 |N|^2)
};
template <int N>
struct Order2Lanes {
  Lanes<N> n, k, a1, b1, a2, b2;  ///< 1 / (2 N) = a1 + i b1, 1 / (8 N^3) = a2 + i b2
};
/// F at c = (i / 64)^2, linear in sqrt(c) between.
template <int N>
struct TableLanes {
  static constexpr int kSteps = 64;
  using Values = std::array<Lanes<N>, kSteps + 1>;
  std::shared_ptr<const Values> f;  ///< shared by copies of the same material
};

}  // namespace fresnel_detail

/// Unpolarised Fresnel reflectance of one material for the lanes of a scene, in the cheapest form
/// whose error stays below a bound.
///
/// The error is measured when the object is made: the largest difference from the exact value in
/// double over all lanes, at some 300 angles that are dense where F changes (towards grazing and
/// next to total reflection). A form is taken if 1.05 times that, which covers the angles between,
/// is within the bound; orders 1 and 2 only where their series converge, |N| > 1. Evaluation
/// allocates nothing and is safe from many threads.
template <int N>
class FresnelTerm {
 public:
  /// A matched interface, F = 0.
  FresnelTerm();
  /// \param n, k   index relative to the incident medium, n > 0, k = n kappa >= 0.
  /// \param bound  largest absolute error of F allowed, >= 0; 0: always exact.
  /// \throws std::invalid_argument  naming the argument outside its range (or NaN).
  FresnelTerm(const Spectrum<N>& n, const Spectrum<N>& k, float bound = 1e-3f);
  /// The given form whatever its error (comparisons, benchmarks).
  FresnelTerm(const Spectrum<N>& n, const Spectrum<N>& k, FresnelForm form);

  /// F per lane at the cosine c of the angle of incidence, clamped to [0, 1]; in [0, 1].
  [[nodiscard]] Spectrum<N> operator()(float c) const;

  [[nodiscard]] FresnelForm form() const { return static_cast<FresnelForm>(lanes_.index()); }
  /// Largest absolute error measured, rounding included. Orders 1 and 2 asked for where their
  /// series diverge may be worse in between.
  [[nodiscard]] float error() const { return error_; }

 private:
  // In the order of FresnelForm.
  using Variant = std::variant<fresnel_detail::ExactLanes<N>, fresnel_detail::SchlickLanes<N>,
                               fresnel_detail::SchlickCorrectedLanes<N>,
                               fresnel_detail::Order0Lanes<N>, fresnel_detail::Order1Lanes<N>,
                               fresnel_detail::Order2Lanes<N>, fresnel_detail::TableLanes<N>>;

  Variant lanes_;
  float error_ = 0.0f;
};

extern template class FresnelTerm<1>;
extern template class FresnelTerm<3>;
extern template class FresnelTerm<4>;
extern template class FresnelTerm<8>;

// ---- inline ----

namespace fresnel_detail {

template <class Real>
[[nodiscard]] Real unit_range(Real f) {
  return std::min(std::max(f, Real(0)), Real(1));
}

/// F from |w|^2 and w's real part, w = sqrt(N^2 - s^2) or an approximation of it: both
/// polarisations in one fraction, docs/materials.md, Eq. F5.
template <class Real>
[[nodiscard]] Real unpolarised(Real modulus, Real real, Real c, Real s2) {
  constexpr Real tiny = std::numeric_limits<Real>::min();  // w = 0 at grazing: 1, not 0 / 0
  const Real d = modulus + c * c + tiny;
  const Real e = Real(2) * real * c;
  const Real p = modulus * c * c + s2 * s2;
  return std::max(d - e, Real(0)) * p / ((d + e) * (p + e * s2));
}

}  // namespace fresnel_detail

template <class Real>
Real fresnel_normal(Real n, Real k) {
  const Real k2 = k * k;
  return ((n - Real(1)) * (n - Real(1)) + k2) / ((n + Real(1)) * (n + Real(1)) + k2);
}

template <class Real>
Real fresnel_schlick(Real c, Real n, Real k) {
  const Real f0 = fresnel_normal(n, k);
  const Real x = Real(1) - c;
  return f0 + (Real(1) - f0) * (x * x) * (x * x) * x;
}

template <class Real>
Real fresnel_f82(Real c, Real n, Real k) {
  constexpr Real peak = Real(46656) / Real(823543);  // c (1 - c)^6 at 1/7
  const Real at = Real(1) / Real(7);
  const Real a = (fresnel_schlick(at, n, k) - fresnel_unpolarised(at, n, k)) / peak;
  const Real x = Real(1) - c;
  const Real x2 = x * x;
  return fresnel_detail::unit_range(fresnel_schlick(c, n, k) - a * c * x2 * x2 * x2);
}

template <class Real>
Real fresnel_drude0(Real c, Real n, Real k) {
  const Real m = n * n + k * k;
  const Real e = Real(2) * n * c;
  const Real ds = m + c * c;
  const Real dp = m * c * c + Real(1);
  return fresnel_detail::unit_range(Real(0.5) * ((ds - e) / (ds + e) + (dp - e) / (dp + e)));
}

template <class Real>
Real fresnel_series1(Real c, Real n, Real k) {
  const Real s2 = (Real(1) - c) * (Real(1) + c);
  const Real h = s2 / (Real(2) * (n * n + k * k));
  const Real a = std::max(n * (Real(1) - h), Real(0));
  const Real b = k * (Real(1) + h);
  return fresnel_detail::unpolarised(a * a + b * b, a, c, s2);
}

template <class Real>
Real fresnel_series2(Real c, Real n, Real k) {
  const Real s2 = (Real(1) - c) * (Real(1) + c);
  const Real m = n * n + k * k;
  // x = s^2 / (2 N^2) = xr - i xi: w = N (1 - x - x^2 / 2)
  const Real scale = s2 / (Real(2) * m * m);
  const Real xr = (n - k) * (n + k) * scale;
  const Real xi = Real(2) * n * k * scale;
  const Real fr = Real(1) - xr - Real(0.5) * (xr - xi) * (xr + xi);
  const Real fi = xi + xr * xi;
  const Real a = std::max(n * fr - k * fi, Real(0));
  const Real b = n * fi + k * fr;
  return fresnel_detail::unpolarised(a * a + b * b, a, c, s2);
}

template <class Real>
ComplexIndex<Real> gulbrandsen_index(Real r, Real g) {
  if (!(r >= Real(0) && r < Real(1)))
    throw std::invalid_argument("gulbrandsen_index: r must be in [0, 1), is " + std::to_string(r));
  if (!(g >= Real(0) && g <= Real(1)))
    throw std::invalid_argument("gulbrandsen_index: g must be in [0, 1], is " + std::to_string(g));
  // n between n_min = (1 - r) / (1 + r) and n_max = (1 + q) / (1 - q); all (n, k) of one F(0) lie
  // on the circle k^2 = (n_max - n)(n - 1 / n_max).
  const Real q = std::sqrt(r);
  const Real n_min = (Real(1) - r) / (Real(1) + r);
  const Real range =
      Real(2) * q * (Real(1) + q) / ((Real(1) - q) * (Real(1) + r));  // n_max - n_min
  const Real above = Real(2) * q * (Real(1) - q) / ((Real(1) + q) * (Real(1) + r));  // - 1 / n_max
  const Real n = n_min + (Real(1) - g) * range;
  return {n, std::sqrt(g * range * ((Real(1) - g) * range + above))};
}

}  // namespace atrium::material
