#include "material/paper.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "material/fresnel.h"

namespace atrium::material {
namespace {

Vec3d direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// The paper's Fresnel formula as printed (Z0 to Z7), in long double: shares nothing with fresnel().
double printed_fresnel(double cosine, double n21, double kappa) {
  using W = long double;
  const W z0 = cosine, z1 = std::sqrt(1.0L - z0 * z0), z3 = z1 * z1 / z0;
  const W z4 = static_cast<W>(n21) * n21, z5 = static_cast<W>(kappa) * kappa, z6 = z4 * (1.0L - z5);
  const W z7 = std::sqrt((z6 - z1 * z1) * (z6 - z1 * z1) + 4.0L * z4 * z4 * z5);
  const W a = std::sqrt(std::max(0.0L, (z7 + z6 - z1 * z1) / 2.0L));
  const W b = (z7 - z6 + z1 * z1) / 2.0L;
  const W s = ((a - z0) * (a - z0) + b) / ((a + z0) * (a + z0) + b);
  const W p = ((a - z3) * (a - z3) + b) / ((a + z3) * (a + z3) + b);
  return static_cast<double>(0.5L * s * (1.0L + p));
}

PaperInput everything() {
  PaperInput in;
  in.viewer = direction(0.5, 0.3);
  in.n21 = 1.5;
  in.k_df = 0.4;
  in.k_rg = 0.6;
  in.k_tp_df = 0.3;
  in.k_tp_rg = 0.7;
  in.c = 3.0;
  in.lights = {{direction(0.8, 2.0), 5.0, 2.0}, {direction(2.7, 3.6), 7.0, 1.5}};
  in.light_falloff = {1.0, 0.5};
  in.ray_falloff = {0.1, 1.0};
  in.J_ab1 = 0.2;
  in.J_ab2 = 0.4;
  in.J_refl = 1.1;
  in.r_refl = 3.0;
  in.K_refl = 0.05;
  in.J_trans = 1.7;
  in.r_trans = 0.5;
  in.K_trans = 2.0;
  return in;
}

// Equation by equation as printed, with acos and F of the other side in C4 and C5.
std::array<double, 6> printed(const PaperInput& in) {
  const Vec3d n = in.normal, b = in.viewer;
  const double f0 = printed_fresnel(1.0, in.n21, in.kappa2);
  std::array<double, 6> t{};
  for (const PaperLight& light : in.lights) {
    const Vec3d l = light.direction;
    const double J =
        light.J / (in.light_falloff.c1 * light.distance * light.distance + in.light_falloff.c2);
    if (n.dot(l) >= 0.0) {
      const Vec3d h = (l + b).normalized();
      const double delta = std::acos(std::min(1.0, n.dot(h)));
      t[0] += (in.k_df * f0 * n.dot(l) + in.k_rg * printed_fresnel(l.dot(h), in.n21, in.kappa2) *
                                             std::exp(-in.c * in.c * delta * delta)) *
              J;
    } else {
      double specular = 0.0;
      const bool exists = in.n21 > 1.0 ? b.dot(l) < -1.0 / in.n21 : b.dot(l) < -in.n21;
      Vec3d h = (-b - in.n21 * l) / (in.n21 - 1.0);
      h.normalize();
      if (exists && h.dot(n) > 0.0) {
        const double delta = std::acos(std::min(1.0, n.dot(h)));
        specular = in.k_tp_rg * (1.0 - printed_fresnel(-h.dot(l), 1.0 / in.n21, 0.0)) *
                   std::exp(-in.c * in.c * delta * delta);
      }
      t[4] += (in.k_tp_df * f0 * -n.dot(l) + specular) * J;
    }
  }
  const double f_refl = 1.0 / (in.ray_falloff.c1 * in.r_refl * in.r_refl + in.ray_falloff.c2);
  const double f_trans = 1.0 / (in.ray_falloff.c1 * in.r_trans * in.r_trans + in.ray_falloff.c2);
  const double cos_theta = n.dot(b);
  t[1] = in.k_df * f0 * in.J_ab1;
  t[2] = in.k_rg * printed_fresnel(cos_theta, in.n21, in.kappa2) * in.J_refl * f_refl *
         std::exp(-in.K_refl * in.r_refl);
  const double sin_beta = std::sqrt(1.0 - cos_theta * cos_theta) / in.n21;
  if (sin_beta <= 1.0)
    t[3] = in.k_tp_rg *
           (1.0 - printed_fresnel(std::sqrt(1.0 - sin_beta * sin_beta), 1.0 / in.n21, 0.0)) *
           in.J_trans * f_trans * std::exp(-in.K_trans * in.r_trans);
  t[5] = in.k_tp_df * f0 * in.J_ab2;
  return t;
}

TEST(PaperTerms, AgreeWithThePrintedEquations) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 3000; ++i) {
    PaperInput in = everything();
    in.viewer = direction(1.5 * u(random), 6.28 * u(random));
    in.n21 = i % 2 == 0 ? 1.05 + u(random) : 1.0 / (1.05 + u(random));
    in.c = 6.0 * u(random);
    for (PaperLight& light : in.lights)
      light.direction = direction(3.14159 * u(random), 6.28 * u(random));
    const std::array<double, 6> want = printed(in);
    const PaperTerms got = paper_terms(in);
    // The printed form loses half the digits of kappa = 0 under total reflection: 3e-8 relative.
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(got.term[k], want[k], 1e-7 * (1.0 + want[k])) << "case " << i << " C" << k + 1;
  }
}

TEST(PaperTerms, MetalByThePrintedConductorForm) {
  PaperInput in = everything();
  in.n21 = 0.27;
  in.kappa2 = 2.95 / 0.27;
  in.transparent = false;
  const std::array<double, 6> want = printed(in);
  const PaperTerms got = paper_terms(in);
  for (const std::size_t k : {0u, 1u, 2u}) EXPECT_NEAR(got.term[k], want[k], 1e-12);
  for (const std::size_t k : {3u, 4u, 5u}) EXPECT_EQ(got.term[k], 0.0);
}

// By hand: everything at normal incidence, n = 1.5, F = 0.04.
TEST(PaperTerms, NormalIncidenceByHand) {
  PaperInput in;
  in.k_df = 0.25;
  in.k_rg = 0.75;
  in.k_tp_df = 0.5;
  in.k_tp_rg = 0.5;
  in.c = 10.0;
  in.lights = {{Vec3d::UnitZ(), 8.0, 2.0}, {-Vec3d::UnitZ(), 8.0, 2.0}};  // f = 1/4
  in.J_ab1 = 3.0;
  in.J_ab2 = 5.0;
  in.J_refl = 1.0;
  in.J_trans = 1.0;
  const PaperTerms t = paper_terms(in);
  EXPECT_NEAR(t.term[0], (0.25 * 0.04 + 0.75 * 0.04) * 2.0, 1e-15);
  EXPECT_NEAR(t.term[1], 0.25 * 0.04 * 3.0, 1e-15);
  EXPECT_NEAR(t.term[2], 0.75 * 0.04, 1e-15);
  EXPECT_NEAR(t.term[3], 0.5 * 0.96, 1e-15);
  EXPECT_NEAR(t.term[4], (0.5 * 0.04 + 0.5 * 0.96) * 2.0, 1e-15);
  EXPECT_NEAR(t.term[5], 0.5 * 0.04 * 5.0, 1e-15);
  EXPECT_NEAR(t.total(), 0.08 + 0.03 + 0.03 + 0.48 + 1.0 + 0.1, 1e-14);
}

TEST(PaperTerms, BodyColoursReplaceTheNormalReflectance) {
  PaperInput in = everything();
  in.body_reflectance = 0.8;
  in.body_transmittance = 0.5;
  const PaperTerms t = paper_terms(in);
  EXPECT_NEAR(t.term[1], 0.4 * 0.8 * 0.2, 1e-15);
  EXPECT_NEAR(t.term[5], 0.3 * 0.5 * 0.4, 1e-15);
}

// A light in the horizon: no diffuse part, but the highlight has no cosine.
TEST(PaperTerms, HighlightStaysAtGrazingLight) {
  PaperInput in;
  in.k_df = in.k_rg = 0.5;
  in.c = 1.0;
  in.viewer = direction(1.2, 0.0);
  in.lights = {{{-1.0, 0.0, 0.0}, 1.0, 1.0}};
  const double phi = 0.5 * (1.2 + M_PI_2), delta = 0.5 * (M_PI_2 - 1.2);
  EXPECT_NEAR(paper_terms(in).term[0],
              0.5 * fresnel(std::cos(phi), 1.5, 0.0).mean() * std::exp(-delta * delta), 1e-14);
}

TEST(PaperTerms, TotalReflection) {
  PaperInput in = everything();
  in.n21 = 1.0 / 1.5;
  in.viewer = direction(0.8, 0.0);  // beyond asin(1/1.5) = 0.7297
  PaperTerms t = paper_terms(in);
  EXPECT_EQ(t.term[3], 0.0);
  EXPECT_NEAR(t.term[2], 0.6 * 1.1 / 1.9 * std::exp(-0.15), 1e-14);
  in.viewer = direction(0.72, 0.0);
  EXPECT_GT(paper_terms(in).term[3], 0.0);
}

// The facet rule of C5: where no facet refracts the light to the viewer only the diffuse part
// stays.
TEST(PaperTerms, TransmittedHighlightNeedsAFacet) {
  PaperInput in;
  in.k_tp_df = in.k_tp_rg = 0.5;
  in.c = 0.1;
  in.viewer = direction(0.3, 0.0);
  // On the same side of the normal as the viewer: b.l = -0.62 > -1/1.5, no facet.
  const double bent = std::acos(-0.62);
  in.lights = {{direction(0.3 + bent, 0.0), 1.0, 1.0}};
  const double cosine = -in.lights[0].direction.z();
  EXPECT_NEAR(paper_terms(in).term[4], 0.5 * 0.04 * cosine, 1e-15);
  // A little straighter, b.l = -0.70: there is one.
  in.lights = {{direction(0.3 + std::acos(-0.70), 0.0), 1.0, 1.0}};
  EXPECT_GT(paper_terms(in).term[4], 0.5 * 0.04 * -in.lights[0].direction.z() + 0.01);
  // Matched indices: never.
  in.n21 = 1.0;
  in.lights = {{-in.viewer, 1.0, 1.0}};
  EXPECT_EQ(paper_terms(in).term[4], 0.0);  // F(0) = 0 too
}

// Light along the refracted ray: delta = 0, so the highlight is 1 - F at any c.
TEST(PaperTerms, RefractedDirectionIsThePeakOfTheTransmittedHighlight) {
  for (const double n21 : {1.5, 1.0 / 1.5}) {
    PaperInput in;
    in.k_tp_rg = 1.0;
    in.n21 = n21;
    in.c = 1e4;
    in.viewer = direction(0.6, 0.0);
    const double beta = std::asin(std::sin(0.6) / n21);
    in.lights = {{direction(M_PI - beta, M_PI), 1.0, 1.0}};
    EXPECT_NEAR(paper_terms(in).term[4], 1.0 - fresnel(std::cos(0.6), n21, 0.0).mean(), 1e-9);
  }
}

// 4 F / c^2 of the light leaves by the highlight at normal view (c >= 5): the hemispherical
// integral of the implied J over the view, F taken as 0.04. The paper's defect, which must not be
// repaired.
TEST(PaperTerms, EnergyOfTheHighlightIsThePapers) {
  // Light at normal incidence, viewer at theta: delta = theta / 2; integral of e^{-c^2 theta^2/4}
  // sin theta cos theta over theta, times 2 pi, over pi: 4/c^2 for large c, times F.
  for (const double c : {10.0, 30.0}) {
    PaperInput in;
    in.k_rg = 1.0;
    in.c = c;
    in.lights = {{Vec3d::UnitZ(), 1.0, 1.0}};
    double sum = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const double theta = (i + 0.5) / 4000 * M_PI_2;
      in.viewer = direction(theta, 0.0);
      sum += 2.0 * paper_terms(in).term[0] * std::sin(theta) * std::cos(theta) * M_PI_2 / 4000;
    }
    // 4/c^2 (1 - 8/(3 c^2) ...) from sin 2 theta / 2: 2.7 % at c = 10; F grows by less than 1e-3.
    EXPECT_NEAR(sum / 0.04, 4.0 / (c * c) * (1.0 - 8.0 / (3.0 * c * c)), 0.005 * 4.0 / (c * c));
  }
}

TEST(PaperTerms, ExtremesGiveNumbers) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const double n : {0.01, 1.0, 1.0 + 1e-9, 100.0})
    for (const double kappa : {0.0, 1e-8, 1e4})
      for (const double c : {0.0, 1e6, 1e200, inf})
        for (const double mu : {0.0, 1e-12, 1.0}) {
          PaperInput in = everything();
          in.n21 = n;
          in.kappa2 = kappa;
          in.c = c;
          in.viewer = Vec3d(std::sqrt(1.0 - mu * mu), 0.0, mu);
          in.lights = {{Vec3d::UnitZ(), 1.0, 1.0},
                       {-Vec3d::UnitX(), 1.0, 1.0},
                       {-in.viewer, 1.0, 1.0},
                       {in.viewer, 1.0, 1.0}};
          for (const double t : paper_terms(in).term) EXPECT_TRUE(std::isfinite(t) && t >= 0.0);
        }
}

TEST(PaperTerms, RefusesWhatHasNoMeaning) {
  const auto refused = [](auto change) {
    PaperInput in = everything();
    change(in);
    try {
      (void)paper_terms(in);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](PaperInput&) {}), "");
  EXPECT_NE(refused([](PaperInput& in) { in.n21 = 0.0; }).find("n21"), std::string::npos);
  EXPECT_NE(refused([&](PaperInput& in) { in.k_rg = nan; }).find("k_rg"), std::string::npos);
  EXPECT_NE(refused([&](PaperInput& in) { in.c = nan; }).find("c is"), std::string::npos);
  EXPECT_NE(refused([](PaperInput& in) { in.viewer *= 2.0; }).find("b is"), std::string::npos);
  EXPECT_NE(refused([](PaperInput& in) { in.viewer = -in.viewer; }).find("n.b"), std::string::npos);
  // r = 0 with c2 = 0.
  EXPECT_NE(refused([](PaperInput& in) {
              in.light_falloff = {1.0, 0.0};
              in.lights[0].distance = 0.0;
            }).find("f(r)"),
            std::string::npos);
  EXPECT_NE(refused([](PaperInput& in) {
              in.ray_falloff = {0.0, 0.0};
            }).find("f(r_refl)"),
            std::string::npos);
}

// ---- lanes ----

Material lane_material() {
  Material m;
  m.medium = Material::Medium::Solid;
  m.n = 1.5;
  m.k_df = 0.4;
  m.k_rg = 0.6;
  m.k_tp_df = 0.3;
  m.k_tp_rg = 0.7;
  m.c = 3.0;
  m.body_reflectance = make_rgb(0.9, 0.5, 0.1);
  m.body_transmittance = make_rgb(0.2, 0.4, 0.6);
  return m;
}

PaperSurface<3> surface(const ResolvedMaterial<3>& r, bool front, float roughness = 1.0f) {
  return {r, front, Rgb::one(), Rgb::one(), roughness};
}

// Second method: paper_terms() in double, lane by lane, from both sides.
TEST(PaperSurface, LanesAgreeWithTheScalarEquation) {
  const Material m = lane_material();
  const ResolvedMaterial<3> r = resolve_material<3>(m, SpectralBasis::rgb());
  const Rgb rho = make_rgb(0.9, 0.5, 0.1), tau = make_rgb(0.2, 0.4, 0.6);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const bool front = i % 2 == 0;
    const PaperSurface<3> s = surface(r, front);
    PaperInput in = everything();
    in.n21 = front ? 1.5 : 1.0 / 1.5;
    in.viewer = direction(1.5 * u(random), 6.28 * u(random));
    in.lights = {{direction(3.14 * u(random), 6.28 * u(random)), 1.0, 1.0}};
    in.light_falloff = {0.0, 1.0};
    in.ray_falloff = {0.0, 1.0};
    in.J_ab1 = in.J_ab2 = in.J_refl = in.J_trans = 1.0;
    in.K_refl = in.K_trans = 0.0;
    const Vec3f b = in.viewer.cast<float>(), l = in.lights[0].direction.cast<float>();
    for (int lane = 0; lane < 3; ++lane) {
      in.body_reflectance = static_cast<double>(rho[lane]);
      in.body_transmittance = static_cast<double>(tau[lane]);
      const PaperTerms t = paper_terms(in);
      const auto expect = [&](float got, double want) {
        EXPECT_NEAR(static_cast<double>(got), want, 2e-5) << "case " << i;  // float near TIR
      };
      expect(s.direct(b, l)[lane], t.term[0] + t.term[4]);
      expect(s.ambient_front()[lane], t.term[1]);
      expect(s.mirror(b.z())[lane], t.term[2]);
      expect(s.transmission(b.z())[lane], t.term[3]);
      expect(s.ambient_back()[lane], t.term[5]);
    }
  }
}

// T by Snell's law: sines in the ratio of the indices, in the plane of b and z.
TEST(PaperSurface, TransmittedRayObeysSnell) {
  const Material m = lane_material();
  const ResolvedMaterial<3> r = resolve_material<3>(m, SpectralBasis::rgb());
  const Vec3f b = direction(0.7, 1.1).cast<float>();
  const auto into = surface(r, true).transmitted(b);
  ASSERT_TRUE(into);
  EXPECT_NEAR(into->head<2>().norm(), b.head<2>().norm() / 1.5f, 1e-6f);
  EXPECT_LT(into->z(), 0.0f);
  EXPECT_NEAR(into->cross(b).z(), 0.0f, 1e-6f);
  EXPECT_FALSE(surface(r, false).transmitted(direction(0.8, 0.0).cast<float>()));
  EXPECT_TRUE(surface(r, false).transmission(std::cos(0.8f)).is_zero());
}

// Roughness is sqrt(1/c): a factor of 2 on it is a quarter of c.
TEST(PaperSurface, RoughnessFactorScalesC) {
  Material m = lane_material();
  const ResolvedMaterial<3> a = resolve_material<3>(m, SpectralBasis::rgb());
  Material rough = m;
  rough.c = m.c / 4.0;
  const ResolvedMaterial<3> q = resolve_material<3>(rough, SpectralBasis::rgb());
  const Vec3f b = direction(0.2, 0.0).cast<float>(), l = direction(0.5, 1.0).cast<float>();
  EXPECT_NEAR(surface(a, true, 2.0f).direct(b, l)[1], surface(q, true).direct(b, l)[1], 1e-6f);
}

TEST(PaperSurface, PanePassesStraight) {
  Material m;
  m.medium = Material::Medium::Pane;
  m.n = 1.52;
  const ResolvedMaterial<3> r = resolve_material<3>(m, SpectralBasis::rgb());
  const PaperSurface<3> s = surface(r, true);
  const Vec3f b = direction(0.4, 0.0).cast<float>();
  EXPECT_EQ(*s.transmitted(b), Vec3f(-b));
  EXPECT_NEAR(s.transmission(1.0f)[0], 0.9183f, 5e-5f);
  EXPECT_NEAR(s.transmission(0.5f)[0] + s.mirror(0.5f)[0], 1.0f, 1e-6f);
  EXPECT_TRUE(s.direct(b, Vec3f::UnitZ()).is_zero());
  EXPECT_TRUE(s.ambient_front().is_zero() && s.ambient_back().is_zero());
}

// An opaque body with a glossy coat in coupled form never sends back more than it gets at normal
// incidence, and its diffuse part is there although the paper's k_df + k_rg = 1 has no room for it.
TEST(PaperSurface, CoupledBodyShowsThroughTheInterface) {
  Material m;
  m.combination = Material::Combination::Coupled;
  m.k_rg = 1.0;
  m.body_reflectance = 1.0;
  const ResolvedMaterial<3> r = resolve_material<3>(m, SpectralBasis::rgb());
  const PaperSurface<3> s = surface(r, true);
  EXPECT_NEAR(s.ambient_front()[0], 0.96f, 1e-6f);
  EXPECT_NEAR(s.ambient_front()[0] + s.mirror(1.0f)[0], 1.0f, 1e-6f);
}

}  // namespace
}  // namespace atrium::material
