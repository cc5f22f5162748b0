#pragma once

#include <array>
#include <memory>
#include <vector>

#include "material/gauss_legendre.h"
#include "material/rough_interface.h"

// Directional albedos of a rough interface by quadrature over its facets.
namespace atrium::material::facet_integral {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kHalfPi = 0.5 * kPi;

// Integral over [a, b] with both ends smoothed: square roots at an end cost no digits.
template <int Points, class F>
auto smooth_ends(double a, double b, F&& f) {
  const double width = b - a;
  using Value = std::decay_t<decltype(f(a))>;
  return gauss_legendre<Points>(0.0, 1.0, [&](double t) -> Value {
    return 6.0 * t * (1.0 - t) * width * f(a + width * t * t * (3.0 - 2.0 * t));
  });
}

// Angles of incidence on a facet (their cosines bh) where the integrand of a facet with cosine nh
// bends: where light begins to leave on the right side, where G changes its branch, where total
// reflection begins. Extra ones do no harm; what does not exist is no cosine.
using Bends = std::array<double, 8>;

inline constexpr double kNone = 2.0;

inline Bends reflection_bends(double mu, double nh, double n) {
  return {mu / (2.0 * nh),                                            // n.l = 0
          2.0 * nh * mu,                                              // 2 (n.h)(n.b) = b.h
          nh != 0.5 ? 2.0 * nh * mu / (4.0 * nh * nh - 1.0) : kNone,  // 2 (n.h)(n.l) = l.h
          mu / nh,                                                    // n.l = n.b
          n < 1.0 ? std::sqrt((1.0 - n) * (1.0 + n)) : kNone,
          kNone,
          kNone,
          kNone};
}

// Roots of p (n^2 - 1 + x^2) = q (x nh - mu)^2: both conditions on the refracted cosine have this
// form, n cos_t = sqrt(n^2 - 1 + x^2).
inline std::array<double, 2> refraction_roots(double p, double q, double mu, double nh, double n) {
  const double a = p - q * nh * nh, b = q * nh * mu, c = p * (n - 1.0) * (n + 1.0) - q * mu * mu;
  const double d = b * b - a * c;
  if (!(d >= 0.0) || a == 0.0) return {kNone, kNone};
  const double root = std::sqrt(d);
  return {(-b - root) / a, (-b + root) / a};
}

inline Bends refraction_bends(double mu, double nh, double n) {
  const double w = 2.0 * nh * nh - 1.0;
  const auto level = refraction_roots(nh * nh, 1.0, mu, nh, n);           // n.l = 0
  const auto branch = refraction_roots(w * w, 4.0 * nh * nh, mu, nh, n);  // 2 (n.h)|n.l| = |l.h|
  return {level[0],
          level[1],
          branch[0],
          branch[1],
          2.0 * nh * mu,
          mu / nh,
          n < 1.0 ? std::sqrt((1.0 - n) * (1.0 + n)) : kNone,
          kNone};
}

// Points: of the rules in either angle. 32 leave 1e-8 of an albedo, 16 1e-6 at a quarter of the
// cost.
template <int Points>
class Facets {
 public:
  // smith  a table for c, if the masking is Smith's and there is one already.
  Facets(double mu, double c, Masking masking, std::shared_ptr<const SmithTable> smith = nullptr)
      : mu_(mu),
        sine_(std::sqrt((1.0 - mu) * (1.0 + mu))),
        c_(c),
        masking_(masking),
        facets_(c),
        smith_(std::move(smith)) {
    if (masking == Masking::Smith && !smith_) smith_ = std::make_shared<SmithTable>(c);
  }

  // G b.h of a facet that reflects.
  double reflect(double nh, double bh) const {
    const double nl = 2.0 * bh * nh - mu_;
    if (!(bh > 0.0) || !(nl > 0.0)) return 0.0;
    return attenuation(nl, nh, bh, bh, false) * bh;
  }

  // G b.h of a facet that refracts.
  double refract(double nh, double bh, double n) const {
    const double sine2 = (1.0 - bh) * (1.0 + bh) / (n * n);
    if (!(bh > 0.0) || !(sine2 < 1.0)) return 0.0;
    const double cos_t = std::sqrt(1.0 - sine2);
    const double nl = -mu_ / n + (bh / n - cos_t) * nh;
    return nl < 0.0 ? attenuation(nl, nh, cos_t, bh, true) * bh : 0.0;
  }

  // 1/mu * integral of D share(nh, bh) dw_h; bends(nh) says where the share is not smooth.
  template <class Share, class BendsOf>
  auto integrate(const Share& share, const BendsOf& bends) const {
    using Value = std::decay_t<decltype(share(1.0, 1.0))>;
    const std::vector<double> ends = panel_ends(bends);
    Value sum = 0.0 * share(1.0, 0.0);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      sum += smooth_ends<Points>(ends[i], ends[i + 1], [&](double delta) -> Value {
        return facets_.density(delta) * std::sin(delta) * around(delta, share, bends);
      });
    sum *= 2.0 / mu_;
    return sum;
  }

 private:
  double attenuation(double nl, double nh, double lh, double bh, bool transmitted) const {
    if (!smith_) return masking_term(masking_, c_, nl, mu_, nh, lh, bh, transmitted);
    const auto l = static_cast<float>(nl), b = static_cast<float>(mu_);
    return static_cast<double>(transmitted ? smith_->transmission(b, l) : smith_->reflection(b, l));
  }

  // Facet angles at which a bend enters or leaves the circle of azimuths.
  template <class BendsOf>
  std::vector<double> panel_ends(const BendsOf& bends) const {
    const double end = std::min(kHalfPi, 6.8 / std::max(c_, 1e-9));
    std::vector<double> ends = {0.0, 0.25 * end, 0.5 * end, 0.75 * end, end};
    const double theta = std::atan2(sine_, mu_);
    constexpr int kScan = 128;
    for (const double side : {-1.0, 1.0}) {
      const auto misses = [&](std::size_t k, double delta) {
        return bends(std::cos(delta))[k] - std::cos(theta + side * delta);
      };
      for (std::size_t k = 0; k < std::tuple_size_v<Bends>; ++k) {
        double lo = 0.0, at_lo = misses(k, 0.0);
        for (int i = 1; i <= kScan; ++i) {
          double hi = end * i / kScan;
          const double at_hi = misses(k, hi);
          if (at_lo * at_hi < 0.0) ends.push_back(bisect(k, lo, hi, at_lo, misses));
          lo = hi;
          at_lo = at_hi;
        }
      }
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(
        std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a < 1e-12; }),
        ends.end());
    return ends;
  }

  template <class F>
  static double bisect(std::size_t k, double lo, double hi, double at_lo, const F& f) {
    for (int i = 0; i < 48; ++i) {
      const double middle = 0.5 * (lo + hi);
      (f(k, middle) * at_lo > 0.0 ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
  }

  // Integral of the share over the azimuth, half a turn.
  template <class Share, class BendsOf>
  auto around(double delta, const Share& share, const BendsOf& bends) const {
    using Value = std::decay_t<decltype(share(1.0, 1.0))>;
    const double nh = std::cos(delta), a = mu_ * nh, b = sine_ * std::sin(delta);
    std::array<double, std::tuple_size_v<Bends> + 3> ends;
    ends.fill(kPi);
    ends[0] = 0.0;
    std::size_t count = 1;
    const auto cut = [&](double bh) {
      const double x = (bh - a) / b;
      if (x > -1.0 && x < 1.0) ends[count++] = std::acos(x);
    };
    if (b > 0.0) {
      cut(0.0);
      for (const double bh : bends(nh)) cut(bh);
    }
    std::sort(ends.begin(), ends.end());
    Value sum = 0.0 * share(1.0, 0.0);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      if (ends[i + 1] - ends[i] > 1e-13)
        sum += smooth_ends<Points>(ends[i], ends[i + 1], [&](double phi) -> Value {
          return share(nh, std::min(a + b * std::cos(phi), 1.0));
        });
    return sum;
  }

  double mu_, sine_, c_;
  Masking masking_;
  GaussianFacets<double> facets_;
  std::shared_ptr<const SmithTable> smith_;
};

}  // namespace atrium::material::facet_integral
