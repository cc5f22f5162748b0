// What path-traced probes say of a field, where the truth is known.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;
using Verdict = Certificate::Verdict;

// A field that says the same on all sides that it called lit; `factor` by object.
SolveResult uniform_field(const Solved& s, double irradiance,
                          const std::vector<double>& factor = {}) {
  SolveResult r = s.result;
  auto& e = r.field.irradiance;
  e.indirect.assign(e.indirect.size(), 0.0f);
  e.caustic.clear();
  for (std::size_t i = 0; i < s.count(); ++i)
    for (const int side : {0, 1}) {
      const bool lit = s.total(i, side) > 0.0;
      const double f = factor.empty() ? 1.0 : factor[s.object(i)];
      e.direct[2 * i + static_cast<std::size_t>(side)] =
          lit ? static_cast<float>(f * irradiance) : 0.0f;
    }
  return r;
}

Certificate certificate_of(const Solved& s, const SolveResult& r, double target, int probes,
                           std::uint64_t seed = 1) {
  return certify(s.query, material::SpectralBasis::grey(), r,
                 {.error = target, .seed = seed, .probes = probes});
}

const SolveOptions kCheap{.max_level = 0,
                          .row_rays = 16,
                          .gather_rays = 16,
                          .direct_samples = 16,
                          .caustic_photons = 1000};

SolveOptions cheap(double element_size) {
  SolveOptions o = kCheap;
  o.element_size = element_size;
  return o;
}

// All surfaces emit (1 - rho) / pi and reflect rho: E is 1 everywhere, whatever the shape, and
// light reaches points in every way there is: straight, by reflection, through lobes, glass and
// sheets.
scene::Scene furnace(bool with_things) {
  const auto warm = [](material::Material m, double emissivity) {
    m.emission = material::SpectralValue(emissivity / kPi);
    return m;
  };
  SceneMaker maker;
  maker.room({0, 0, 0}, {2, 2, 2}, maker.material(warm(test::diffuse(0.6), 0.4)));
  if (!with_things) return maker.take();
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.n = 1.0;
  mirror.kappa = 1e5;
  maker.quad(maker.material(mirror), {0.2f, 0.2f, 0.2f}, {0.2f, 1.8f, 0.2f}, {0.2f, 1.8f, 1.8f},
             {0.2f, 0.2f, 1.8f});
  material::Material pane;
  pane.medium = material::Material::Medium::Pane;
  pane.k_df = 0.0;
  pane.k_rg = pane.k_tp_rg = 1.0;
  pane.n = 1.52;
  maker.quad(maker.material(pane), {1, 0.1f, 0.1f}, {1, 1.9f, 0.1f}, {1, 1.9f, 1.9f},
             {1, 0.1f, 1.9f});
  material::Material sheet = test::diffuse(0.5);  // what it does not reflect it lets through
  sheet.k_tp_df = 1.0;
  sheet.body_transmittance = material::SpectralValue(0.5);
  maker.quad(maker.material(sheet), {1.5f, 0.1f, 0.1f}, {1.5f, 1.9f, 0.1f}, {1.5f, 1.9f, 1.9f},
             {1.5f, 0.1f, 1.9f});
  return maker.take();
}

TEST(Certificate, ProbesOfAFurnaceAreUnbiased) {
  for (const bool things : {false, true}) {
    SCOPED_TRACE(things);
    const Solved s(furnace(things), cheap(0.5));
    const Certificate c = certificate_of(s, uniform_field(s, 1.0), 0.02, 48);
    EXPECT_EQ(c.probes, 48);
    EXPECT_EQ(c.verdict, Verdict::Met);
    // Half intervals are 1.96 standard errors; four of those fail once in 16000.
    EXPECT_NEAR(c.bias, 0.0, 2.05 * c.bias_error);
    EXPECT_LT(c.bias_error, 0.004);
    EXPECT_GT(c.bias_error, 0.0);
    EXPECT_LT(c.probe_noise, 0.01);
    EXPECT_LT(c.rms, 0.01);
    EXPECT_TRUE(c.not_sampled.empty());
    EXPECT_GT(c.rays, 0U);
  }
}

// One wall of a cube is wrong by 30 %: RMS 0.3 / sqrt(6), bias 0.05.
TEST(Certificate, VerdictFollowsTheTrueError) {
  const Solved s(furnace(false), cheap(0.5));
  const SolveResult wrong = uniform_field(s, 1.0, {1.3, 1, 1, 1, 1, 1});
  const double rms = 0.3 / std::sqrt(6.0);
  const Certificate met = certificate_of(s, wrong, 0.2, 96);
  EXPECT_EQ(met.verdict, Verdict::Met);
  EXPECT_LT(met.rms_low, rms);
  EXPECT_GT(met.rms_high, rms);
  EXPECT_NEAR(met.bias, 0.05, 1.5 * met.bias_error);
  EXPECT_NEAR(met.largest, 0.3, 5 * met.probe_noise);
  EXPECT_EQ(certificate_of(s, wrong, 0.06, 96).verdict, Verdict::NotMet);
  EXPECT_EQ(certificate_of(s, wrong, 0.12, 96).verdict, Verdict::NotResolved);
  for (const int probes : {1, 2, 4}) {
    SCOPED_TRACE(probes);
    EXPECT_EQ(certificate_of(s, wrong, 0.06, probes).verdict, Verdict::NotResolved);
  }
}

// Nothing but smooth light.
scene::Scene smooth_room(double rho) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {3, 2, 2}, maker.material(test::diffuse(rho)));
  maker.point_light({1.4, 1.1, 1.2}, 5.0);
  return maker.take();
}

TEST(Certificate, AConvergedSolutionMeetsItsErrorAndAScaledOneDoesNot) {
  SolveOptions options{.element_size = 0.2, .error = 0.04, .probes = 128};
  const Solved s(smooth_room(0.5), options);
  const Certificate& c = s.result.certificate;
  EXPECT_EQ(c.verdict, Verdict::Met) << c.rms_low << " " << c.rms << " " << c.rms_high;
  EXPECT_EQ(c.target, 0.04);
  EXPECT_GT(c.rms, 0.0);
  EXPECT_GE(s.result.counters[scene::Counter::RaysProbe], c.rays);

  SolveResult broken = s.result;
  for (auto* part : {&broken.field.irradiance.direct, &broken.field.irradiance.indirect})
    for (float& v : *part) v *= 1.1f;
  const Certificate b = certificate_of(s, broken, 0.04, 128);
  EXPECT_EQ(b.verdict, Verdict::NotMet);
  // The solution's own bias is part of it.
  EXPECT_NEAR(b.bias, 0.1 + 1.1 * c.bias, b.bias_error);
  EXPECT_NEAR(b.bias, 0.1, 0.02);
}

// A plate under a small lamp throws a sharp shadow, coarse elements smear it. The truth is a
// solution with elements a tenth as wide, compared at the centres of its elements.
TEST(Certificate, RmsIsTheTrueRms) {
  const auto scene = [] {
    SceneMaker maker;
    maker.room({0, 0, 0}, {2, 2, 2}, maker.material(test::diffuse(0.4)));
    const auto plate = maker.material(test::diffuse(0.4));
    maker.quad(plate, {0.7f, 0.7f, 1.2f}, {1.3f, 0.7f, 1.2f}, {1.3f, 1.3f, 1.2f},
               {0.7f, 1.3f, 1.2f});
    maker.point_light({1.0, 1.1, 1.7}, 5.0);
    return maker.take();
  };
  const Solved coarse(scene(), {.element_size = 0.5,
                                .max_level = 0,
                                .row_rays = 256,
                                .gather_rays = 256,
                                .direct_samples = 256});
  const Solved fine(scene(), {.element_size = 0.05,
                              .max_level = 0,
                              .row_rays = 64,
                              .gather_rays = 256,
                              .direct_samples = 64});
  double flux = 0.0, area = 0.0;
  const auto each = [&](auto&& body) {
    for (std::size_t e = 0; e < fine.count(); ++e)
      for (const int side : {0, 1})
        if (fine.total(e, side) > 0.0) body(e, side);
  };
  each([&](std::size_t e, int side) {
    flux += fine.area(e) * fine.total(e, side);
    area += fine.area(e);
  });
  double squares = 0.0;
  const scene::SurfaceField& field = coarse.result.field;
  each([&](std::size_t e, int side) {
    const ElementPiece piece = fine.result.elements.pieces[fine.result.elements.first_piece[e]];
    const auto at = static_cast<scene::Side>(side);
    const auto stencil =
        field.stencil(coarse.scene, piece.object, piece.triangle, fine.centre(e), at);
    const double value =
        static_cast<double>((field.interpolate<1>(field.irradiance.direct, stencil, at) +
                             field.interpolate<1>(field.irradiance.indirect, stencil, at))
                                .mean());
    const double truth = fine.total(e, side);
    squares += fine.area(e) * std::pow((value - truth) / std::max(truth, 0.01 * flux / area), 2);
  });
  const double rms = std::sqrt(squares / area);
  EXPECT_GT(rms, 0.1);
  const Certificate c = certificate_of(coarse, coarse.result, 0.1, 192);
  EXPECT_LT(c.rms_low, rms);
  EXPECT_GT(c.rms_high, rms);
  EXPECT_LT(c.rms_high, 2.0 * c.rms_low);
}

// A point light behind a mirror cannot be met by rays: its light comes from the photons and that is
// said. The rest is measured: the answer is that of the doubled room.
TEST(Certificate, SaysWhatItCannotSample) {
  SceneMaker maker;
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.n = 1.0;
  mirror.kappa = 1e5;
  const auto white = maker.material(test::diffuse(0.5));
  maker.room({0, 0, 0}, {2, 2, 2}, {maker.material(mirror), white, white, white, white, white});
  maker.point_light({0.7, 1.1, 1.3}, 10.0);
  const Solved s(
      maker.take(),
      {.element_size = 0.25, .gather_rays = 256, .direct_samples = 64, .caustic_photons = 1000000});
  const Certificate c = certificate_of(s, s.result, 0.05, 48);
  ASSERT_EQ(c.not_sampled.size(), 1U);
  EXPECT_NE(c.not_sampled[0].find("1 point"), std::string::npos);
  EXPECT_EQ(c.verdict, Verdict::Met) << c.rms;
  EXPECT_NEAR(c.bias, 0.0, 0.02);
}

}  // namespace
}  // namespace atrium::radiosity
