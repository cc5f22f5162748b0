#include <cfenv>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "material/models/lobes.h"

namespace atrium::material {
namespace {

template <class Real>
std::vector<Vec3<Real>> edge_directions() {
  std::vector<Vec3<Real>> d = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  for (const double z : {1e-12, 1e-9, 1e-6, 1e-3, 0.5, 0.999999})
    for (const double phi : {0.0, 1.0, std::numbers::pi / 2, std::numbers::pi}) {
      const double s = std::sqrt((1.0 - z) * (1.0 + z));
      d.push_back(Vec3d(s * std::cos(phi), s * std::sin(phi), z).template cast<Real>());
    }
  return d;
}

// Finite and >= 0 without a division by zero, an overflow or an invalid operation on the way.
template <class Real>
void expect_clean(const std::string& name, const std::function<Real()>& f) {
  std::feclearexcept(FE_ALL_EXCEPT);
  const Real value = f();
  const int raised = std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  EXPECT_TRUE(std::isfinite(value)) << name;
  EXPECT_EQ(raised, 0) << name << (raised & FE_DIVBYZERO ? " division by zero" : "")
                       << (raised & FE_INVALID ? " invalid" : "")
                       << (raised & FE_OVERFLOW ? " overflow" : "");
}

template <class Real>
void kernels_are_clean() {
  const Real inf = std::numeric_limits<Real>::infinity();
  for (const auto& l : edge_directions<Real>())
    for (const auto& b : edge_directions<Real>()) {
      if (testing::Test::HasFailure()) {
        FAIL() << "l " << l.transpose() << " b " << b.transpose();
      }
      for (const Real p : {Real(0), Real(1e-3), Real(1), Real(1e8)}) {
        expect_clean<Real>("phong_1975", [&] { return phong_1975(l, b, Real(.5), Real(.5), p); });
        expect_clean<Real>("lafortune", [&] { return phong_lafortune(l, b, Real(0), Real(1), p); });
        expect_clean<Real>("blinn", [&] { return blinn_phong(l, b, Real(0), Real(1), p); });
      }
      for (const Real n : {Real(0.01), Real(1), Real(1) + Real(1e-6), Real(1.5), Real(100)})
        for (const Real k : {Real(0), Real(1e-8), Real(1e4)}) {
          for (const Real m : {Real(1e-6), Real(0.3), Real(100)})
            expect_clean<Real>("cook_torrance", [&] { return cook_torrance(l, b, m, n, k); });
          for (const Real a : {Real(1e-4), Real(1)})
            expect_clean<Real>("ggx", [&] { return ggx(l, b, a, n, k); });
          for (const Real sigma : {Real(0), Real(1e-6), Real(0.2), Real(1e3)})
            for (const Real tau : {Real(1e-3), Real(1), Real(1e6)}) {
              expect_clean<Real>("he dd",
                                 [&] { return he1991(l, b, sigma, tau, Real(.5), n, k).dd; });
              expect_clean<Real>("he specular",
                                 [&] { return he1991(l, b, sigma, tau, Real(.5), n, k).specular; });
            }
        }
      for (const Real s : {Real(0), Real(0.3), Real(1)}) {
        expect_clean<Real>("oren", [&] { return oren_nayar_qualitative(l, b, Real(1), s); });
        expect_clean<Real>("oren full", [&] { return oren_nayar_full(l, b, Real(1), s); });
      }
      for (const Real n : {Real(0.5), Real(1), Real(1) + Real(1e-6), Real(1.5), Real(100)})
        for (const Real t : {Real(0), Real(1e-9), Real(1), Real(1e9), inf})
          for (const Real g : {Real(-0.999), Real(0), Real(0.999)}) {
            const Vec3<Real> below(b.x(), b.y(), -b.z());
            expect_clean<Real>("hanrahan_krueger",
                               [&] { return hanrahan_krueger(l, b, n, Real(1), t, g); });
            expect_clean<Real>("transmission", [&] {
              return hanrahan_krueger_transmission(l, below, n, Real(1), t, g);
            });
            expect_clean<Real>("straight",
                               [&] { return hanrahan_krueger_straight<Real>(b.z(), n, t); });
          }
      for (const Real r : {Real(0), Real(1e-3), Real(0.5), Real(1)})
        for (const Real p : {Real(1e-4), Real(1)})
          expect_clean<Real>("schlick", [&] { return schlick1994(l, b, Real(.5), r, p).f; });
    }
}

TEST(ModelKernels, RaiseNoExceptionAtTheEdgesInDouble) { kernels_are_clean<double>(); }
TEST(ModelKernels, RaiseNoExceptionAtTheEdgesInFloat) { kernels_are_clean<float>(); }

// Without light from above or a viewer above there is nothing, whatever the model.
TEST(ModelKernels, VanishBelowTheHorizonAndForNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3d up(0.6, 0.0, 0.8);
  for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(0.6, 0, -0.8), Vec3d(0, 0, nan)})
    for (const auto& [l, b] : {std::pair{d, up}, std::pair{up, d}}) {
      EXPECT_EQ(lambert(l, b, 0.5), 0.0);
      EXPECT_EQ(phong_1975(l, b, 0.5, 0.5, 3.0), 0.0);
      EXPECT_EQ(phong_lafortune(l, b, 0.5, 0.5, 3.0), 0.0);
      EXPECT_EQ(blinn_phong(l, b, 0.5, 0.5, 3.0), 0.0);
      EXPECT_EQ(cook_torrance(l, b, 0.3, 1.5, 0.0), 0.0);
      EXPECT_EQ(ggx_schlick(l, b, 0.3, 0.04), 0.0);
      EXPECT_EQ(oren_nayar_full(l, b, 0.5, 0.5), 0.0);
      EXPECT_EQ(oren_nayar_qualitative(l, b, 0.5, 0.5), 0.0);
      EXPECT_EQ(hanrahan_krueger(l, b, 1.4, 0.5, 1.0, 0.0), 0.0);
      EXPECT_EQ(schlick1994(l, b, 0.5, 0.3, 1.0).f, 0.0);
      EXPECT_EQ(he1991(l, b, 0.1, 1.0, 0.5, 1.5, 0.0).dd, 0.0);
    }
}

template <class Parameters>
void refused(Parameters p, double Parameters::*field, const char* name,
             std::initializer_list<double> values) {
  EXPECT_NO_THROW(validate(p));
  std::vector<double> all(values);
  all.push_back(std::numeric_limits<double>::quiet_NaN());
  for (const double value : all) {
    p.*field = value;
    try {
      validate(p);
      ADD_FAILURE() << name << " = " << value << " was accepted";
    } catch (const std::invalid_argument& e) {
      const std::string text = e.what();
      EXPECT_NE(text.find(name), std::string::npos) << text;
      EXPECT_NE(text.find(" is not in "), std::string::npos) << text;
    }
  }
}

TEST(ModelParameters, OutOfRangeIsRefusedByName) {
  const double inf = std::numeric_limits<double>::infinity();
  refused(LambertParameters{}, &LambertParameters::rho, "rho", {-0.1, 1.1});
  refused(PhongParameters{}, &PhongParameters::kd, "kd", {-0.1, 1.1});
  refused(PhongParameters{}, &PhongParameters::ks, "ks", {0.6, -0.1});
  refused(PhongParameters{}, &PhongParameters::p, "p", {-1.0, inf});
  refused(CookTorranceParameters{}, &CookTorranceParameters::m, "m", {0.0, -0.1, inf});
  refused(CookTorranceParameters{}, &CookTorranceParameters::n, "n", {0.0, -1.0, inf});
  refused(CookTorranceParameters{}, &CookTorranceParameters::k, "k", {-1.0, inf});
  refused(CookTorranceParameters{}, &CookTorranceParameters::rho, "rho", {-1.0, 2.0});
  refused(GgxParameters{}, &GgxParameters::alpha, "alpha", {0.0, 1.1});
  refused(GgxParameters{}, &GgxParameters::f0, "f0", {-0.5, 1.1});
  refused(OrenNayarParameters{}, &OrenNayarParameters::s, "s", {-0.1, 1.1});
  refused(HanrahanKruegerParameters{}, &HanrahanKruegerParameters::g, "g", {-1.0, 1.0});
  refused(HanrahanKruegerParameters{}, &HanrahanKruegerParameters::W, "W", {-0.1, 1.1});
  refused(HanrahanKruegerParameters{}, &HanrahanKruegerParameters::taud, "taud", {-0.1});
  refused(HanrahanKruegerParameters{}, &HanrahanKruegerParameters::n, "n", {0.0});
  EXPECT_NO_THROW(validate(HanrahanKruegerParameters{.taud = inf}));
  refused(Schlick1994Parameters{}, &Schlick1994Parameters::r, "r", {-0.1, 1.1});
  refused(Schlick1994Parameters{}, &Schlick1994Parameters::f0, "f0", {-0.1, 1.1});
  refused(Schlick1994Parameters{}, &Schlick1994Parameters::p, "p", {0.0, 1.1});
  refused(He1991Parameters{}, &He1991Parameters::sigma0, "sigma0", {-0.1, inf});
  refused(He1991Parameters{}, &He1991Parameters::tau, "tau", {0.0, inf});
  refused(He1991Parameters{}, &He1991Parameters::lambda, "lambda", {0.0, -1.0});
  refused(He1991Parameters{}, &He1991Parameters::a, "a", {-0.1, 0.4});
}

}  // namespace
}  // namespace atrium::material
