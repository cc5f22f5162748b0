#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "material/bsdf.h"
#include "material/interface_albedo.h"

// Bsdf<1> in float against the kernels in double, which rough_interface_test.cpp compares with
// extended precision. Both get the same directions and the same index, rounded to float.
namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;

struct Lane {
  Material material;
  ResolvedMaterial<1> resolved;
  Bsdf<1> bsdf;
  explicit Lane(const Material& m, bool front = true)
      : material(m),
        resolved(resolve_material<1>(material, SpectralBasis::grey())),
        bsdf(resolved, front, Spectrum<1>::one(), Spectrum<1>::one(), 1.0f) {}
};

Material rough(double n, double kappa, double c, Masking masking = Masking::VCavity) {
  Material m;
  m.n = n;
  m.kappa = kappa;
  m.c = c;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.fresnel_error = 0.0;
  m.masking = masking;
  return m;
}

// Not inlined: the vectoriser of GCC 12 drops the rounding where double becomes float and double
// again within one function, and the two sides would see different directions.
[[gnu::noinline]] Vec3f rounded(const Vec3d& v) { return v.cast<float>(); }

class Directions {
 public:
  explicit Directions(unsigned seed) : random_(seed) {}
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  /// Above the surface, grazing ones often.
  Vec3f above() {
    const double mu = uniform() < 0.3 ? std::pow(10.0, -6.0 * uniform()) : uniform();
    return at(mu, 2.0 * kPi * uniform());
  }
  static Vec3f at(double mu, double phi) {
    const double s = std::sqrt((1.0 - mu) * (1.0 + mu));
    return rounded({s * std::cos(phi), s * std::sin(phi), mu});
  }
  /// A facet with c delta up to `reach`.
  Vec3d facet(double c, double reach) {
    const double delta = std::min(0.5 * kPi, uniform() * reach / std::max(c, 1e-9));
    const double phi = 2.0 * kPi * uniform();
    return {std::sin(delta) * std::cos(phi), std::sin(delta) * std::sin(phi), std::cos(delta)};
  }

 private:
  std::mt19937 random_;
};

// Relative error allowed at an exponent x = c^2 delta^2: 1e-5 up to 16. Beyond, the roundings of
// the two directions (6e-8 each) go into delta relatively and double in its square, so that 2e-7
// for every unit of x is the conditioning, not the code.
double allowed(double exponent) { return 1e-5 * std::max(1.0, exponent / 16.0); }

double exponent_of(double c, const Vec3d& h) {
  const double x = c * angle_to_normal(h);
  return x * x;
}

// What float's rounding of the cosine at the facet, 6e-8, does to F: next to total reflection it
// follows a root.
double conditioning(const Lane& lane, double bh) {
  const auto n = static_cast<double>(lane.resolved.n[0]);
  const auto k = static_cast<double>(lane.resolved.k[0]);
  const double f = fresnel(bh, n, k).mean();
  double change = 0.0;
  for (const double step : {-1.2e-7, 1.2e-7})
    change = std::max(change, std::abs(fresnel(bh + step, n, k).mean() - f));
  return change / f;
}

// The same of 1 - F, which besides is a difference of floats, and the tested code's F is that of
// the viewer's side.
double lost_of_transmittance(double bh, double eta) {
  const double f = fresnel_dielectric(bh, eta).mean();
  double change = 2.4e-7;
  for (const double step : {-3e-7, 3e-7})  // the index from inside, 1 / n, is rounded too
    change = std::max(change, std::abs(fresnel_dielectric(bh + step, eta).mean() - f));
  return change / (1.0 - f);
}

const double kRoughness[] = {0.0, 1e-3, 0.3, 1.0, 3.0, 10.0, 100.0, 1e3, 1e4, 1e6};

// The largest relative error over the allowed one.
template <class Kernel>
double worst_reflection(const Lane& lane, double c, Directions& d, const Kernel& kernel) {
  double worst = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Vec3f wo = d.above();
    const Vec3d b = wo.cast<double>();
    // Half of the lights by a facet of the lobe, half anywhere.
    const Vec3d h = d.facet(c, 6.0);
    const Vec3d mirrored = (2.0 * b.dot(h) * h - b).normalized();
    const Vec3f wi = i % 2 == 0 && mirrored.z() > 1e-6 ? rounded(mirrored) : d.above();
    const Vec3d l = wi.cast<double>();
    const double expected = kernel(l, b);
    const auto value = static_cast<double>(lane.bsdf.eval(wo, wi).sum()[0]);
    const double exponent = exponent_of(c, l + b);
    if (exponent > 80.0 || expected < 1e-30) {  // at or below the end of float's range
      EXPECT_NEAR(value, expected, 1e-5 * expected + 1e-30 * (c * c + 1.0));
      continue;
    }
    const double bound = allowed(exponent) + conditioning(lane, 0.5 * (l + b).norm());
    worst = std::max(worst, std::abs(value - expected) / expected / bound);
  }
  return worst;
}

TEST(BsdfAccuracy, ReflectionIsTheKernelToFloat) {
  Directions d(1);
  const double metals[][2] = {{1.5, 0.0},  {0.27, 10.9}, {1.0 + 0x1p-20, 0.0},
                              {0.05, 0.0}, {10.0, 0.0},  {1.5, 1e-6},
                              {2.5, 4.0}};
  for (const auto& [n, kappa] : metals)
    for (const double c : kRoughness) {
      const Lane lane(rough(n, kappa, c));
      const GaussianFacets<double> facets(c);
      const auto ns = static_cast<double>(lane.resolved.n[0]);
      const auto ks = static_cast<double>(lane.resolved.k[0]);
      EXPECT_LE(worst_reflection(lane, c, d,
                                 [&](const Vec3d& l, const Vec3d& b) {
                                   return brdf_specular(l, b, facets, ns, ks);
                                 }),
                1.0)
          << "n " << n << " kappa " << kappa << " c " << c;
    }
}

// k_df rho_d / pi + k_rg (1 - Gamma) f_s.
TEST(BsdfAccuracy, ConvexCombinationIsTheKernelToFloat) {
  Directions d(2);
  for (const double c : kRoughness)
    for (const double sigma : {0.0, 20e-9, 500e-9, 1e-5}) {
      Material m = rough(1.5, 0.0, c);
      m.k_df = 0.25;
      m.k_rg = 0.75;
      m.body_reflectance = 0.5;
      m.sigma = sigma;
      const Lane lane(m);
      const GaussianFacets<double> facets(c);
      EXPECT_LE(worst_reflection(lane, c, d,
                                 [&](const Vec3d& l, const Vec3d& b) {
                                   return brdf_convex(l, b, facets, 1.5, 0.25, 0.75, 0.5,
                                                      sigma / 555e-9);
                                 }),
                1.0)
          << "c " << c << " sigma " << sigma;
    }
}

// From either side, directions within and without the lobe. The facet is a difference b + eta l:
// its angle is known to an ulp of the directions over |eta - 1|, which c^2 delta multiplies.
TEST(BsdfAccuracy, TransmissionIsTheKernelToFloat) {
  Directions d(3);
  for (const double n : {1.5, 1.01, 0.7, 2.5, 10.0, 0.05})
    for (const double c : {0.0, 0.3, 3.0, 30.0, 1e3, 1e4})
      for (const bool front : {true, false}) {
        if (std::abs(n - 1.0) < 1.1e-6 * c) continue;  // taken for smooth: floats cannot resolve it
        Material m = rough(n, 0.0, c);
        m.medium = Material::Medium::Solid;
        m.k_tp_rg = 1.0;
        const Lane lane(m, front);
        const auto ns = static_cast<double>(lane.resolved.n[0]);
        const double n1 = front ? 1.0 : ns, n2 = front ? ns : 1.0, eta = n2 / n1;
        const GaussianFacets<double> facets(c);
        double worst = 0.0;
        int lit = 0;
        for (int i = 0; i < 400; ++i) {
          const Vec3f wo = d.above();
          const Vec3d b = wo.cast<double>(), h = d.facet(c, 5.0);
          const double bh = b.dot(h), sine2 = (1.0 - bh * bh) / (eta * eta);
          Vec3d l = -d.above().cast<double>();
          if (bh > 0.0 && sine2 < 1.0) l = -b / eta + (bh / eta - std::sqrt(1.0 - sine2)) * h;
          if (!(l.z() < -1e-6)) continue;
          const Vec3f wi = rounded(l.normalized());
          l = wi.cast<double>();
          const double expected = btdf_specular(l, b, facets, n1, n2);
          const auto value = static_cast<double>(lane.bsdf.eval(wo, wi).lobe[0]);
          if (expected == 0.0) {
            EXPECT_EQ(value, 0.0);
            continue;
          }
          ++lit;
          const Vec3d facet = *refracting_facet<double>(l, b, eta);
          const double exponent = exponent_of(c, facet);
          if (exponent > 80.0 || expected < 1e-30) continue;
          const double bound = allowed(exponent) + lost_of_transmittance(b.dot(facet), eta);
          worst = std::max(worst, std::abs(value - expected) / expected / bound);
        }
        EXPECT_LE(worst, 1.0) << "n " << n << " c " << c << " front " << front;
        EXPECT_TRUE(lit > 10 || c > 30.0) << "n " << n << " c " << c << " front " << front;
      }
}

// Smith's G1 comes from a table, good to 3e-5.
TEST(BsdfAccuracy, SmithIsTheKernelToItsTable) {
  Directions d(4);
  for (const double c : {0.3, 3.0, 30.0}) {
    const Lane lane(rough(1.5, 0.0, c, Masking::Smith));
    const GaussianFacets<double> facets(c);
    for (int i = 0; i < 300; ++i) {
      const Vec3f wo = d.above(), wi = d.above();
      const Vec3d l = wi.cast<double>(), b = wo.cast<double>();
      if (exponent_of(c, l + b) > 16.0) continue;
      const double unmasked = brdf_specular(l, b, facets, 1.5, 0.0, Masking::None);
      const double expected = brdf_specular(l, b, facets, 1.5, 0.0, Masking::Smith);
      EXPECT_NEAR(static_cast<double>(lane.bsdf.eval(wo, wi).lobe[0]), expected, 1e-4 * unmasked);
    }
  }
}

Material coupled(double n, double c, double rho) {
  Material m = rough(n, 0.0, c);
  m.combination = Material::Combination::Coupled;
  m.body_reflectance = rho;
  return m;
}

// The table of B: 1e-5 of the value, relative to the largest B where B itself vanishes.
TEST(BsdfAccuracy, CoupledBodyIsTheQuadrature) {
  for (const double n : {1.05, 1.5, 2.5})
    for (const double c : {0.3, 2.0, 10.0, 3e3}) {
      const Lane lane(coupled(n, c, 0.8));
      const CoupledInterface exact(c, static_cast<double>(lane.resolved.n[0]),
                                   static_cast<double>(lane.resolved.body_reflectance[0]));
      double worst =
          std::abs(static_cast<double>(lane.resolved.coupled->mean[0]) - exact.mean_transmitted());
      double where = -1.0;
      for (double mu = 1e-4; mu < 1.0; mu *= 1.19) {
        const auto muf = static_cast<float>(mu);
        const double error = std::abs(static_cast<double>(lane.resolved.coupled->at(muf)[0]) -
                                      exact.transmitted(static_cast<double>(muf)));
        if (error > worst) where = mu;
        worst = std::max(worst, error);
      }
      EXPECT_LE(worst, 1e-5) << "n " << n << " c " << c << " mu " << where;
    }
}

// Smooth: B = 1 - F.
TEST(BsdfAccuracy, CoupledBodyUnderASmoothInterface) {
  for (const double n : {1.0 + 1e-3, 1.33, 1.5, 2.5, 10.0}) {
    const Lane lane(coupled(n, std::numeric_limits<double>::infinity(), 0.8));
    double worst = 0.0;
    for (int i = 0; i <= 2000; ++i) {
      const double mu = std::pow(10.0, -6.0 * i / 2000);
      const double f = fresnel_dielectric(mu, static_cast<double>(lane.resolved.n[0])).mean();
      const auto b = static_cast<double>(lane.resolved.coupled->at(static_cast<float>(mu))[0]);
      worst = std::max(worst, std::abs(b - (1.0 - f)));
    }
    EXPECT_LE(worst, 1e-5) << n;
  }
}

TEST(BsdfAccuracy, CoupledBrdfIsTheKernelToFloat) {
  Directions d(5);
  for (const double c : {2.0, 20.0}) {
    const Lane lane(coupled(1.5, c, 0.8));
    const CoupledInterface exact(c, 1.5, static_cast<double>(lane.resolved.body_reflectance[0]));
    for (int i = 0; i < 60; ++i) {
      const Vec3f wo = d.above(), wi = d.above();
      if (exponent_of(c, (wo + wi).cast<double>()) > 16.0) continue;
      const double expected = exact.brdf(wi.cast<double>(), wo.cast<double>());
      EXPECT_NEAR(static_cast<double>(lane.bsdf.eval(wo, wi).sum()[0]), expected,
                  1e-5 * std::max(expected, 0.8 / kPi));
    }
  }
}

}  // namespace
}  // namespace atrium::material
