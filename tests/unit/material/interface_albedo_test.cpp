#include "material/interface_albedo.h"

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;

// The albedo as it is defined, a midpoint sum over directions of light that is finer towards the
// ends: nothing shared with the library's integral over facets.
template <class F>
double midpoint_sum(F&& f, int n) {
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double t = (i + 0.5) / n, s = (j + 0.5) / n;
      const double theta = 0.5 * kPi * smooth(t), phi = kPi * smooth(s);
      const Vec3d l(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta));
      sum += f(l) * l.z() * std::sin(theta) * t * (1.0 - t) * s * (1.0 - s);
    }
  return sum * 36.0 * kPi * kPi / n / n;
}

// Second order: two grids give the next one (Richardson).
template <class F>
double over_hemisphere(F&& f, int n = 200) {
  return (4.0 * midpoint_sum(f, 2 * n) - midpoint_sum(f, n)) / 3.0;
}

Vec3d at(double mu) { return {std::sqrt(1.0 - mu * mu), 0.0, mu}; }

TEST(InterfaceAlbedo, IsTheIntegralOverDirections) {
  for (const double c : {0.0, 1.0, 4.0, 12.0})
    for (const double mu : {0.15, 0.6, 1.0}) {
      SCOPED_TRACE(testing::Message() << "c " << c << " mu " << mu);
      const GaussianFacets<double> facets(c);
      EXPECT_NEAR(specular_albedo(mu, c, 0.27, 2.95), over_hemisphere([&](const Vec3d& l) {
                    return brdf_specular(l, at(mu), facets, 0.27, 2.95);
                  }),
                  3e-5);
      for (const double n : {1.5, 1.0 / 1.5}) {
        // At the edge of total reflection the sum itself still moves by 6e-5 on a finer grid.
        const double tolerance = n > 1.0 ? 3e-5 : 1e-4;
        const InterfaceAlbedo albedo = dielectric_albedo(mu, c, n);
        EXPECT_NEAR(albedo.reflected, over_hemisphere([&](const Vec3d& l) {
                      return brdf_specular(l, at(mu), facets, n, 0.0);
                    }),
                    tolerance);
        // Flux from b into the other side: b's light, seen below, in that medium's radiance.
        EXPECT_NEAR(albedo.transmitted, over_hemisphere([&](const Vec3d& t) {
                      return btdf_specular(-at(mu), t, facets, n, 1.0);
                    }),
                    tolerance);
      }
    }
}

TEST(InterfaceAlbedo, SmithAndNoneToo) {
  const GaussianFacets<double> facets(2.0);
  for (const Masking masking : {Masking::None, Masking::Smith})
    EXPECT_NEAR(
        white_albedo(0.5, 2.0, masking),
        over_hemisphere(
            [&](const Vec3d& l) { return brdf_specular(l, at(0.5), facets, 1.0, 1e9, masking); },
            40),
        3e-4);
}

// MATERIAL_MODEL 5.5: what one scattering loses.
TEST(InterfaceAlbedo, LossOfOneScattering) {
  EXPECT_NEAR(1.0 - mean_white_albedo(10.0), 0.005, 0.0005);
  EXPECT_NEAR(1.0 - mean_white_albedo(5.0), 0.02, 0.001);
  EXPECT_NEAR(1.0 - mean_white_albedo(3.0), 0.06, 0.005);
  EXPECT_NEAR(1.0 - mean_white_albedo(2.0), 0.125, 0.001);
  EXPECT_NEAR(1.0 - mean_white_albedo(1.0), 0.31, 0.005);
}

// The closed form for c = 0 at normal view: l is uniform over the facets, D = 1/pi, and the
// V-cavity G over bh = cos(d) is min(1, 2 cos(d), 2 cos(2 d)) for d < pi/4.
TEST(InterfaceAlbedo, RoughestAtNormalView) {
  // E = 2 integral of min(1, 2 cos 2d) sin d cos d dd (2 cos d > 1 throughout): the bend is at
  // pi/6.
  const double flat = 0.25;                                       // sin^2(pi/6)
  const double falling = 1.0 - std::pow(std::sin(kPi / 3.0), 2);  // (1 - sin^2 2d)/2 between
  EXPECT_NEAR(white_albedo(1.0, 0.0), flat + falling / 2.0, 1e-9);
}

TEST(InterfaceAlbedo, NeverAboveOneAndSmoothLimit) {
  for (const double c : {0.0, 0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 30.0, 300.0, 1e4})
    for (const double mu : {1e-3, 0.01, 0.1, 0.3, 0.6, 0.9, 1.0}) {
      SCOPED_TRACE(testing::Message() << "c " << c << " mu " << mu);
      EXPECT_LE(white_albedo(mu, c), 1.0 + 1e-9);
      for (const double n : {1.1, 1.5, 2.4, 1.0 / 1.1, 1.0 / 1.5}) {
        const InterfaceAlbedo a = dielectric_albedo(mu, c, n);
        EXPECT_GE(a.reflected, 0.0);
        EXPECT_GE(a.transmitted, 0.0);
        EXPECT_LE(a.reflected + a.transmitted, 1.0 + 1e-9);
      }
    }
  for (const double mu : {0.2, 0.5, 1.0})
    for (const double n : {1.5, 1.0 / 1.5}) {
      if (std::abs(mu - std::sqrt(std::max(0.0, 1.0 - n * n))) < 0.05) continue;
      const double f = fresnel_dielectric(mu, n).mean();
      const InterfaceAlbedo a = dielectric_albedo(mu, 1000.0, n);
      EXPECT_NEAR(a.reflected, f, 1e-3);
      EXPECT_NEAR(a.transmitted, 1.0 - f, 1e-3);
    }
}

TEST(CoupledInterface, AlbedoIsTheIntegralAndReciprocal) {
  const CoupledInterface plastic(4.0, 1.5, 0.8);
  const Vec3d b = at(0.5);
  // The body's B needs an albedo per direction: tabulate it over the cosine for the sum.
  std::vector<double> through(101);
  for (int i = 0; i <= 100; ++i)
    through[static_cast<std::size_t>(i)] = plastic.transmitted(std::max(i / 100.0, 1e-6));
  const double seen = plastic.transmitted(0.5);
  const double body = over_hemisphere(
      [&](const Vec3d& l) {
        const double x = l.z() * 100.0;
        const int i = std::min(99, static_cast<int>(x));
        const double B = through[static_cast<std::size_t>(i)] * (i + 1 - x) +
                         through[static_cast<std::size_t>(i) + 1] * (x - i);
        return 0.8 * B * seen / (kPi * plastic.mean_transmitted());
      },
      30);
  EXPECT_NEAR(plastic.albedo(0.5), 1.0 - plastic.transmitted(0.5) + body, 1e-3);
  const Vec3d l = Vec3d(0.4, 0.5, 0.7).normalized();
  EXPECT_NEAR(plastic.brdf(l, b), plastic.brdf(b, l), 1e-14);
  EXPECT_NEAR(CoupledInterface(4.0, 1.5, 1.0).albedo(0.5), 1.0, 1e-12);
}

}  // namespace
}  // namespace atrium::material
