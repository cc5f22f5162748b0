#include <functional>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "material/models/blinn_phong.h"
#include "material/models/cook_torrance.h"
#include "material/models/ggx.h"
#include "material/models/hanrahan_krueger.h"
#include "material/models/he.h"
#include "material/models/lambert.h"
#include "material/models/oren_nayar.h"
#include "material/models/phong.h"
#include "material/models/schlick94.h"
#include "reference.h"

namespace atrium::material {
namespace {

using reference::Long;

// Parameters of one draw, wide ranges; every model takes what it needs.
struct Draw {
  double kd, ks, p, m, n, k, alpha, rho, s, W, taud, g, f0, r, isotropy, sigma0, tau, lambda;
};
Draw draw(std::mt19937& rng) {
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const auto log_range = [&](double a, double b) { return a * std::pow(b / a, u(rng)); };
  Draw d{};
  d.kd = u(rng);
  d.ks = 1.0 - d.kd;
  d.p = u(rng) < 0.1 ? 0.0 : log_range(0.01, 1e5);
  d.m = log_range(1e-3, 10.0);
  d.n = u(rng) < 0.5 ? 1.05 + u(rng) : log_range(0.05, 20.0);
  d.k = u(rng) < 0.5 ? 0.0 : log_range(0.01, 20.0);
  d.alpha = log_range(1e-3, 1.0);
  d.rho = u(rng);
  d.s = u(rng);
  d.W = u(rng);
  d.taud = u(rng) < 0.1 ? std::numeric_limits<double>::infinity() : log_range(1e-6, 1e3);
  d.g = 1.98 * u(rng) - 0.99;
  d.f0 = u(rng);
  d.r = u(rng) < 0.05 ? 1.0 : log_range(1e-3, 1.0);
  d.isotropy = u(rng) < 0.3 ? 1.0 : log_range(0.01, 1.0);
  d.lambda = 0.38 + 0.4 * u(rng);
  d.sigma0 = d.lambda * log_range(1e-4, 100.0);
  d.tau = std::max(d.lambda, d.sigma0) * log_range(0.5, 30.0);
  return d;
}
// The same numbers after rounding to Real, so that both sides see one input.
template <class Real>
Draw rounded(Draw d) {
  for (double* x : {&d.kd, &d.ks, &d.p, &d.m, &d.n, &d.k, &d.alpha, &d.rho, &d.s, &d.W, &d.taud,
                    &d.g, &d.f0, &d.r, &d.isotropy, &d.sigma0, &d.tau, &d.lambda})
    *x = static_cast<double>(static_cast<Real>(*x));
  return d;
}

template <class Real>
struct Kernel {
  const char* name;
  std::function<Real(const Vec3<Real>&, const Vec3<Real>&, const Draw&)> tested;
  std::function<Long(const reference::V&, const reference::V&, const Draw&)> expected;
  bool reciprocal = true;
  // A sum of terms of both signs is compared with the size of its terms.
  double (*scale)(const Draw&) = nullptr;
};

template <class Real>
std::vector<Kernel<Real>> kernels() {
  using L = const Vec3<Real>&;
  using X = const reference::V&;
  using D = const Draw&;
  const auto r = [](double x) { return static_cast<Real>(x); };
  return {
      {"lambert", [r](L l, L b, D d) { return lambert(l, b, r(d.rho)); },
       [](X, X, D d) { return Long(d.rho) / reference::kPi; }},
      {"phong_1975", [r](L l, L b, D d) { return phong_1975(l, b, r(d.kd), r(d.ks), r(d.p)); },
       [](X l, X b, D d) { return reference::phong_1975(l, b, d.kd, d.ks, d.p); }, false},
      {"phong_lafortune lobe",
       [r](L l, L b, D d) { return phong_lafortune(l, b, Real(0), r(d.ks), r(d.p)); },
       [](X l, X b, D d) { return reference::phong_lafortune(l, b, 0, d.ks, d.p); }},
      {"phong_lafortune",
       [r](L l, L b, D d) { return phong_lafortune(l, b, r(d.kd), r(d.ks), r(d.p)); },
       [](X l, X b, D d) { return reference::phong_lafortune(l, b, d.kd, d.ks, d.p); }},
      {"blinn_phong lobe",
       [r](L l, L b, D d) { return blinn_phong(l, b, Real(0), r(d.ks), r(d.p)); },
       [](X l, X b, D d) { return reference::blinn_phong(l, b, 0, d.ks, d.p); }},
      {"cook_torrance", [r](L l, L b, D d) { return cook_torrance(l, b, r(d.m), r(d.n), r(d.k)); },
       [](X l, X b, D d) { return reference::cook_torrance(l, b, d.m, d.n, d.k); }},
      {"ggx", [r](L l, L b, D d) { return ggx(l, b, r(d.alpha), r(d.n), r(d.k)); },
       [](X l, X b, D d) { return reference::ggx(l, b, d.alpha, d.n, d.k); }},
      {"ggx_schlick", [r](L l, L b, D d) { return ggx_schlick(l, b, r(d.alpha), r(d.f0)); },
       [](X l, X b, D d) { return reference::ggx_schlick(l, b, d.alpha, d.f0); }},
      {"oren_nayar_qualitative",
       [r](L l, L b, D d) { return oren_nayar_qualitative(l, b, r(d.rho), r(d.s)); },
       [](X l, X b, D d) { return reference::oren_nayar_qualitative(l, b, d.rho, d.s); }},
      {"oren_nayar_full", [r](L l, L b, D d) { return oren_nayar_full(l, b, r(d.rho), r(d.s)); },
       [](X l, X b, D d) { return reference::oren_nayar_full(l, b, d.rho, d.s); }, true,
       [](D d) -> double { return d.rho / std::numbers::pi; }},
      {"hanrahan_krueger",
       [r](L l, L b, D d) {
         return hanrahan_krueger(l, b, r(std::max(1.01, d.n)), r(d.W), r(d.taud), r(d.g));
       },
       [](X l, X b, D d) {
         const Long n = static_cast<Real>(std::max(1.01, d.n));
         return reference::hanrahan_krueger(l, b, n, d.W, d.taud, d.g);
       }},
      {"hanrahan_krueger n = 1",
       [r](L l, L b, D d) { return hanrahan_krueger(l, b, Real(1), r(d.W), r(d.taud), r(d.g)); },
       [](X l, X b, D d) { return reference::hanrahan_krueger(l, b, 1, d.W, d.taud, d.g); }},
      {"hanrahan_krueger_transmission",
       [r](L l, L b, D d) {
         const Vec3<Real> below(b.x(), b.y(), -b.z());
         return hanrahan_krueger_transmission(l, below, r(std::max(1.01, d.n)), r(d.W), r(d.taud),
                                              r(d.g));
       },
       [](X l, X b, D d) {
         const Long n = static_cast<Real>(std::max(1.01, d.n));
         return reference::hanrahan_krueger(l, {b.x(), b.y(), -b.z()}, n, d.W, d.taud, d.g);
       }},
      {"schlick1994",
       [r](L l, L b, D d) { return schlick1994(l, b, r(d.f0), r(d.r), r(d.isotropy)).f; },
       [](X l, X b, D d) { return reference::schlick1994(l, b, d.f0, d.r, d.isotropy).f; }},
      {"schlick1994 dirac",
       [r](L l, L b, D d) { return schlick1994(l, b, r(d.f0), r(d.r), r(d.isotropy)).dirac; },
       [](X l, X b, D d) { return reference::schlick1994(l, b, d.f0, d.r, d.isotropy).dirac; }},
      {"he1991 dd",
       [r](L l, L b, D d) {
         return he1991(l, b, r(d.sigma0), r(d.tau), r(d.lambda), r(d.n), r(d.k)).dd;
       },
       [](X l, X b, D d) {
         return reference::he1991(l, b, d.sigma0, d.tau, d.lambda, d.n, d.k).dd;
       }},
      {"he1991 specular",
       [r](L l, L b, D d) {
         return he1991(l, b, r(d.sigma0), r(d.tau), r(d.lambda), r(d.n), r(d.k)).specular;
       },
       [](X l, X b, D d) {
         return reference::he1991(l, b, d.sigma0, d.tau, d.lambda, d.n, d.k).specular;
       },
       false},  // a function of b, symmetric for mirror pairs only
  };
}

// Worst relative error over the pairs; values below `tiny` (far outside every lobe) are compared
// with `tiny`.
template <class Real>
void compare(double tolerance, Real tiny, int count, int grazing_decades) {
  const auto pairs = reference::pairs(count, 11, grazing_decades);
  for (const Kernel<Real>& kernel : kernels<Real>()) {
    SCOPED_TRACE(kernel.name);
    std::mt19937 rng(5);
    double worst = 0.0;
    std::string where;
    for (const auto& pair : pairs) {
      const Draw d = rounded<Real>(draw(rng));
      const Vec3<Real> l = pair.l.template cast<Real>(), b = pair.b.template cast<Real>();
      const Real value = kernel.tested(l, b, d);
      ASSERT_TRUE(std::isfinite(value));
      const Long expected = kernel.expected(l.template cast<Long>(), b.template cast<Long>(), d);
      const Long scale = kernel.scale ? static_cast<Long>(kernel.scale(d)) : Long(tiny);
      const double error = static_cast<double>(std::abs(static_cast<Long>(value) - expected) /
                                               std::max(scale, std::abs(expected)));
      if (!(error <= worst)) {
        worst = error;
        std::ostringstream s;
        s.precision(9);
        s << "l " << l.transpose() << " b " << b.transpose() << " value " << value << " expected "
          << expected << " n " << d.n << " k " << d.k << " p " << d.p << " m " << d.m << " g "
          << d.g << " taud " << d.taud << " sigma0 " << d.sigma0 << " tau " << d.tau << " r " << d.r
          << " s " << d.s;
        where = s.str();
      }
    }
    EXPECT_LT(worst, tolerance) << where;
  }
}

TEST(ModelKernels, AgreeWithLongDoubleInDouble) { compare<double>(1e-12, 1e-100, 800, 12); }
TEST(ModelKernels, AgreeWithLongDoubleInFloat) { compare<float>(1e-5, 1e-12f, 800, 6); }

TEST(ModelKernels, Reciprocal) {
  for (const Kernel<double>& kernel : kernels<double>()) {
    SCOPED_TRACE(kernel.name);
    std::mt19937 rng(6);
    double worst = 0.0;
    for (const auto& pair : reference::pairs(500, 12)) {
      const Draw d = draw(rng);
      const double f = kernel.tested(pair.l, pair.b, d), r = kernel.tested(pair.b, pair.l, d);
      worst = std::max(worst, std::abs(f - r) / std::max(1e-100, std::abs(f)));
    }
    if (kernel.reciprocal)
      EXPECT_LT(worst, 1e-12);
    else
      EXPECT_GT(worst, 1e-3);  // a law that does not hold must be seen not to hold
  }
}

}  // namespace
}  // namespace atrium::material
