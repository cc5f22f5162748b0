#include "material/microfacet.h"

#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;

// Adaptive Simpson: a second method, sharing nothing with the library's quadrature.
double simpson(const std::function<double(double)>& f, double a, double b, int panels) {
  double sum = f(a) + f(b);
  for (int i = 1; i < panels; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(a + (b - a) * i / panels);
  return sum * (b - a) / panels / 3.0;
}

// Where the lobe ends: exp(-c^2 delta^2) < 1e-17 beyond.
double end_of_lobe(double c) { return std::min(0.5 * kPi, 6.3 / std::max(c, 1e-9)); }

Vec3f facet(double delta, double phi) {
  return {static_cast<float>(std::sin(delta) * std::cos(phi)),
          static_cast<float>(std::sin(delta) * std::sin(phi)), static_cast<float>(std::cos(delta))};
}

const double kAllC[] = {0.0, 1e-6, 1e-3, 0.1, 1.0, 3.0, 7.9, 8.0, 8.1, 20.0, 1e3, 1e6};

TEST(GaussianFacetsNorm, ProjectedAreaIsOneForEveryC) {
  for (const double c : kAllC) {
    SCOPED_TRACE(c);
    const double n = gaussian_facets_norm(c);
    const double area =
        simpson([&](double d) { return n * std::exp(-c * c * d * d) * kPi * std::sin(2.0 * d); },
                0.0, end_of_lobe(c), 4000);
    EXPECT_NEAR(area, 1.0, 1e-11);
  }
}

TEST(GaussianFacetsNorm, Limits) {
  EXPECT_NEAR(gaussian_facets_norm(0.0), 1.0 / kPi, 1e-14);
  EXPECT_NEAR(gaussian_facets_norm(1e6) * kPi / 1e12, 1.0, 1e-11);
  EXPECT_NEAR(gaussian_facets_norm(4.0) * kPi / 16.0, 1.04, 0.005);  // the limit is 4 % low there
}

// The class in float, with vectors: D and the density of sample() integrate to 1.
TEST(GaussianFacets, DensitiesIntegrateToOne) {
  for (const double c : kAllC) {
    SCOPED_TRACE(c);
    const GaussianFacets<float> facets(c);
    const auto over_sphere = [&](const std::function<double(const Vec3f&, double)>& f) {
      return simpson([&](double d) { return 2.0 * kPi * std::sin(d) * f(facet(d, 0.4), d); }, 0.0,
                     end_of_lobe(c), 2000);
    };
    // Float vectors know delta to 1e-7, the exponent c^2 delta^2 up to 40 to a few 1e-6.
    EXPECT_NEAR(over_sphere([&](const Vec3f& h, double d) {
                  return static_cast<double>(facets.density(h)) * std::cos(d);
                }),
                1.0, 1e-5);
    EXPECT_NEAR(
        over_sphere([&](const Vec3f& h, double) { return static_cast<double>(facets.pdf(h)); }),
        1.0, 1e-5);
  }
}

// Weak white furnace: the facets seen from any direction cover the projected area,
// integral of D G1 max(0, b.h) = n.b, with G1 = min(1, 2 (n.h)(n.b)/(b.h)).
TEST(GaussianFacets, VCavitiesPassTheWeakWhiteFurnace) {
  for (const double c : {0.0, 0.5, 1.0, 3.0, 10.0, 50.0})
    for (const double theta : {0.0, 0.4, 1.0, 1.4, 1.55}) {
      SCOPED_TRACE(testing::Message() << "c " << c << " theta " << theta);
      const GaussianFacets<float> facets(c);
      const Vec3f b = facet(theta, 0.0);
      const int rings = 600, sectors = 720;
      double sum = 0.0;
      for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
          const double d = end_of_lobe(c) * (i + 0.5) / rings;
          const Vec3f h = facet(d, 2.0 * kPi * (j + 0.5) / sectors);
          const float bh = b.dot(h);
          if (!(bh > 0.0f)) continue;
          // Seen along one direction only: the light's side is never the smaller one.
          const float g1 = g_vcavity(1e6f, b.z(), h.z(), bh, bh);
          sum += static_cast<double>(facets.density(h) * g1 * bh) * std::sin(d);
        }
      sum *= end_of_lobe(c) / rings * 2.0 * kPi / sectors;
      EXPECT_NEAR(sum / std::cos(theta), 1.0, 2e-3);  // midpoint rule across the kinks of G1
    }
}

// Chi-square of sample() against the analytic distribution of delta (16 classes of equal
// probability times 8 sectors). 127 degrees of freedom: mean 127, standard deviation 15.9; 200 has
// a probability of 4e-5, and eight cases leave 3e-4. Fixed seed.
TEST(GaussianFacets, SamplesFollowTheirDensity) {
  for (const double c : {0.0, 1e-4, 0.3, 1.0, 2.0, 5.0, 30.0, 1e4}) {
    SCOPED_TRACE(c);
    const GaussianFacets<float> facets(c);
    std::mt19937 random(17);
    std::uniform_real_distribution<float> u(0.0f, 1.0f);
    constexpr int kSamples = 40000, kRings = 16, kSectors = 8;
    std::vector<int> count(kRings * kSectors, 0);
    const double q = -std::expm1(-0.25 * kPi * kPi * c * c);
    for (int i = 0; i < kSamples; ++i) {
      const Vec3f h = facets.sample({u(random), u(random)});
      ASSERT_NEAR(h.norm(), 1.0f, 1e-6f);
      ASSERT_GE(h.z(), 0.0f);
      const double delta = static_cast<double>(angle_to_normal(h));
      const double cdf =
          c < 1e-3 ? std::pow(delta / (0.5 * kPi), 2) : -std::expm1(-c * c * delta * delta) / q;
      const double phi = std::atan2(static_cast<double>(h.y()), static_cast<double>(h.x()));
      const int ring = std::clamp(static_cast<int>(cdf * kRings), 0, kRings - 1);
      const int sector =
          std::clamp(static_cast<int>((phi / kPi + 1.0) * 0.5 * kSectors), 0, kSectors - 1);
      ++count[static_cast<std::size_t>(ring * kSectors + sector)];
    }
    const double expected = static_cast<double>(kSamples) / (kRings * kSectors);
    double chi2 = 0.0;
    for (const int n : count) chi2 += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi2, 200.0);
    EXPECT_GT(chi2, 65.0);  // and no more even than chance
  }
}

// pdf() is the derivative of that distribution: p = (dF/ddelta) / (2 pi sin delta), by differences
// of an expression that does not contain the density.
TEST(GaussianFacets, PdfIsTheDerivativeOfTheDistribution) {
  for (const double c : {1e-4, 2e-3, 0.5, 2.0, 20.0})
    for (const double x : {0.1, 0.5, 0.9}) {
      SCOPED_TRACE(testing::Message() << "c " << c << " x " << x);
      const GaussianFacets<float> facets(c);
      const double delta = x * std::min(0.5 * kPi, 2.0 / c), e = 1e-4 * delta;
      const auto distribution = [&](double d) { return -std::expm1(-c * c * d * d); };
      const double slope =
          (distribution(delta + e) - distribution(delta - e)) / (2.0 * e) / distribution(0.5 * kPi);
      const double expected = slope / (2.0 * kPi * std::sin(delta));
      EXPECT_NEAR(static_cast<double>(facets.pdf(facet(delta, 1.0))) / expected, 1.0, 1e-5);
    }
}

// D cos / p, the weight of importance sampling: bounded, close to 1 for c >= 3.
TEST(GaussianFacets, SamplingWeightIsCloseToOne) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  for (const double c : {0.0, 1.0, 3.0, 10.0, 1e3, 1e6}) {
    SCOPED_TRACE(c);
    const GaussianFacets<float> facets(c);
    double mean = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3f h = facets.sample({u(random), u(random)});
      const double w = static_cast<double>(facets.density(h) * h.z() / facets.pdf(h));
      ASSERT_GE(w, 0.0);
      ASSERT_LE(w, c < 3.0 ? 2.6 : 1.09);
      mean += w / 20000;
    }
    EXPECT_NEAR(mean, 1.0, c < 3.0 ? 0.02 : 0.005);  // 4 standard errors: sigma <= 0.7 resp. 0.1
  }
}

TEST(GaussianFacets, EdgesGiveNumbers) {
  for (const double c : {0.0, 1e-8, 1.0, 1e6}) {
    const GaussianFacets<float> facets(c);
    for (const float u : {0.0f, 1e-38f, 0.5f, 0.99999994f}) {
      const Vec3f h = facets.sample({u, u});
      EXPECT_TRUE(h.allFinite());
      EXPECT_TRUE(std::isfinite(facets.pdf(h)) && facets.pdf(h) >= 0.0f);
      EXPECT_TRUE(std::isfinite(facets.density(h)));
    }
    EXPECT_EQ(facets.density({0.0f, 0.0f, -1.0f}), 0.0f);
    EXPECT_EQ(facets.pdf({0.0f, 0.0f, -1.0f}), 0.0f);
    EXPECT_TRUE(std::isfinite(facets.density({1.0f, 0.0f, 1e-12f})));
    EXPECT_TRUE(std::isfinite(facets.pdf({1.0f, 0.0f, 0.0f})));
  }
}

// At small c the limit c -> 0 is off by c^2: not enough for double. Values computed with 30 digits.
TEST(GaussianFacets, SmallRoughnessKeepsAllDigits) {
  const GaussianFacets<double> facets(9e-4);
  const double delta = facets.sample_delta(0.5);
  EXPECT_NEAR(delta, 1.1107204570544587, 1e-14);
  EXPECT_NEAR(facets.pdf(delta), 0.15991824527728091, 1e-14);
  // The branch for the limit itself, from both sides and in both precisions.
  for (const double c : {0.0, 1e-200, 0.9e-15, 1.1e-15, 1e-9}) {
    EXPECT_NEAR(GaussianFacets<double>(c).sample_delta(0.5), 0.5 * kPi * std::sqrt(0.5), 1e-14);
    EXPECT_NEAR(GaussianFacets<float>(c).sample_delta(0.5f), 0.5 * kPi * std::sqrt(0.5), 3e-7);
    EXPECT_NEAR(GaussianFacets<double>(c).pdf(1.0), 4.0 / (kPi * kPi * kPi * std::sin(1.0)), 1e-15);
    EXPECT_NEAR(GaussianFacets<float>(c).pdf(1.0f), 4.0 / (kPi * kPi * kPi * std::sin(1.0)), 3e-8);
  }
}

TEST(Microfacet, VCavitiesAreSymmetricAndFinite) {
  EXPECT_FLOAT_EQ(g_vcavity(0.3f, 0.8f, 0.9f, 0.7f, 0.7f), g_vcavity(0.8f, 0.3f, 0.9f, 0.7f, 0.7f));
  EXPECT_EQ(g_vcavity(1.0f, 1.0f, 1.0f, 1.0f, 1.0f), 1.0f);
  EXPECT_EQ(g_vcavity(0.0f, 1.0f, 0.7f, 0.7f, 0.7f), 0.0f);
  EXPECT_EQ(g_vcavity(0.0f, 0.0f, 0.0f, 0.0f, 0.0f), 0.0f);
}

// delta = 1e-4 from float vectors: acos(n.h) would give 0 or 3.5e-4.
TEST(Microfacet, SmallAnglesKeepTheirDigits) {
  const Vec3f h(1e-4f, 0.0f, std::sqrt(1.0f - 1e-8f));
  EXPECT_NEAR(angle_to_normal(h) / 1e-4f, 1.0f, 1e-6f);
}

}  // namespace
}  // namespace atrium::material
