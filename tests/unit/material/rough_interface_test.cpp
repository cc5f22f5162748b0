#include "material/rough_interface.h"

#include <random>

#include <gtest/gtest.h>

#include "long_double_reference.h"

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;

class Directions {
 public:
  // Unit to the last bit of long double only in its own precision; what is compared gets the
  // rounded numbers.
  Vec3d next(double sign, double lowest = 0.0) {
    for (;;) {
      const double z = lowest + (1.0 - lowest) * u_(random_);
      const double phi = 2.0 * kPi * u_(random_);
      const double s = std::sqrt((1.0 - z) * (1.0 + z));
      if (z > 0.0) return {s * std::cos(phi), s * std::sin(phi), sign * z};
    }
  }
  double uniform() { return u_(random_); }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> u_{0.0, 1.0};
};

reference::Vec exact(const Vec3d& v) { return reference::unit({v.x(), v.y(), v.z()}); }

TEST(RoughInterface, NormalisationAgainstExtendedPrecision) {
  for (const double c : {0.0, 1e-3, 0.7, 2.0, 7.99, 8.01, 40.0, 1e3, 1e6}) {
    const long double expected = reference::facets_norm(c);
    EXPECT_NEAR(static_cast<double>(gaussian_facets_norm(c) / expected), 1.0, 1e-13) << c;
  }
}

// Unit vectors in double are unit to 2e-16 only, and the exponent c^2 delta^2 multiplies what
// delta loses there: hence the allowance of 1e-15 times it.
TEST(RoughInterface, BrdfAgainstExtendedPrecision) {
  Directions directions;
  int compared = 0;
  for (const double c : {0.0, 0.5, 3.0, 10.0, 100.0}) {
    const GaussianFacets<double> facets(c);
    const long double norm = reference::facets_norm(c);
    for (const auto& [n, k] : {std::pair{1.5, 0.0}, {0.27, 2.95}, {1.0, 5.0}, {0.66, 0.0}})
      for (int i = 0; i < 300; ++i) {
        const Vec3d l = directions.next(1.0), b = directions.next(1.0);
        const long double expected = reference::brdf(exact(l), exact(b), c, norm, n, k);
        if (!(expected > 1e-200L)) continue;
        const double x = c * angle_to_normal<double>(l + b);
        EXPECT_NEAR(static_cast<double>(brdf_specular(l, b, facets, n, k) / expected), 1.0,
                    1e-12 + 1e-15 * x * x)
            << c << " " << n << " " << k;
        ++compared;
      }
  }
  EXPECT_GT(compared, 4000);
}

TEST(RoughInterface, BtdfAgainstExtendedPrecision) {
  Directions directions;
  int compared = 0;
  for (const double c : {0.0, 1.0, 5.0, 20.0}) {
    const GaussianFacets<double> facets(c);
    const long double norm = reference::facets_norm(c);
    for (const auto& [n1, n2] : {std::pair{1.0, 1.5}, {1.5, 1.0}, {1.33, 1.52}, {1.0, 2.4}})
      for (int i = 0; i < 600; ++i) {
        const Vec3d l = directions.next(-1.0), b = directions.next(1.0);
        const long double expected = reference::btdf(exact(l), exact(b), c, norm, n1, n2);
        const double value = btdf_specular(l, b, facets, n1, n2);
        if (!(expected > 1e-200L)) {
          EXPECT_LE(value, 1e-150);
          continue;
        }
        // At the edge of refraction 1 - F goes to 0 with a root: its relative error is unbounded.
        const auto h = refracting_facet<double>(l, b, n2 / n1);
        if (!h || b.dot(*h) < 1e-3 || -l.dot(*h) < 1e-3) continue;
        const double x = c * angle_to_normal(*h);
        EXPECT_NEAR(static_cast<double>(value / expected), 1.0, 2e-12 + 4e-15 * x * x)
            << c << " " << n1 << " " << n2;
        ++compared;
      }
  }
  EXPECT_GT(compared, 1000);
}

TEST(RoughInterface, GrazingDirectionsGiveNumbers) {
  for (const double c : {0.0, 3.0, 1e6})
    for (const double z : {5e-324, 1e-300, 1e-60, 1e-30, 1e-8})
      for (const Masking masking : {Masking::None, Masking::VCavity, Masking::Smith}) {
        const GaussianFacets<double> facets(c);
        const Vec3d l(-1.0, 0.0, z), b(1.0, 0.0, z);
        for (const double f : {brdf_specular(l, b, facets, 0.27, 2.95, masking),
                               brdf_specular(b, b, facets, 1.5, 0.0, masking),
                               btdf_specular(-b, b, facets, 1.0, 1.5, masking)})
          EXPECT_TRUE(std::isfinite(f) && f >= 0.0) << c << " " << z << " " << f;
      }
}

TEST(RoughInterface, Reciprocity) {
  Directions directions;
  for (const Masking masking : {Masking::None, Masking::VCavity, Masking::Smith})
    for (const double c : {0.3, 3.0, 12.0}) {
      const GaussianFacets<double> facets(c);
      for (int i = 0; i < 40; ++i) {
        const Vec3d l = directions.next(1.0, 0.05), b = directions.next(1.0, 0.05);
        const double f = brdf_specular(l, b, facets, 0.27, 2.95, masking);
        EXPECT_NEAR(f, brdf_specular(b, l, facets, 0.27, 2.95, masking), 1e-12 * f);
        // f_t(l -> b) / n_b^2 = f_t(b -> l) / n_l^2, the surface turned over for the way back.
        const Vec3d t = directions.next(-1.0, 0.05);
        const double there = btdf_specular(t, b, facets, 1.1, 1.7, masking) / (1.1 * 1.1);
        const double back = btdf_specular(-b, -t, facets, 1.7, 1.1, masking) / (1.7 * 1.7);
        EXPECT_NEAR(there, back, 1e-10 * there + 1e-290);
      }
    }
}

// Weak white furnace: the integral of D G1 max(0, b.h) over the facets is n.b. Smith's Lambda is
// another integral over other variables, so this is a second method.
TEST(Smith, WeakWhiteFurnace) {
  for (const double c : {0.0, 0.3, 1.0, 3.0, 10.0, 60.0})
    for (const double theta : {0.1, 0.7, 1.2, 1.5}) {
      const GaussianFacets<double> facets(c);
      const double end = std::min(0.5 * kPi, 6.5 / std::max(c, 1e-9));
      const auto ring = [&](long double d) -> long double {
        // Azimuth by hand: the mean of max(0, a + b cos(phi)).
        const double a = std::cos(theta) * std::cos(static_cast<double>(d));
        const double b = std::sin(theta) * std::sin(static_cast<double>(d));
        double mean = a;
        if (b > a) {
          const double edge = std::acos(-a / b);
          mean = (a * edge + b * std::sin(edge)) / kPi;
        }
        return facets.density(static_cast<double>(d)) * std::sin(static_cast<double>(d)) * mean;
      };
      const double seen =
          2.0 * kPi *
          static_cast<double>(reference::simpson(ring, 0.0L, end * (1 - 1e-15L), 20000));
      EXPECT_NEAR(smith(c, theta).g1 * seen / std::cos(theta), 1.0, 2e-7) << c << " " << theta;
    }
}

TEST(Smith, Limits) {
  EXPECT_EQ(smith(3.0, 0.0).lambda, 0.0);
  EXPECT_EQ(smith(3.0, 0.0).g1, 1.0);
  EXPECT_TRUE(std::isinf(smith(3.0, 0.5 * kPi).lambda));
  EXPECT_EQ(smith(3.0, 0.5 * kPi).g1, 0.0);
  // Lambda cos(theta) tends to a finite value at grazing angles.
  const double near = smith(3.0, 0.5 * kPi - 1e-6).lambda * 1e-6;
  EXPECT_NEAR(near / (smith(3.0, 0.5 * kPi - 1e-8).lambda * 1e-8), 1.0, 1e-4);
  // Beckmann's form is good to 0.007 in G1 for c >= 3.
  for (const double theta : {0.3, 0.9, 1.3, 1.5}) {
    const double a = 3.0 * (0.5 * kPi - theta);
    const double beckmann = 0.5 * (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a));
    EXPECT_NEAR(smith(3.0, theta).g1, 1.0 / (1.0 + beckmann), 0.007) << theta;
  }
  for (const double c : {0.0, 1.0, 1e3, 1e6})
    for (const double theta : {1e-9, 0.5, 1.57, 0.5 * kPi - 1e-12}) {
      EXPECT_TRUE(smith(c, theta).lambda >= 0.0 && std::isfinite(smith(c, theta).lambda));
      EXPECT_TRUE(smith(c, theta).g1 > 0.0 && smith(c, theta).g1 <= 1.0);
    }
}

TEST(Smith, TableFollowsTheIntegral) {
  for (const double c : {0.0, 0.4, 1.0, 3.0, 10.0, 100.0, 2000.0}) {
    const SmithTable table(c);
    double worst = 0.0;
    for (int i = 0; i <= 500; ++i) {
      const double mu = std::pow(i / 500.0, 3.0);
      worst = std::max(
          worst, std::abs(static_cast<double>(table.g1(static_cast<float>(mu))) -
                          smith(c, std::acos(static_cast<double>(static_cast<float>(mu)))).g1));
    }
    EXPECT_LT(worst, 3e-5) << c;
    const double gl = smith(c, std::acos(0.3)).lambda, gb = smith(c, std::acos(0.6)).lambda;
    EXPECT_NEAR(static_cast<double>(table.reflection(0.3f, 0.6f)), 1.0 / (1.0 + gl + gb), 4e-5);
  }
}

// F = 1, V-cavities: the peak lies off the mirror direction by 1/(4 cos cos) (MATERIAL_MODEL 5.3).
TEST(RoughInterface, OffSpecularPeak) {
  const auto peak = [](double c, double incidence) {
    const GaussianFacets<double> facets(c);
    const Vec3d l(-std::sin(incidence), 0.0, std::cos(incidence));
    double best = -1.0, angle = 0.0;
    for (double t = 0.0; t < 89.9; t += 0.05) {
      const double a = t * kPi / 180.0;
      const double f =
          brdf_specular(l, {std::sin(a), 0.0, std::cos(a)}, facets, 1.0, 1e8, Masking::VCavity);
      if (f > best) {
        best = f;
        angle = t;
      }
    }
    return angle;
  };
  EXPECT_NEAR(peak(5.0, kPi / 6.0), 33.0, 0.5);
  EXPECT_NEAR(peak(3.0, kPi / 6.0), 41.0, 0.5);
  EXPECT_NEAR(peak(10.0, kPi / 3.0), 62.25, 0.15);
  EXPECT_NEAR(peak(3.0, kPi / 3.0), 80.0, 0.5);
}

TEST(Coherent, ClosedForms) {
  EXPECT_NEAR(coherent_reflection(0.5, 50e-9, 500e-9), std::exp(-std::pow(0.2 * kPi, 2)), 1e-15);
  EXPECT_EQ(coherent_reflection(1.0, 0.0, 5e-7), 1.0);
  EXPECT_EQ(coherent_reflection_mean(0.0, 5e-7), 1.0);
  // Cosine mean, 2 * integral of Gamma mu dmu, by Simpson.
  const long double mean = reference::simpson(
      [](long double mu) -> long double {
        return 2 * mu * coherent_reflection(static_cast<double>(mu), 80e-9, 500e-9);
      },
      0.0L, 1.0L, 2000);
  EXPECT_NEAR(coherent_reflection_mean(80e-9, 500e-9), static_cast<double>(mean), 1e-12);
  // Straight through at normal incidence: phase (n2 - n1) sigma.
  EXPECT_NEAR(coherent_transmission(1.0, 50e-9, 500e-9, 1.0, 1.5),
              std::exp(-std::pow(2.0 * kPi * 0.1 * 0.5, 2)), 1e-15);
  EXPECT_EQ(coherent_transmission(0.1, 50e-9, 500e-9, 1.5, 1.0), 0.0);  // total reflection
}

TEST(RoughInterface, ConvexCombination) {
  const GaussianFacets<double> facets(6.0);
  const Vec3d l = Vec3d(0.3, 0.1, 0.8).normalized(), b = Vec3d(-0.2, 0.0, 0.9).normalized();
  const double f_s = brdf_specular(l, b, facets, 1.5, 0.0);
  EXPECT_NEAR(brdf_convex(l, b, facets, 1.5, 0.4, 0.6, 0.5, std::nullopt), 0.2 / kPi + 0.6 * f_s,
              1e-15);
  const double gamma = std::exp(-std::pow(4.0 * kPi * 0.1 * std::min(l.z(), b.z()), 2));
  EXPECT_NEAR(brdf_convex(l, b, facets, 1.5, 0.4, 0.6, 0.5, 0.1),
              0.2 / kPi + 0.6 * (1.0 - gamma) * f_s, 1e-15);
}

}  // namespace
}  // namespace atrium::material
