#include "material/models/he.h"

#include <gtest/gtest.h>

#include "material/models/cook_torrance.h"
#include "reference.h"

namespace atrium::material {
namespace {

using reference::Long;
constexpr double kPi = std::numbers::pi;

double relative(double value, Long expected) {
  return static_cast<double>(std::abs(static_cast<Long>(value) - expected) / std::abs(expected));
}

// The issue asks for 1e-6; the summand's exponent, up to 700, limits what double can do.
TEST(HeSum, EqualsTheSeriesTermByTerm) {
  int compared = 0;
  for (int i = 0; i <= 48; ++i) {
    const double g = std::pow(10.0, -6.0 + 0.25 * i);
    std::vector<double> B = {0.0};
    for (int j = -6; j <= 6; ++j) B.push_back(std::pow(10.0, j));
    for (const double factor : {1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0}) {
      B.push_back(factor * g);  // tan^2 delta = factor m^2 for large g
      B.push_back(factor * g * g);
    }
    for (const double b : B) {
      const Long expected = reference::he_sum(g, b);
      const double value = he_sum(g, b);
      ASSERT_TRUE(std::isfinite(value)) << g << ' ' << b;
      if (expected < 1e-290L) {
        EXPECT_LE(value, 1.01e-290) << g << ' ' << b;
        continue;
      }
      ++compared;
      EXPECT_LT(relative(value, expected), 1e-12) << "g " << g << " B " << b << " S " << value;
    }
  }
  EXPECT_GT(compared, 700);
}

// Where the two ways of summing meet nothing may jump.
TEST(HeSum, DirectAndTrapezoidalSumsMeet) {
  for (const double g : {49.0, 49.9, 49.999, 50.0, 50.001, 51.0})
    for (const double b : {0.0, 1e-3, 1.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << "g " << g << " B " << b);
      EXPECT_LT(relative(he_sum(g, b), reference::he_sum(g, b)), 1e-13);
    }
}

TEST(HeSum, Limits) {
  EXPECT_EQ(he_sum(0.0, 0.0), 0.0);
  EXPECT_EQ(he_sum(0.0, 1.0), 0.0);
  // g -> 0: the first term only.
  EXPECT_NEAR(he_sum(1e-12, 2.0) / (1e-12 * std::exp(-2.0)), 1.0, 1e-11);
  // g -> inf: e^{-B/g} / g for B/g of order one.
  EXPECT_NEAR(he_sum(1e10, 1e10) * 1e10 * std::exp(1.0), 1.0, 1e-9);
  EXPECT_GE(he_sum(1e-300, 1e300), 0.0);
  EXPECT_EQ(he_sum(1.0, 1e300), 0.0);
  EXPECT_EQ(he_sum(1e-6, 1e6), 0.0);
}

// Sum and integral over m of (g^m e^-g / m!) / m against its generating property: with B = 0,
// d/dg [e^g S] = (e^g - 1)/g, so S e^g = Ein(-g) ~ integral of (e^t - 1)/t from 0 to g.
TEST(HeSum, IsAnExponentialIntegralForBZero) {
  for (const double g : {0.01, 1.0, 10.0, 40.0, 60.0}) {
    const int panels = 20000;
    Long sum = 0;
    const auto f = [&](Long t) {
      return t == 0 ? std::exp(-static_cast<Long>(g))
                    : std::expm1(t) / t * std::exp(-static_cast<Long>(g));
    };
    for (int i = 0; i <= panels; ++i)
      sum += f(static_cast<Long>(g) * i / panels) * (i == 0 || i == panels ? 1
                                                     : i % 2 == 1          ? 4
                                                                           : 2);
    EXPECT_LT(relative(he_sum(g, 0.0), sum * g / panels / 3), 1e-10) << g;
  }
}

TEST(LambertW, SolvesItsEquationOverAllExponents) {
  for (double x = -700.0; x < 1e6; x += 0.37 + std::abs(x) * 0.01) {
    const double w = lambert_w_of_exp(x);
    // Both w and ln w carry rounding of their own size; ln w reaches 700.
    const Long residual = static_cast<Long>(w) + std::log(static_cast<Long>(w)) - x;
    EXPECT_LT(std::abs(static_cast<double>(residual)), 4e-16 * (4.0 + w)) << x;
  }
  EXPECT_NEAR(lambert_w_of_exp(1.0), 1.0, 1e-15);  // W(e) = 1
}

TEST(HeSigma, SolvesTheEquationOfTheArticle) {
  for (const double sigma0 : {1e-3, 0.1, 1.0, 10.0})
    for (const double tau : {0.5, 1.0, 5.0})
      for (const double ti : {0.0, 0.3, 1.0, 1.5, 1.57, 0.5 * kPi})
        for (const double tr : {0.0, 0.7, 1.4, 1.5707963, 0.5 * kPi}) {
          SCOPED_TRACE(testing::Message() << sigma0 << ' ' << tau << ' ' << ti << ' ' << tr);
          const double sigma = he_sigma(ti, tr, sigma0, tau);
          const Long i = ti, r = tr;
          EXPECT_LT(relative(sigma, reference::he_sigma(std::cos(i), std::sin(i), std::cos(r),
                                                        std::sin(r), sigma0, tau)),
                    1e-12);
          EXPECT_EQ(sigma, he_sigma(tr, ti, sigma0, tau));
          EXPECT_GT(sigma, 0.0);
          EXPECT_LE(sigma, sigma0);
        }
  EXPECT_EQ(he_sigma(0.0, 0.0, 0.3, 1.0), 0.3);
  EXPECT_EQ(he_sigma(1.0, 1.0, 0.0, 1.0), 0.0);
}

// Section 11 item 8: geometric optics. Inside tan^2 delta <= 4 m^2, with m = 2 sigma/tau of the
// effective sigma, the lobe is F S D_Beckmann / (4 cos cos).
TEST(He, TendsToTheMicrofacetModelForRoughSurfaces) {
  for (const double sigma_over_lambda : {30.0, 100.0, 1000.0})
    for (const double slope : {0.1, 0.3})
      for (const double theta_b : {0.0, 0.5, 1.0}) {
        const double lambda = 0.5, sigma0 = sigma_over_lambda * lambda, tau = 2.0 * sigma0 / slope;
        const Vec3d b = reference::polar(std::cos(theta_b), 0.3);
        for (double theta = 0.0; theta < 1.25; theta += 0.05)
          for (const double phi : {0.3, 0.3 + kPi, 1.5}) {
            const Vec3d l = reference::polar(std::cos(theta), phi);
            const He1991<double> h = he1991(l, b, sigma0, tau, lambda, 0.27, 2.95);
            const double m = 2.0 * h.sigma_eff / tau;
            const detail::Halfway<double> q(l, b);
            if (q.tan2_delta() > 4.0 * m * m) continue;
            const double expected = fresnel(q.cos_phi(), 0.27, 2.95).mean() * h.S *
                                    beckmann_density(q.tan2_delta(), m) / (4.0 * l.z() * b.z());
            EXPECT_NEAR(h.dd / expected, 1.0, 0.01) << sigma_over_lambda << ' ' << theta;
          }
      }
}

// ... and with the model of this library: S and V-cavities both tend to 1 for small slopes.
TEST(He, EqualsCookTorranceForRoughSurfacesOfSmallSlope) {
  const double lambda = 0.5, slope = 0.1, sigma0 = 30.0 * lambda, tau = 2.0 * sigma0 / slope;
  for (const double theta_b : {0.0, 0.4, 0.8})
    for (double offset = -0.15; offset < 0.16; offset += 0.05) {
      const Vec3d b = reference::polar(std::cos(theta_b), 0.0);
      const Vec3d l = reference::polar(std::cos(theta_b + offset), kPi);
      EXPECT_NEAR(
          he1991(l, b, sigma0, tau, lambda, 1.5, 0.0).dd / cook_torrance(l, b, slope, 1.5, 0.0),
          1.0, 0.01)
          << theta_b << ' ' << offset;
    }
}

// Directional albedo of dd for n -> F: midpoint rule over (q_x, q_y) = l_xy + b_xy, in which the
// lobe is smooth; dw = dl_x dl_y / cos.
double dd_albedo(double theta_b, double sigma0, double tau, double lambda, double k) {
  const Vec3d b = reference::polar(std::cos(theta_b), 0.0);
  const int radial = 300, azimuthal = 120;
  double sum = 0.0;
  for (int i = 0; i < radial; ++i)
    for (int j = 0; j < azimuthal; ++j) {
      // sin(theta) = sin(pi/2 x) bunches rings at grazing angles, where cos in dw vanishes.
      const double t = 0.5 * kPi * (i + 0.5) / radial, phi = 2.0 * kPi * (j + 0.5) / azimuthal;
      const Vec3d l = reference::polar(std::cos(t), phi);
      sum += he1991(l, b, sigma0, tau, lambda, 1.0, k).dd * std::cos(t) * std::sin(t);
    }
  return sum * 0.5 * kPi / radial * 2.0 * kPi / azimuthal;
}

TEST(He, SpecularAndDiffuseAddUpToOneForAPerfectReflector) {
  const double k = 1e8;  // F = 1
  for (const double sigma : {0.1, 0.15, 0.2}) {
    const double lambda = 1.0, tau = 3.0;
    const He1991<double> normal =
        he1991(Vec3d(0, 0, 1), Vec3d(0, 0, 1), sigma, tau, lambda, 1.0, k);
    EXPECT_NEAR(normal.specular + dd_albedo(0.0, sigma, tau, lambda, k), 1.0, 2e-3) << sigma;
    // Off normal up to 1.012, see the header.
    for (const double theta : {0.4, 0.8, 1.1, 1.3}) {
      const Vec3d b = reference::polar(std::cos(theta), 0.0);
      const Vec3d l(-b.x(), -b.y(), b.z());
      const double sum = he1991(l, b, sigma, tau, lambda, 1.0, k).specular +
                         dd_albedo(theta, sigma, tau, lambda, k);
      EXPECT_LT(sum, 1.0125) << sigma << ' ' << theta;
      EXPECT_GT(sum, 0.8) << sigma << ' ' << theta;
    }
  }
}

TEST(He, TendsToAMirrorForSmoothSurfaces) {
  for (const double theta : {0.0, 0.5, 1.0, 1.4}) {
    const Vec3d b = reference::polar(std::cos(theta), 0.0), l(-b.x(), -b.y(), b.z());
    const double F = fresnel(b.z(), 0.27, 2.95).mean();
    const He1991<double> h = he1991(l, b, 1e-3 * 0.5, 2.0, 0.5, 0.27, 2.95);
    EXPECT_NEAR(h.specular / F, 1.0, 2e-4);  // e^-g, g <= (4 pi 1e-3)^2 = 1.6e-4
    EXPECT_LT(dd_albedo(theta, 1e-3 * 0.5, 2.0, 0.5, 1e8), 2e-4);
    const He1991<double> flat = he1991(l, b, 0.0, 2.0, 0.5, 0.27, 2.95);
    EXPECT_EQ(flat.dd, 0.0);
    EXPECT_DOUBLE_EQ(flat.specular, F);
  }
}

}  // namespace
}  // namespace atrium::material
