// The mesh error that a solution states, against points measured by path tracing.
#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

SceneMaker empty_room() {
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(test::diffuse(0.5)));
  return maker;
}

/// A lamp 10 cm below the ceiling: the spot above it is much smaller than an element.
scene::Scene lamp_below_ceiling() {
  SceneMaker maker = empty_room();
  maker.point_light({1.7, 1.3, 2.4}, 5.0);
  return maker.take();
}

/// A grille between lamp and floor: shadow lines thinner than elements.
scene::Scene grille() {
  SceneMaker maker = empty_room();
  const auto dark = maker.material(test::diffuse(0.1));
  for (int k = 0; k < 12; ++k) {
    const float x = 0.55f + 0.25f * static_cast<float>(k);
    maker.quad(dark, {x, 0.5f, 1.2f}, {x + 0.05f, 0.5f, 1.2f}, {x + 0.05f, 2.5f, 1.2f},
               {x, 2.5f, 1.2f});
  }
  maker.point_light({2, 1.5, 2.2}, 5.0);
  return maker.take();
}

/// Smooth light of a large panel, and a table.
scene::Scene panel() {
  SceneMaker maker = empty_room();
  maker.quad(maker.material(test::emitter(5.0, 0.5)), {1, 1, 2.0f}, {1, 2, 2.0f}, {2, 2, 2.0f},
             {2, 1, 2.0f});
  const auto table = maker.material(test::diffuse(0.4));
  maker.quad(table, {1.5f, 1, 0.8f}, {2.7f, 1, 0.8f}, {2.7f, 2, 0.8f}, {1.5f, 2, 0.8f});
  return maker.take();
}

/// What is stated against the certificate's RMS: as a share of it, with the interval's ends.
void expect_honest(const scene::Scene& scene, double low, double high) {
  const scene::RayQuery query(scene);
  SolveOptions o{.element_size = 0.4, .max_level = 0, .direct_samples = 64, .probes = 400};
  const SolveResult r = solve(query, material::SpectralBasis::grey(), o);
  const double stated = std::hypot(r.error_estimate, r.mesh_error);
  const Certificate& c = r.certificate;
  ::testing::Test::RecordProperty("stated", std::to_string(stated));
  ::testing::Test::RecordProperty("mesh", std::to_string(r.mesh_error));
  ::testing::Test::RecordProperty("rms", std::to_string(c.rms));
  ::testing::Test::RecordProperty("rms_low", std::to_string(c.rms_low));
  ::testing::Test::RecordProperty("rms_high", std::to_string(c.rms_high));
  EXPECT_GT(stated, low * c.rms_low);
  EXPECT_LT(stated, high * c.rms_high);
}

// 400 points of 95 % intervals. The bounds leave room for what is not looked at (indirect light
// within elements), and for how bright places are known: two light samples each.
TEST(MeshError, OfASpotSmallerThanAnElement) { expect_honest(lamp_below_ceiling(), 0.8, 1.25); }
TEST(MeshError, OfShadowLinesThinnerThanAnElement) { expect_honest(grille(), 0.8, 1.25); }
TEST(MeshError, OfSmoothLight) { expect_honest(panel(), 0.7, 1.4); }

// Elements are divided where the light changes within them, until what is left is what was asked.
TEST(MeshError, IsBroughtDown) {
  const scene::Scene scene = lamp_below_ceiling();
  const scene::RayQuery query(scene);
  SolveOptions o{
      .element_size = 0.4, .max_level = 5, .mesh_error = 0.03, .direct_samples = 64, .probes = 400};
  const SolveResult r = solve(query, material::SpectralBasis::grey(), o);
  EXPECT_LT(r.mesh_error, 0.06);  // 0.15 without division; the decision saw fewer samples
  EXPECT_LT(r.certificate.rms_low, 1.25 * std::hypot(r.error_estimate, r.mesh_error));
  ::testing::Test::RecordProperty("mesh", std::to_string(r.mesh_error));
  ::testing::Test::RecordProperty("elements", std::to_string(r.field.element_count()));
}

// Where light is the same everywhere interpolation misses nothing, however noisy samples are: all
// surfaces of a box emit (1 - rho) / pi and reflect rho, so E is 1 everywhere, half of it direct.
TEST(MeshError, NoiseIsNotTakenForStructure) {
  SceneMaker maker;
  material::Material warm = test::emitter(0.5 / 3.14159265358979, 0.5);
  maker.room({0, 0, 0}, {4, 3, 2.5f}, maker.material(warm));
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SolveResult r =
        solve(query, material::SpectralBasis::grey(),
              {.element_size = 0.4, .max_level = 0, .direct_samples = 128, .seed = seed});
    squares += r.mesh_error * r.mesh_error / 4.0;
    EXPECT_GT(r.error_estimate, 0.01);
  }
  // Second differences of means of 64 samples that scatter by about their mean: products of
  // sqrt(6) / 8 squared times 1 / 64 to 1 / 16 over 380 sides and two axes leave (0.013)^2; as
  // large again for the places, of which only what is more than two standard errors counts.
  EXPECT_LT(std::sqrt(squares), 0.02);
}

}  // namespace
}  // namespace atrium::radiosity
