#include "material/bsdf.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "material/fresnel.h"
#include "material/interface_albedo.h"
#include "material/pane.h"
#include "scene/sampler.h"

namespace atrium::material {
namespace {

using Rgb3 = Spectrum<3>;

struct Case {
  const char* name;
  Material material;
};

Material lambert(double rho) {
  Material m;
  m.body_reflectance = rho;
  return m;
}
Material interface_of(Material::Medium medium, double n, double kappa, double c) {
  Material m;
  m.medium = medium;
  m.n = n;
  m.kappa = kappa;
  m.c = c;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.k_tp_rg = medium == Material::Medium::Solid ? 1.0 : 0.0;
  return m;
}
Material coupled(double rho, double n, double c) {
  Material m = lambert(rho);
  m.combination = Material::Combination::Coupled;
  m.n = n;
  m.c = c;
  m.k_rg = 1.0;
  return m;
}
Material sheet(double rho, double tau) {
  Material m = lambert(rho);
  m.body_transmittance = tau;
  m.k_tp_df = 1.0;
  return m;
}
Material half_and_half() {
  Material m = interface_of(Material::Medium::Opaque, 1.5, 0.0, 4.0);
  m.k_df = m.k_rg = 0.5;
  m.body_reflectance = 0.9;
  return m;
}
Material frosted_with_sigma() {
  Material m = interface_of(Material::Medium::Solid, 1.5, 0.0, 8.0);
  m.sigma = 40e-9;
  return m;
}

Material with_facets(Material m, Masking masking, bool interreflection) {
  m.masking = masking;
  m.facet_interreflection = interreflection;
  return m;
}
// A model of the literature on a metal (interface lobes) or a body of 0.8 (body lobes).
Material literature(const LobeModel& lobe) {
  Material m = is_body(lobe) ? lambert(0.8)
                             : interface_of(Material::Medium::Opaque, 0.27, 2.95 / 0.27,
                                            std::numeric_limits<double>::infinity());
  m.lobe = lobe;
  return m;
}

const double kSmooth = std::numeric_limits<double>::infinity();

std::vector<Case> cases() {
  using enum Material::Medium;
  return {{"lambert", lambert(0.8)},
          {"mirror gold-like", interface_of(Opaque, 0.27, 2.95 / 0.27, kSmooth)},
          {"rough metal c=3", interface_of(Opaque, 0.27, 2.95 / 0.27, 3.0)},
          {"rough metal c=30", interface_of(Opaque, 1.5, 4.0, 30.0)},
          {"very rough c=0.7", interface_of(Opaque, 1.5, 0.0, 0.7)},
          {"smooth glass", interface_of(Solid, 1.5, 0.0, kSmooth)},
          {"rough glass c=4", interface_of(Solid, 1.5, 0.0, 4.0)},
          {"rough glass c=20", interface_of(Solid, 1.5, 0.0, 20.0)},
          {"frosted, partly coherent", frosted_with_sigma()},
          {"pane", interface_of(Pane, 1.52, 0.0, kSmooth)},
          {"plastic smooth", coupled(0.8, 1.5, kSmooth)},
          {"plastic rough", coupled(0.8, 1.5, 5.0)},
          {"sheet", sheet(0.3, 0.5)},
          {"convex", half_and_half()},
          {"Smith c=2",
           with_facets(interface_of(Opaque, 0.27, 2.95 / 0.27, 2.0), Masking::Smith, false)},
          {"Smith glass", with_facets(interface_of(Solid, 1.5, 0.0, 4.0), Masking::Smith, false)},
          {"white metal, interreflection c=1",
           with_facets(interface_of(Opaque, 1e-3, 1e6, 1.0), Masking::VCavity, true)},
          {"gold, interreflection, Smith c=1.5",
           with_facets(interface_of(Opaque, 0.27, 2.95 / 0.27, 1.5), Masking::Smith, true)},
          {"Phong", literature(PhongModel{30.0})},
          {"Blinn-Phong", literature(BlinnPhongModel{30.0})},
          {"Cook-Torrance", literature(CookTorranceModel{0.3})},
          {"He", literature(HeModel{0.15e-6, 3e-6})},
          {"Oren-Nayar", literature(OrenNayarModel{0.5})},
          {"Hanrahan-Krueger", literature(HanrahanKruegerModel{1.0, 0.5})},
          {"Schlick", literature(SchlickModel{0.4, 1.0})},
          {"GGX", literature(GgxModel{0.3})}};
}

Vec3f direction(double theta_deg, double phi_deg) {
  const double t = theta_deg * std::numbers::pi / 180.0, p = phi_deg * std::numbers::pi / 180.0;
  return Vec3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)).cast<float>();
}

struct Bsdf3 {
  ResolvedMaterial<3> resolved;
  Bsdf<3> bsdf;
  explicit Bsdf3(const Material& m, bool front = true)
      : resolved(resolve_material<3>(m, SpectralBasis::rgb())),
        bsdf(resolved, front, Rgb3::one(), Rgb3::one(), 1.0f) {}
};

struct Estimate {
  double mean = 0.0, error = 0.0;
};

template <class F>
Estimate estimate(int n, F&& f) {
  double sum = 0.0, sum2 = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = f(static_cast<std::uint32_t>(i));
    sum += x;
    sum2 += x * x;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, sum2 / n - mean * mean) / n)};
}

// Flux leaving per flux arriving along wo, by sampling.
Estimate sampled_albedo(const Bsdf<3>& bsdf, const Vec3f& wo, std::uint32_t events, int n = 40000) {
  return estimate(n, [&](std::uint32_t i) {
    scene::Sampler s(7, 1, i);
    const float choice = s.next_1d();
    const auto sample = bsdf.sample(wo, choice, s.next_2d(), events, Transport::Flux);
    return sample ? static_cast<double>(sample->weight.mean()) : 0.0;
  });
}

// No surface sends out more than arrives, seen from outside or, for solids, from inside. Schlick's
// and He's models make no such promise (lobe_model.h).
TEST(Bsdf, AlbedoNeverExceedsOne) {
  for (const Case& c : cases()) {
    if (std::holds_alternative<SchlickModel>(c.material.lobe) ||
        std::holds_alternative<HeModel>(c.material.lobe))
      continue;
    for (const bool front : {true, false})
      for (const double theta : {0.0, 30.0, 60.0, 80.0, 89.0}) {
        SCOPED_TRACE(std::string(c.name) + (front ? " front " : " back ") + std::to_string(theta));
        const Bsdf3 b(c.material, front);
        const Estimate a = sampled_albedo(b.bsdf, direction(theta, 20.0), kAllEvents);
        EXPECT_LE(a.mean, 1.0 + 4.0 * a.error + 1e-5);
        EXPECT_GE(a.mean, 0.0);
      }
  }
}

// Lossless interfaces: everything is reflected or transmitted. Smooth ones exactly, rough ones but
// for what V-cavities lose between facets (Ashikhmin: bounded by 1 - E(c)).
TEST(Bsdf, SmoothLosslessInterfacesReturnEverything) {
  using enum Material::Medium;
  for (const Material& m :
       {interface_of(Solid, 1.5, 0.0, kSmooth), interface_of(Pane, 1.52, 0.0, kSmooth)})
    for (const bool front : {true, false})
      for (const double theta : {0.0, 35.0, 60.0, 85.0}) {
        const Bsdf3 b(m, front);
        const Estimate a = sampled_albedo(b.bsdf, direction(theta, 0.0), kAllEvents, 2000);
        EXPECT_NEAR(a.mean, 1.0, 4.0 * a.error + 1e-5) << theta << front;
      }
}

// The density integrates to the probability that a sample is scattered (not absorbed, not Dirac),
// and f cos integrates to the mean weight: uniform directions against the BSDF's own samples.
TEST(Bsdf, SamplesAgreeWithDensityAndValues) {
  constexpr double kSphere = 4.0 * std::numbers::pi;
  for (const Case& c : cases()) {
    // He's sum costs a hundred times the others' evaluation.
    const int kSamples = std::holds_alternative<HeModel>(c.material.lobe) ? 10000 : 200000;
    for (const std::uint32_t events : {std::uint32_t{kAllEvents}, std::uint32_t{kSpecularEvents},
                                       std::uint32_t{kDiffuseEvents}}) {
      const Bsdf3 b(c.material);
      if (!b.bsdf.has(events & (kDiffuseEvents | kLobeEvents))) continue;
      for (const double theta : {10.0, 60.0}) {
        SCOPED_TRACE(std::string(c.name) + " events " + std::to_string(events) + " theta " +
                     std::to_string(theta));
        const Vec3f wo = direction(theta, 40.0);
        double scattered = 0.0;
        const Estimate by_sampling = estimate(kSamples, [&](std::uint32_t i) {
          scene::Sampler s(11, 2, i);
          const float choice = s.next_1d();
          const auto sample = b.bsdf.sample(wo, choice, s.next_2d(), events);
          if (!sample || sample->dirac()) return 0.0;
          scattered += 1.0 / kSamples;
          return static_cast<double>(sample->weight[1]);
        });
        Estimate density;
        const auto uniform = [&](std::uint32_t i) {
          scene::Sampler s(13, 3, i);
          const Vec2f u = s.next_2d();
          const float z = 1.0f - 2.0f * u.x(), r = std::sqrt(std::max(0.0f, 1.0f - z * z));
          return Vec3f(r * std::cos(2.0f * std::numbers::pi_v<float> * u.y()),
                       r * std::sin(2.0f * std::numbers::pi_v<float> * u.y()), z);
        };
        density = estimate(kSamples, [&](std::uint32_t i) {
          return kSphere * static_cast<double>(b.bsdf.pdf(wo, uniform(i), events));
        });
        const Estimate by_value = estimate(kSamples, [&](std::uint32_t i) {
          const Vec3f wi = uniform(i);
          const BsdfValue<3> f = b.bsdf.eval(wo, wi);
          Rgb3 v;
          if ((events & kDiffuseEvents) != 0) v += f.diffuse;
          if ((events & kLobeEvents) != 0) v += f.lobe;
          return kSphere * static_cast<double>(v[1]) * std::abs(static_cast<double>(wi.z()));
        });
        // The density of facets that reflect below the surface is part of pdf() only above it, so
        // both sides count scattered samples alone. 5 standard errors of the sums.
        EXPECT_NEAR(density.mean, scattered, 5.0 * (density.error + std::sqrt(0.25 / kSamples)));
        EXPECT_NEAR(by_value.mean, by_sampling.mean, 5.0 * (by_value.error + by_sampling.error));
      }
    }
  }
}

// Helmholtz: f_r(a, b) = f_r(b, a); f_t(l -> b) / n_b^2 = f_t(b -> l) / n_l^2 with the two sides
// of the same interface.
TEST(Bsdf, IsReciprocal) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Bsdf3 b(c.material);
    const Bsdf3 back(c.material, false);
    for (std::uint32_t i = 0; i < 500; ++i) {
      scene::Sampler s(3, 4, i);
      const Vec3f a = sample_cosine_hemisphere(s.next_2d()),
                  d = sample_cosine_hemisphere(s.next_2d());
      const double f = static_cast<double>(b.bsdf.eval(a, d).sum()[0]);
      const double g = static_cast<double>(b.bsdf.eval(d, a).sum()[0]);
      EXPECT_NEAR(f, g, 2e-4 * std::max(f, g) + 1e-7);
      // b on the front side, l on the back: swap roles by turning the frame over.
      const Vec3f l(d.x(), d.y(), -d.z());
      const double eta = static_cast<double>(b.bsdf.eta());
      const double forward = static_cast<double>(b.bsdf.eval(a, l).lobe[0]);
      const double reverse = static_cast<double>(
          back.bsdf.eval(Vec3f(l.x(), -l.y(), -l.z()), Vec3f(a.x(), -a.y(), -a.z())).lobe[0]);
      EXPECT_NEAR(forward, reverse / (eta * eta), 2e-3 * std::max(forward, 1e-3));
    }
  }
}

// White furnace: a perfect reflector with interreflection between its facets loses nothing, without
// it what MATERIAL_MODEL 5.5 lists.
TEST(Bsdf, InterreflectionClosesTheFurnace) {
  using enum Material::Medium;
  for (const Masking masking : {Masking::VCavity, Masking::Smith})
    for (const double c : {0.5, 1.0, 3.0, 10.0})
      for (const double theta : {0.0, 50.0, 80.0}) {
        SCOPED_TRACE(testing::Message() << c << " " << theta);
        const Material metal = interface_of(Opaque, 1e-3, 1e6, c);
        const Bsdf3 with(with_facets(metal, masking, true)),
            without(with_facets(metal, masking, false));
        const Vec3f wo = direction(theta, 0.0);
        const Estimate all = sampled_albedo(with.bsdf, wo, kAllEvents);
        EXPECT_NEAR(all.mean, 1.0, 5.0 * all.error + 5e-4);
        const Estimate once = sampled_albedo(without.bsdf, wo, kAllEvents);
        EXPECT_NEAR(once.mean, white_albedo(static_cast<double>(wo.z()), c, masking),
                    5.0 * once.error + 1e-4);
      }
}

// GGX takes the roughness of a texture like the facets do: sqrt(alpha) is multiplied.
TEST(Bsdf, RoughnessFactorOfGgx) {
  const Material wide = literature(GgxModel{0.4});
  const ResolvedMaterial<3> r = resolve_material<3>(wide, SpectralBasis::rgb());
  const Bsdf<3> half(r, true, Rgb3::one(), Rgb3::one(), 0.5f);
  const Bsdf3 own(literature(GgxModel{0.1}));
  const Vec3f a = direction(40.0, 0.0), b = direction(30.0, 170.0);
  EXPECT_NEAR(half.eval(a, b).lobe[0], own.bsdf.eval(a, b).lobe[0],
              1e-5f * own.bsdf.eval(a, b).lobe[0]);
}

// c -> infinity: the rough dielectric becomes the smooth one, R -> F, T -> 1 - F (1e-3 at c =
// 1000).
TEST(Bsdf, RoughGlassTendsToSmoothGlass) {
  const Bsdf3 rough(interface_of(Material::Medium::Solid, 1.5, 0.0, 1000.0));
  for (const double theta : {0.0, 40.0, 70.0}) {
    const Vec3f wo = direction(theta, 0.0);
    const double f = fresnel_dielectric(static_cast<double>(wo.z()), 1.5).mean();
    EXPECT_NEAR(sampled_albedo(rough.bsdf, wo, kLobeReflection).mean, f, 1e-3);
    EXPECT_NEAR(sampled_albedo(rough.bsdf, wo, kLobeTransmission).mean, 1.0 - f, 2e-3);
  }
}

// Coupled body under a smooth interface: albedo = F(mu) + rho_b B(mu), B = 1 - F.
TEST(Bsdf, CoupledPlasticHasTheAlbedoOfItsParts) {
  Material plastic = coupled(0.8, 1.5, kSmooth);
  plastic.fresnel_error = 0.0;
  const Bsdf3 b(plastic);
  for (const double theta : {0.0, 45.0, 75.0}) {
    const Vec3f wo = direction(theta, 0.0);
    const double f = fresnel_dielectric(static_cast<double>(wo.z()), 1.5).mean();
    EXPECT_NEAR(sampled_albedo(b.bsdf, wo, kMirror, 1000).mean, f, 1e-5);
    const Estimate body = sampled_albedo(b.bsdf, wo, kDiffuseReflection);
    EXPECT_NEAR(body.mean, 0.8 * (1.0 - f), 4.0 * body.error + 2e-5);
    EXPECT_NEAR(static_cast<double>(b.bsdf.diffuse_reflectance(wo)[0]), 0.8 * (1.0 - f), 2e-5);
  }
}

// Radiance scales by (n1/n2)^2 on entering; flux does not.
TEST(Bsdf, RefractionScalesRadianceByIndexSquared) {
  const Bsdf3 b(interface_of(Material::Medium::Solid, 1.5, 0.0, kSmooth));
  const Vec3f wo = direction(30.0, 0.0);
  const auto radiance = b.bsdf.sample(wo, 0.999f, {0.5f, 0.5f}, kRefraction, Transport::Radiance);
  const auto flux = b.bsdf.sample(wo, 0.999f, {0.5f, 0.5f}, kRefraction, Transport::Flux);
  ASSERT_TRUE(radiance && flux);
  EXPECT_NEAR(radiance->weight[0] * 2.25f, flux->weight[0], 1e-6f);
  // Snell: sin = n sin'.
  EXPECT_NEAR(std::hypot(flux->wi.x(), flux->wi.y()) * 1.5f, std::hypot(wo.x(), wo.y()), 1e-6f);
}

}  // namespace
}  // namespace atrium::material
