#include "material/fresnel.h"

#include <cmath>

#include <gtest/gtest.h>

#include "material/pane.h"

namespace atrium::material {
namespace {

TEST(Fresnel, ClosedFormsAtNormalGrazingAndBrewster) {
  for (const double n : {0.01, 0.5, 1.0 + 1e-9, 1.5, 100.0})
    for (const double k : {0.0, 1e-8, 3.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << "n " << n << " k " << k);
      const double f0 = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
      EXPECT_NEAR(fresnel(1.0, n, k).mean(), f0, 1e-14);
      EXPECT_NEAR(fresnel(0.0, n, k).mean(), 1.0, 1e-14);
    }
  for (const double n : {1.0001, 1.5, 2.4}) {
    const double c = 1.0 / std::sqrt(1.0 + n * n);  // tan = n
    EXPECT_NEAR(fresnel_dielectric(c, n).p, 0.0, 1e-15);
    EXPECT_NEAR(fresnel_dielectric(c, n).s, std::pow((n * n - 1) / (n * n + 1), 2), 1e-14);
  }
}

// n -> 1: F(0) = ((n-1)/(n+1))^2 keeps its relative accuracy.
TEST(Fresnel, KeepsRelativeAccuracyNearMatchedIndices) {
  const double e = 0x1p-30;
  EXPECT_NEAR(fresnel_dielectric(1.0, 1.0 + e).mean() / (e * e / ((2 + e) * (2 + e))), 1.0, 1e-12);
}

TEST(Fresnel, MatchedIndexReflectsNothing) {
  for (const double c : {0.0, 1e-12, 0.5, 1.0}) EXPECT_EQ(fresnel(c, 1.0, 0.0).mean(), 0.0);
}

TEST(Fresnel, IsTheSameFromBothSides) {
  for (const double n : {1.1, 1.52, 2.4})
    for (const double c : {0.05, 0.4, 0.8, 1.0}) {
      const double inside = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
      EXPECT_NEAR(fresnel(c, n, 0.0).s, fresnel(inside, 1.0 / n, 0.0).s, 1e-13);
      EXPECT_NEAR(fresnel(c, n, 0.0).p, fresnel(inside, 1.0 / n, 0.0).p, 1e-13);
    }
}

TEST(Fresnel, ConductorFormWithVanishingAbsorptionIsTheDielectricForm) {
  for (const double n : {0.7, 1.3, 2.0})
    for (const double c : {0.01, 0.3, 0.5, 0.95})
      EXPECT_NEAR(fresnel(c, n, 1e-14).mean(), fresnel_dielectric(c, n).mean(), 1e-12);
}

template <class Real>
void check_guards() {
  for (const Real c : {Real(-0.5), Real(0), Real(1e-12), Real(0.5), Real(1), Real(1.5)})
    for (const Real n : {Real(0.01), Real(1), Real(1) + Real(1e-9), Real(100)})
      for (const Real k : {Real(0), Real(1e-30), Real(1e-8), Real(1e4)}) {
        const FresnelTerms<Real> f = fresnel(c, n, k);
        SCOPED_TRACE(testing::Message() << "c " << c << " n " << n << " k " << k);
        EXPECT_TRUE(f.s >= Real(0) && f.s <= Real(1));
        EXPECT_TRUE(f.p >= Real(0) && f.p <= Real(1));
      }
}

TEST(Fresnel, StaysInRangeAtTheEdgesOfItsDomain) {
  check_guards<float>();
  check_guards<double>();
}

// F_mean, a second method: published values for n = 1.5 and the law that couples both sides.
TEST(FresnelMean, IsConsistentAcrossTheInterface) {
  EXPECT_NEAR(fresnel_mean(1.5, 0.0), 0.0918, 5e-5);
  EXPECT_NEAR(fresnel_mean(1.0 / 1.5, 0.0), 0.5963, 5e-5);
  // (1 - F_i) = (1 - F_e) / n^2 holds exactly.
  for (const double n : {1.0001, 1.1, 1.5, 2.4, 10.0})
    EXPECT_NEAR(fresnel_mean(1.0 / n, 0.0), 1.0 - (1.0 - fresnel_mean(n, 0.0)) / (n * n), 1e-12);
  EXPECT_EQ(fresnel_mean(1.0, 0.0), 0.0);
}

// A clear pane: T = (1 - R)/(1 + R) and R_pane = 2R/(1 + R) per polarisation.
TEST(Pane, ClosedFormsWithoutAbsorption) {
  EXPECT_NEAR(pane(1.0f, 1.52f, 0.0f).transmittance, 0.9183f, 5e-5f);
  for (const float c : {0.02f, 0.3f, 0.6f, 1.0f}) {
    const FresnelTerms<double> r = fresnel_dielectric(static_cast<double>(c), 1.52);
    const double t = 0.5 * ((1 - r.s) / (1 + r.s) + (1 - r.p) / (1 + r.p));
    EXPECT_NEAR(static_cast<double>(pane(c, 1.52f, 0.0f).transmittance), t, 1e-6);
    EXPECT_NEAR(static_cast<double>(pane(c, 1.52f, 0.0f).reflectance), 1.0 - t, 1e-6);
  }
}

// Second method: the infinite series of internal reflections, summed path by path.
TEST(Pane, IsTheSumOverInternalReflections) {
  for (const double c : {0.05, 0.5, 1.0})
    for (const double kd : {0.01, 0.5, 3.0}) {
      const double inside = std::sqrt(1.0 - (1.0 - c * c) / (1.52 * 1.52));
      const double t = std::exp(-kd / inside);
      const FresnelTerms<double> f = fresnel_dielectric(c, 1.52);
      double transmitted = 0.0, reflected = 0.0;
      for (const double R : {f.s, f.p}) {
        double carried = (1.0 - R) * t;  // at the far face for the first time
        reflected += 0.5 * R;
        for (int bounce = 0; bounce < 400; ++bounce) {
          transmitted += 0.5 * carried * (1.0 - R);
          carried *= R * t;
          reflected += 0.5 * carried * (1.0 - R);
          carried *= R * t;
        }
      }
      const PaneTerms got = pane(static_cast<float>(c), 1.52f, static_cast<float>(kd));
      EXPECT_NEAR(static_cast<double>(got.transmittance), transmitted, 2e-6);
      EXPECT_NEAR(static_cast<double>(got.reflectance), reflected, 2e-6);
    }
}

// Data sheet values come back from the pane that they describe.
TEST(Pane, FromVisibleTransmittanceAndReflectance) {
  for (const double n : {1.0, 1.3, 1.52, 2.5})
    for (const double kd : {0.0, 0.01, 0.3, 5.0}) {
      const PaneTerms p = pane(1.0f, static_cast<float>(n), static_cast<float>(kd));
      const double tau = static_cast<double>(p.transmittance);
      const double rho = std::min(static_cast<double>(p.reflectance), 1.0 - tau);
      const PaneParameters got = pane_from_visible(tau, rho);
      EXPECT_NEAR(got.n, n, 1e-4 + (n == 1.0 ? 1e-3 : 0.0)) << kd;
      EXPECT_NEAR(got.kd, kd, 1e-5 * (1.0 + kd)) << n;
    }
  EXPECT_NEAR(pane_from_visible(0.9183, 0.0817).n, 1.52, 5e-4);
  for (const auto& [tau, rho] :
       {std::pair{0.0, 0.1}, {0.9, 0.2}, {0.5, -0.1}, {1.1, 0.0}, {NAN, 0.1}})
    EXPECT_THROW((void)pane_from_visible(tau, rho), std::invalid_argument) << tau << " " << rho;
}

TEST(Pane, GrazingAndMatchedAndOpaqueLimits) {
  EXPECT_EQ(pane(0.0f, 1.52f, 0.1f).transmittance, 0.0f);
  EXPECT_EQ(pane(0.0f, 1.52f, 0.1f).reflectance, 1.0f);
  EXPECT_EQ(pane(0.4f, 1.0f, 0.0f).transmittance, 1.0f);
  EXPECT_EQ(pane(0.4f, 1.0f, 0.0f).reflectance, 0.0f);
  EXPECT_NEAR(pane(1.0f, 1.52f, 1e4f).reflectance, 0.042580f, 1e-6f);  // the first face alone
  EXPECT_EQ(pane(1.0f, 1.52f, 1e4f).transmittance, 0.0f);
}

}  // namespace
}  // namespace atrium::material
