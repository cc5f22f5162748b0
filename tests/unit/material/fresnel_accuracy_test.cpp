#include <cfenv>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "material/fresnel.h"
#include "unit/material/fresnel_reference.h"

namespace atrium::material {
namespace {

// Largest relative errors met, with the arguments of the worst.
template <class Real>
struct Worst {
  double s = 0, p = 0, mean = 0, unpolarised = 0;

  static double relative(Real got, Wide want, Wide scale) {
    const Wide d = static_cast<Wide>(got) - want;
    if (want == 0) return d == 0 ? 0.0 : std::numeric_limits<double>::infinity();
    const double r = static_cast<double>((d < 0 ? -d : d) / scale);
    return std::isfinite(r) ? r : std::numeric_limits<double>::infinity();
  }
  void add(Real c, Real n, Real k) {
    const WideTerms want = fresnel_amplitudes(c, n, k);
    if (want.mean() > 0 && static_cast<double>(want.mean()) < 1e-300) return;
    const FresnelTerms<Real> got = fresnel(c, n, k);
    s = std::max(s, relative(got.s, want.s, want.s));
    // R_p is 0 at Brewster's angle: relative to F there is all that its argument c can give.
    p = std::max(p, relative(got.p, want.p, want.mean()));
    mean = std::max(mean, relative(got.mean(), want.mean(), want.mean()));
    unpolarised =
        std::max(unpolarised, relative(fresnel_unpolarised(c, n, k), want.mean(), want.mean()));
  }
  void expect_below(double tolerance) const {
    EXPECT_LT(s, tolerance);
    EXPECT_LT(p, tolerance);
    EXPECT_LT(mean, tolerance);
    EXPECT_LT(unpolarised, tolerance);
  }
};

// The header's promise; the project asks for 1e-12 and 1e-5.
template <class Real>
constexpr double kPromised = std::numeric_limits<Real>::digits > 30 ? 3e-15 : 1e-6;

template <class Real>
void check_grid() {
  Worst<Real> worst;
  std::vector<Real> cosines{Real(0), Real(0.3), Real(0.5), Real(0.7), Real(0.9), Real(0.99)};
  for (int e = -12; e <= 0; ++e) cosines.push_back(static_cast<Real>(std::pow(10.0, e)));
  for (int e = -12; e <= -3; ++e) cosines.push_back(static_cast<Real>(1.0 - std::pow(10.0, e)));
  for (const Real c : cosines)
    for (const double n_given : {0.01, 0.05, 0.2, 0.5, 0.9, 0.999, 1.0 - 1e-9, 1.0, 1.0 + 1e-12,
                                 1.0 + 1e-9, 1.0001, 1.33, 1.5, 2.4, 10.0, 100.0})
      for (const double kappa : {0.0, 1e-8, 1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3, 1e4}) {
        const Real n = static_cast<Real>(n_given);
        worst.add(c, n, n * static_cast<Real>(kappa));
      }
  worst.expect_below(kPromised<Real>);
}

template <class Real>
void check_random() {
  Worst<Real> worst;
  std::mt19937_64 random(1998);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 60000; ++i) {
    const auto u = [&] { return uniform(random); };
    const double c = i % 3 == 0 ? std::pow(10.0, -12.0 * u()) : u();
    const double n = i % 5 == 0 ? 1.0 + std::copysign(std::pow(10.0, -0.5 - 12.0 * u()), u() - 0.5)
                                : std::pow(10.0, -2.0 + 4.0 * u());
    const double k = i % 2 == 0 ? 0.0 : n * std::pow(10.0, -8.0 + 12.0 * u());
    worst.add(static_cast<Real>(c), static_cast<Real>(n), static_cast<Real>(k));
  }
  worst.expect_below(kPromised<Real>);
}

// The last cosines before total reflection and the first ones after it: F falls from 1 there along
// a root, and n^2 - s^2 cancels to nothing.
template <class Real>
void check_total_reflection() {
  Worst<Real> worst;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 3000; ++i) {
    const Real n = static_cast<Real>(0.0005 + 0.999 * uniform(random));
    const Real k =
        i % 2 == 0 ? Real(0) : static_cast<Real>(std::pow(10.0, -16.0 * uniform(random)));
    const Real edge = static_cast<Real>(std::sqrt(1.0L - static_cast<long double>(n) * n));
    Real below = edge, above = edge;
    for (int j = 0; j < 3; ++j) {
      worst.add(above, n, k);
      worst.add(below, n, k);
      below = std::nextafter(below, Real(0));
      above = std::min(std::nextafter(above, Real(2)), Real(1));
    }
    for (double step = 0.1; step > 1e-14; step *= 0.1)
      worst.add(static_cast<Real>(static_cast<double>(edge) * (1.0 - step)), n, k);
  }
  worst.expect_below(kPromised<Real>);
}

TEST(FresnelAccuracy, DoubleOverTheGridOfExtremes) { check_grid<double>(); }
TEST(FresnelAccuracy, FloatOverTheGridOfExtremes) { check_grid<float>(); }
TEST(FresnelAccuracy, DoubleAtRandomArguments) { check_random<double>(); }
TEST(FresnelAccuracy, FloatAtRandomArguments) { check_random<float>(); }
TEST(FresnelAccuracy, DoubleNextToTotalReflection) { check_total_reflection<double>(); }
TEST(FresnelAccuracy, FloatNextToTotalReflection) { check_total_reflection<float>(); }

// Conditioning at Brewster's angle, where only the error relative to F is promised for R_p: the
// error of R_p itself stays within what a change of c by one unit in the last place does to it.
TEST(FresnelAccuracy, BrewsterZeroIsAsSharpAsTheCosine) {
  for (const double n : {0.2, 0.9, 1.0001, 1.5, 2.4, 50.0}) {
    const double c = 1.0 / std::sqrt(1.0 + n * n);
    const double p = fresnel(c, n, 0.0).p;
    double spread = 0.0;
    for (const double side : {0.0, 2.0})
      spread = std::max(spread,
                        static_cast<double>(fresnel_amplitudes(std::nextafter(c, side), n, 0).p));
    EXPECT_LE(p, 4.0 * spread) << n;
  }
}

template <class Real>
void check_guards() {
  std::feclearexcept(FE_ALL_EXCEPT);
  const Real huge = std::numeric_limits<Real>::max();
  const Real tiny = std::numeric_limits<Real>::denorm_min();
  for (const Real c : {-huge, Real(-0.5), Real(0), tiny, Real(1e-12), Real(0.5), Real(1), huge})
    for (const Real n : {tiny, Real(1e-30), Real(0.01), Real(1), Real(1) + Real(1e-7), Real(100),
                         Real(1e30), huge})
      for (const Real k : {Real(0), tiny, Real(1e-30), Real(1e-8), Real(1), Real(1e4), huge}) {
        SCOPED_TRACE(testing::Message() << "c " << c << " n " << n << " k " << k);
        const FresnelTerms<Real> f = fresnel(c, n, k);
        const Real u = fresnel_unpolarised(c, n, k);
        for (const Real r : {f.s, f.p, u}) ASSERT_TRUE(r >= Real(0) && r <= Real(1)) << r;
        if (n == Real(1) && k == Real(0)) {
          EXPECT_EQ(f.s, Real(0));
          EXPECT_EQ(f.p, Real(0));
          EXPECT_EQ(u, Real(0));
        } else if (c <= Real(0)) {
          EXPECT_EQ(f.mean(), Real(1));
          EXPECT_EQ(u, Real(1));
        }
        if (c > Real(1)) {
          EXPECT_EQ(f.s, fresnel(Real(1), n, k).s);
        }
      }
  EXPECT_EQ(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), 0);
}

TEST(FresnelAccuracy, AnyFiniteArgumentGivesAReflectanceAndRaisesNothing) {
  check_guards<float>();
  check_guards<double>();
}

// Duntley's closed form of the cosine mean for n > 1 (1942), in long double.
long double dielectric_mean(long double n) {
  const long double n2 = n * n, n4 = n2 * n2;
  return 0.5L + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3.0L) * std::log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

TEST(FresnelMeanAccuracy, DielectricIsTheClosedForm) {
  for (const double n : {1.1, 1.33, 1.5, 1.9, 2.4, 4.0, 10.0, 20.0}) {
    const auto outside = static_cast<double>(dielectric_mean(n));
    EXPECT_NEAR(fresnel_mean(n, 0.0) / outside, 1.0, 1e-10) << n;
    EXPECT_NEAR(fresnel_mean(1.0 / n, 0.0), 1.0 - (1.0 - outside) / (n * n), 1e-10) << n;
  }
}

// Tanh-sinh rule on both sides of the limit angle: its nodes crowd at the ends, so that the root
// there and the dip of large k next to grazing need no care. Distances from the ends are kept, not
// differences.
double tanh_sinh_mean(double n, double k) {
  const double edge = n < 1.0 ? std::sqrt((1.0 - n) * (1.0 + n)) : 0.0;
  const auto side = [&](double from, double to) {
    constexpr double step = 1.0 / 32.0;
    double sum = 0.0;
    for (int i = -112; i <= 112; ++i) {
      const double t = i * step, y = 0.5 * std::numbers::pi * std::sinh(t);
      const double near_to = 1.0 / (1.0 + std::exp(-2.0 * y));  // share of the way
      const double mu = from + (to - from) * near_to;
      const double weight =
          0.25 * std::numbers::pi * std::cosh(t) / (std::cosh(y) * std::cosh(y)) * (to - from);
      if (weight == 0.0 || !(mu > 0.0)) continue;
      sum += step * weight * 2.0 * mu * static_cast<double>(fresnel_amplitudes(mu, n, k).mean());
    }
    return sum;
  };
  return (edge > 0.0 ? side(0.0, edge) : 0.0) + side(edge, 1.0);
}

TEST(FresnelMeanAccuracy, AnyIndexAgreesWithATanhSinhRule) {
  for (const double n : {0.05, 0.13, 0.27, 0.5, 0.7, 0.95, 1.0, 1.0001, 1.5, 3.0, 10.0})
    for (const double k : {0.0, 1e-8, 1e-5, 1e-3, 0.03, 0.1, 0.5, 2.95, 10.0, 100.0, 1000.0}) {
      const double want = n == 1.0 && k == 0.0 ? 0.0 : tanh_sinh_mean(n, k);
      EXPECT_NEAR(fresnel_mean(n, k), want, 1e-10 * std::max(want, 1e-3)) << n << " " << k;
    }
}

}  // namespace
}  // namespace atrium::material
