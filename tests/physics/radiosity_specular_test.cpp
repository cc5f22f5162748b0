// Light that reaches diffuse surfaces through mirrors and panes; more in apps/validation.
#include <numbers>

#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;

// Reflects all light at all angles: Fresnel with kappa so large that R is 1 in float.
material::Material perfect_mirror() {
  material::Material m;
  m.name = "mirror";
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.n = 1.0;
  m.kappa = 1e5;
  return m;
}

// A wall that is a mirror unfolds the room: the same as the doubled room with the mirrored lamp.
// Direct light of the mirrored lamp is the caustic part of the real one.
TEST(Mirror, RoomWithMirrorWallEqualsDoubledRoom) {
  const double rho = 0.6;
  const SolveOptions options{
      .element_size = 0.5, .max_level = 0, .gather_rays = 512, .direct_samples = 256,
      .caustic_photons = 2000000};
  SceneMaker half;
  const auto white = half.material(test::diffuse(rho));
  const auto mirror = half.material(perfect_mirror());
  half.room({0, 0, 0}, {2, 2, 2}, {mirror, white, white, white, white, white});
  half.point_light({0.7, 1.1, 1.3}, 10.0);
  const Solved a(half.take(), options);

  SceneMaker doubled;
  const auto wall = doubled.material(test::diffuse(rho));
  doubled.room({-2, 0, 0}, {2, 2, 2}, wall);
  doubled.point_light({0.7, 1.1, 1.3}, 10.0);
  doubled.point_light({-0.7, 1.1, 1.3}, 10.0);
  const Solved b(doubled.take(), options);

  int compared = 0;
  double worst = 0.0;
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < a.count(); ++i)
    for (std::size_t k = 0; k < b.count(); ++k) {
      if ((a.centre(i) - b.centre(k)).norm() > 1e-3f) continue;
      const double se = std::hypot(a.error(i), b.error(k));
      worst = std::max(worst, std::abs(a.total(i) - b.total(k)) / se);
      difference += a.area(i) * (a.total(i) - b.total(k));
      sum += a.area(i) * b.total(k);
      ++compared;
    }
  EXPECT_EQ(compared, 5 * 16);
  // The largest of 80 normal deviations exceeds 5 with probability 5e-5; the spread itself is
  // estimated from 8 groups (Student), which makes 8 of that.
  EXPECT_LT(worst, 8.0);
  EXPECT_LT(std::abs(difference), 0.005 * sum);
}

// A pane of index 1 without absorption reflects nothing and passes all: the room without it.
TEST(Pane, OfIndexOneIsInvisible) {
  const auto solved = [](bool with_pane) {
    SceneMaker maker;
    maker.room({0, 0, 0}, {4, 2, 2}, maker.material(test::diffuse(0.5)));
    if (with_pane) {
      material::Material pane;
      pane.medium = material::Material::Medium::Pane;
      pane.k_df = 0.0;
      pane.k_rg = 1.0;
      pane.k_tp_rg = 1.0;
      pane.n = 1.0;
      maker.quad(maker.material(pane), {2, 0, 0}, {2, 2, 0}, {2, 2, 2}, {2, 0, 2});
    }
    maker.point_light({1, 1, 1}, 10.0);
    return Solved(maker.take(), {.element_size = 0.5, .caustic_photons = 100000});
  };
  const Solved with = solved(true), without = solved(false);
  ASSERT_EQ(with.count(), without.count());
  for (std::size_t e = 0; e < with.count(); ++e) {
    EXPECT_NEAR(with.direct(e), without.direct(e), 1e-4 * without.direct(e));
    EXPECT_EQ(with.caustic(e), 0.0);
    EXPECT_NEAR(with.indirect(e), without.indirect(e), 6 * with.error(e));
  }
}

// Energy: light in a closed room with a clear glass pane in the middle is lost at walls only.
TEST(Pane, ClearGlassKeepsTheFluxBalance) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {4, 2, 2}, maker.material(test::diffuse(0.5)));
  material::Material glass;
  glass.medium = material::Material::Medium::Pane;
  glass.k_df = 0.0;
  glass.k_rg = 1.0;
  glass.k_tp_rg = 1.0;
  glass.n = 1.52;
  maker.quad(maker.material(glass), {2, 0, 0}, {2, 2, 0}, {2, 2, 2}, {2, 0, 2});
  maker.point_light({1, 1, 1}, 10.0);
  const Solved s(maker.take(), {.element_size = 0.25});
  const double exact = 40 * kPi / (40 * (1 - 0.5));  // Phi / (A (1 - rho)), A = 2 (8 + 8 + 4)
  const auto mean =
      s.mean([&](std::size_t e) { return s.total(e); }, [](std::size_t) { return true; });
  EXPECT_NEAR(mean.value, exact, 4 * mean.error / 0.5);
  EXPECT_LT(mean.error, 0.01 * exact);
  const FluxBalance& f = s.result.flux;
  EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 4 * f.standard_error);
  EXPECT_GT(s.caustic(0) + s.caustic(1) + s.caustic(2), 0.0);  // reflections of the pane
}

TEST(Solvers, MatrixAndShootingRefuseMirrors) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {1, 1, 1}, maker.material(test::diffuse(0.5)));
  maker.quad(maker.material(perfect_mirror()), {0.2f, 0.2f, 0.5f}, {0.8f, 0.2f, 0.5f},
             {0.8f, 0.8f, 0.5f}, {0.2f, 0.8f, 0.5f});
  maker.point_light({0.5, 0.5, 0.8}, 1.0);
  const scene::Scene scene = maker.take();
  const scene::RayQuery query(scene);
  for (const Solver solver : {Solver::Matrix, Solver::Shooting}) {
    try {
      static_cast<void>(solve(query, material::SpectralBasis::grey(), {.solver = solver}));
      FAIL();
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("rows"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace atrium::radiosity
