// The solvers check each other, and open scenes with exact answers.
#include <numbers>

#include <gtest/gtest.h>

#include "physics/radiosity_support.h"

namespace atrium::radiosity {
namespace {

using test::SceneMaker;
using test::Solved;

constexpr double kPi = std::numbers::pi;

// Unit squares that face each other at distance 1, a screen over a quarter of the plane between:
// by the symmetry of reflections exactly a quarter of the exchange is blocked.
scene::Scene half_blocked() {
  SceneMaker maker;
  const auto lamp = maker.material(test::emitter(1.0 / kPi, 1e-6));
  const auto black = maker.material(test::diffuse(1e-6));  // 0 has no elements
  maker.quad(lamp, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  maker.quad(black, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1});
  maker.quad(black, {0, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0.5f, 0.5f}, {0, 0.5f, 0.5f});
  return maker.take();
}

TEST(Matrix, QuarterBlockedSquares) {
  const Solved s(half_blocked(), {.solver = Solver::Matrix, .element_size = 10.0});
  // 65536 low-discrepancy rays on the 14 % that the few first rays do not decide.
  EXPECT_NEAR(s.direct(1), 0.149868672, 5e-4);
}

TEST(Rows, QuarterBlockedSquares) {
  const Solved s(half_blocked(), {.element_size = 0.125, .direct_samples = 256});
  const auto mean = s.mean([&](std::size_t e) { return s.direct(e); },
                           [&](std::size_t e) { return s.object(e) == 1; });
  EXPECT_NEAR(mean.value, 0.149868672, 4 * mean.error);
  EXPECT_LT(mean.error, 5e-4);
}

scene::Scene furnished_room() {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.7));
  const auto floor = maker.material(test::diffuse(0.3));
  const auto lamp = maker.material(test::emitter(10.0, 0.5));
  maker.room({0, 0, 0}, {3, 3, 2}, {white, white, white, white, floor, white});
  maker.quad(lamp, {1, 1, 1.9f}, {1, 2, 1.9f}, {2, 2, 1.9f}, {2, 1, 1.9f});
  maker.quad(white, {0.5f, 0.5f, 0.7f}, {1.5f, 0.5f, 0.7f}, {1.5f, 1.5f, 0.7f}, {0.5f, 1.5f, 0.7f});
  return maker.take();
}

// Closed room of one reflectance under a bright ceiling: its surfaces receive Phi / (1 - rho) in
// all.
scene::Scene closed_room(float reflectance) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(reflectance));
  const auto sky = maker.material(test::emitter(1.0 / kPi, reflectance));
  maker.room({0, 0, 0}, {3, 2, 2}, {white, white, white, white, white, sky});
  return maker.take();
}
constexpr double kCeiling = 3.0 * 2.0;
double received(const Solved& s) {
  double sum = 0.0;
  for (std::size_t e = 0; e < s.count(); ++e) sum += s.area(e) * s.total(e);
  return sum;
}

// Few light samples are noisy, but what they decide (which patches are hot) must not make the mean
// darker: when those samples counted themselves it was 0.7 % too dark.
TEST(Rows, DecisionsByLightSamplesDoNotDarkenTheRoom) {
  constexpr double kReflectance = 0.6;
  constexpr int kSeeds = 48;
  double sum = 0.0;
  double squares = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Solved s(closed_room(static_cast<float>(kReflectance)), {.element_size = 0.25,
                                               .max_level = 0,
                                               .direct_samples = 16,
                                               .seed = static_cast<std::uint64_t>(seed)});
    const double relative = received(s) * (1.0 - kReflectance) / kCeiling;
    sum += relative;
    squares += relative * relative;
  }
  const double mean = sum / kSeeds;
  const double error = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
  EXPECT_LT(error, 2e-3);
  EXPECT_NEAR(mean, 1.0, 4 * error);
}

// Each round reads a better field than the last; samples that had read an older one must not pull
// the solution away from it, round by round.
TEST(Rows, ManyRoundsStayWhereTheyWere) {
  constexpr double kReflectance = 0.85;
  SolveOptions options{.element_size = 0.5, .max_level = 0};
  for (const double error : {0.02, 0.002}) {
    options.error = error;
    const Solved s(closed_room(static_cast<float>(kReflectance)), options);
    EXPECT_EQ(s.result.stopped_by, "error");
    EXPECT_NEAR(received(s) * (1.0 - kReflectance) / kCeiling, 1.0, 2 * error);
  }
}

// Two rooms with a slit of 3 cm between them, a lamp in the first: what the second one gets is
// found by few samples. What these find says how many more a side gets; that must not change the
// mean. The reference has 60 times the samples, in fixed numbers.
TEST(Rows, RoundsDoNotFavourWhatSamplesWereLuckyToFind) {
  const auto rooms = [] {
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(0.5));
    const auto lamp = maker.material(test::emitter(50.0, 0.5));
    maker.room({0, 0, 0}, {4, 2, 2}, white);
    maker.quad(white, {2, 0, 0}, {2, 1, 0}, {2, 1, 2}, {2, 0, 2});
    maker.quad(white, {2, 1.03f, 0}, {2, 2, 0}, {2, 2, 2}, {2, 1.03f, 2});
    maker.quad(lamp, {0.9f, 0.9f, 1.9f}, {0.9f, 1.1f, 1.9f}, {1.1f, 1.1f, 1.9f},
               {1.1f, 0.9f, 1.9f});
    return maker.take();
  };
  const auto second_room = [](const Solved& s) {
    double sum = 0.0;
    for (std::size_t e = 0; e < s.count(); ++e)
      if (s.centre(e).x() > 2.01f) sum += s.area(e) * s.total(e);
    return sum;
  };
  SolveOptions options{.element_size = 0.25, .max_level = 0};
  SolveOptions many = options;
  many.gather_rays = many.direct_samples = 4096;
  const double reference = second_room(Solved(rooms(), many));
  constexpr int kSeeds = 24;
  double sum = 0.0;
  double squares = 0.0;
  options.error = 0.1;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(100 + seed);
    const Solved s(rooms(), options);
    EXPECT_EQ(s.result.stopped_by, "error");
    const double relative = second_room(s) / reference;
    sum += relative;
    squares += relative * relative;
  }
  const double mean = sum / kSeeds;
  const double error = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
  RecordProperty("mean", std::to_string(mean));
  RecordProperty("error", std::to_string(error));
  EXPECT_LT(error, 0.01);
  // The reference's own noise is a twelfth of one seed's.
  EXPECT_NEAR(mean, 1.0, 4 * error);
}

// The same room by three methods that share little: sampled rows, exact factors with a dense
// solution, and shooting.
TEST(Solvers, Agree) {
  const Solved rows(
      furnished_room(),
      {.element_size = 0.5, .max_level = 0, .gather_rays = 512, .direct_samples = 256});
  const Solved matrix(furnished_room(), {.solver = Solver::Matrix, .element_size = 0.5});
  const Solved shooting(
      furnished_room(),
      {.solver = Solver::Shooting, .element_size = 0.5, .direct_samples = 256, .tolerance = 1e-3});
  ASSERT_EQ(rows.count(), matrix.count());
  double indirect = 0.0, direct = 0.0, by_rows = 0.0, by_shooting = 0.0, sampled = 0.0,
         mean_rows = 0.0, mean_shooting = 0.0;
  for (std::size_t e = 0; e < rows.count(); ++e)
    for (const int side : {0, 1}) {
      const double a = rows.area(e), m = matrix.indirect(e, side);
      indirect += a * m;
      direct += a * matrix.direct(e, side);
      by_rows += a * std::abs(rows.indirect(e, side) - m);
      by_shooting += a * std::abs(shooting.indirect(e, side) - m);
      mean_rows += a * (rows.indirect(e, side) - m);
      mean_shooting += a * (shooting.indirect(e, side) - m);
      sampled += a * std::abs(rows.direct(e, side) - matrix.direct(e, side));
    }
  ASSERT_GT(indirect, 0.0);
  // Sampling: 1 % of indirect light with 576 rays, 2 % of direct light with 256 samples; shooting
  // takes 4 points per pair.
  EXPECT_LT(by_rows, 0.015 * indirect);
  EXPECT_LT(by_shooting, 0.03 * indirect);
  EXPECT_LT(sampled, 0.02 * direct);
  EXPECT_LT(std::abs(mean_rows), 0.005 * indirect);
  EXPECT_LT(std::abs(mean_shooting), 0.01 * indirect);
  EXPECT_LT(shooting.result.residual, 1e-3);
  const FluxBalance& f = matrix.result.flux;
  EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 1e-5 * f.emitted);
}

// Two plates and a lamp in the open. Fields in single precision and factors by two rules leave less
// than 1e-5; what was not shot is in the balance as ambient light.
// A ball of some hundreds of pieces an element: pairs of such elements are sampled, as exact
// factors take the product of their numbers.
TEST(Solvers, AgreeOnABallOfManyPieces) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.5));
  const auto lamp = maker.material(test::emitter(10.0, 0.5));
  maker.room({-1.5f, -1.5f, -0.6f}, {1.5f, 1.5f, 1.4f}, {white, white, white, white, white, white});
  maker.quad(lamp, {-0.5f, -0.5f, 1.3f}, {-0.5f, 0.5f, 1.3f}, {0.5f, 0.5f, 1.3f},
             {0.5f, -0.5f, 1.3f});
  maker.sphere(white, 0.4f, 4, false);
  const scene::Scene scene = maker.take();
  const auto of_ball = [&](Solver solver) {
    const Solved s(scene, {.solver = solver, .element_size = 0.8, .seed = 3});
    return s.mean([&](std::size_t e) { return s.total(e); },
                  [&](std::size_t e) { return s.object(e) + 1 == scene.objects.size(); });
  };
  const auto rows = of_ball(Solver::Rows);
  EXPECT_GT(rows.value, 0.5);
  EXPECT_NEAR(of_ball(Solver::Matrix).value, rows.value, 0.02 * rows.value);
  EXPECT_NEAR(of_ball(Solver::Shooting).value, rows.value, 0.03 * rows.value);
}

TEST(Shooting, OpenSceneBalances) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(0.6));
  maker.quad(white, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0});
  maker.quad(white, {0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2});
  maker.quad(maker.material(test::emitter(1.0, 0.6)), {1, 0.5f, 1.5f}, {1, 1.5f, 1.5f},
             {2, 1.5f, 1.5f}, {2, 0.5f, 1.5f});
  const Solved s(maker.take(), {.solver = Solver::Shooting, .element_size = 0.25});
  const FluxBalance& f = s.result.flux;
  EXPECT_NEAR(f.emitted, kPi, 1e-6);
  RecordProperty("imbalance",
                 std::to_string(1e9 * (f.absorbed + f.escaped - f.emitted) / f.emitted) + "e-9");
  EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 1e-5 * f.emitted);
  EXPECT_NEAR(f.escaped, 0.8085 * f.emitted, 0.003 * f.emitted);  // the solver 'matrix': 0.80847
}

// Cohen et al. 1988: what has not been shot, spread evenly as if it had been, makes a useful
// display of a few shots. Elements in the plane of the only shooters have received nothing else.
TEST(Shooting, AmbientTermAnticipatesWhatIsToCome) {
  const auto solved = [](double tolerance) {
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(0.8));
    maker.room({0, 0, 0}, {3, 3, 2},
               {white, white, white, white, maker.material(test::diffuse(0.4)), white});
    const auto lamp = maker.material(test::emitter(10.0, 0.5));
    maker.quad(lamp, {1, 1, 1.9f}, {1, 2, 1.9f}, {2, 2, 1.9f}, {2, 1, 1.9f});
    return Solved(maker.take(),
                  {.solver = Solver::Shooting, .element_size = 0.5, .tolerance = tolerance});
  };
  const auto mean = [](const Solved& s) {
    return s.mean([&](std::size_t e) { return s.total(e); }, [](std::size_t) { return true; })
        .value;
  };
  const Solved converged = solved(1e-3);
  for (const double tolerance : {0.98, 0.9, 0.7, 0.5}) {
    SCOPED_TRACE(tolerance);
    const Solved few = solved(tolerance);
    EXPECT_GT(few.result.residual, 0.9 * tolerance);
    // All shots went from the floor, the brightest: its sides have the ambient light and no other.
    double ambient = 1e300;
    for (std::size_t e = 0; e < few.count(); ++e)
      if (few.total(e) > 0.0) ambient = std::min(ambient, few.indirect(e));
    const double with = std::abs(mean(few) - mean(converged));
    const double without = std::abs(mean(few) - ambient - mean(converged));
    EXPECT_LT(with, 0.2 * without);
    EXPECT_GT(without, 0.1 * mean(converged));
  }
}

// A black floor has no elements: what it takes is absorbed all the same, and nothing escapes from a
// closed room.
TEST(Solvers, BlackSurfacesAbsorb) {
  for (const Solver solver : {Solver::Rows, Solver::Matrix, Solver::Shooting}) {
    SCOPED_TRACE(static_cast<int>(solver));
    SceneMaker maker;
    const auto white = maker.material(test::diffuse(0.7));
    const auto black = maker.material(test::diffuse(0.0));
    maker.room({0, 0, 0}, {3, 3, 2}, {white, white, white, white, black, white});
    const auto lamp = maker.material(test::emitter(10.0, 0.0));
    maker.quad(lamp, {1, 1, 1.9f}, {1, 2, 1.9f}, {2, 2, 1.9f}, {2, 1, 1.9f});
    const Solved s(maker.take(), {.solver = solver, .element_size = 0.5, .direct_samples = 256});
    const FluxBalance& f = s.result.flux;
    EXPECT_NEAR(f.escaped, 0.0, 1e-12 * f.emitted);
    EXPECT_NEAR(f.absorbed, f.emitted,
                solver == Solver::Rows ? 0.01 * f.emitted : 1e-4 * f.emitted);
  }
}

// A lit plate in the open: everything that is not absorbed escapes.
TEST(Rows, OpenSceneBalances) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.6));
  maker.quad(m, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0});
  maker.quad(m, {0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2});
  maker.point_light({0.7, 1, 0.8}, 10.0);
  const Solved s(maker.take(), {.element_size = 0.25, .direct_samples = 64});
  const FluxBalance& f = s.result.flux;
  EXPECT_NEAR(f.emitted, 40 * kPi, 1e-3);
  EXPECT_NEAR(f.absorbed + f.escaped, f.emitted, 4 * f.standard_error);
  EXPECT_LT(f.standard_error, 0.01 * f.emitted);
  EXPECT_GT(f.escaped, 0.3 * f.emitted);
}

// A_1 F_12 = A_2 F_21: what plate 1 sends to plate 2 is what comes back with the lamp on plate 2.
TEST(Rows, ReciprocityOfDirectLight) {
  const auto solved = [](bool first) {
    SceneMaker maker;
    const auto lamp = maker.material(test::emitter(1.0 / kPi, 0.5));
    const auto plate = maker.material(test::diffuse(0.5));
    maker.quad(first ? lamp : plate, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    maker.quad(first ? plate : lamp, {0, 0, 0.5f}, {0, 1, 0.5f}, {0, 1, 3.5f}, {0, 0, 3.5f});
    return Solved(maker.take(), {.element_size = 0.25, .gather_rays = 16, .direct_samples = 1024});
  };
  const Solved a = solved(true), b = solved(false);
  const auto received = [](const Solved& s, std::uint32_t object) {
    return s.mean([&](std::size_t e) { return s.direct(e); },
                  [&](std::size_t e) { return s.object(e) == object; });
  };
  const auto to_wall = received(a, 1), to_floor = received(b, 0);
  EXPECT_NEAR(3.0 * to_wall.value, to_floor.value,
              4 * std::hypot(3.0 * to_wall.error, to_floor.error));
  EXPECT_LT(to_floor.error, 0.01 * to_floor.value);
}

// A furnace is smooth: all that elements are divided for in this one is noise. Those whose samples
// are off are divided first, so the samples of the others are off to the other side: a mean of them
// was 2 % high.
TEST(Rows, DividedElementsHaveUnbiasedSamples) {
  double sum = 0.0;
  double variance = 0.0;
  constexpr int kSeeds = 8;
  for (int seed = 0; seed < kSeeds; ++seed) {
    SceneMaker maker;
    const auto m = maker.material(test::emitter(1.0, 0.5));
    maker.room({0, 0, 0}, {2, 2, 2}, {m, m, m, m, m, m});
    const Solved s(maker.take(), {.max_elements = 8000,
                                  .row_rays = 16,
                                  .gather_rays = 16,
                                  .direct_samples = 16,
                                  .seed = static_cast<std::uint64_t>(seed)});
    const auto mean =
        s.mean([&](std::size_t e) { return s.direct(e); }, [](std::size_t) { return true; });
    sum += mean.value / kSeeds;
    variance += mean.error * mean.error / (kSeeds * kSeeds);
  }
  EXPECT_NEAR(sum, kPi, 4 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 0.004 * kPi);
}

// A slab that stands in the floor: what it covers is no part of the element around it, which has
// the mean of its free part.
TEST(Rows, BuriedPointsDoNotDarkenTheirElement) {
  SceneMaker maker;
  const auto m = maker.material(test::diffuse(1e-6));  // 0 has no elements
  maker.quad(m, {-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  // Closed, opaque, over [0, 1]^2 and only 1 cm high above the floor: hardly a shadow.
  const float h = 0.01f;
  std::vector<Vec3f> p;
  for (const float z : {-h, h})
    for (const float y : {0.0f, 1.0f})
      for (const float x : {0.0f, 1.0f}) p.emplace_back(x, y, z);
  maker.object(m, p,
               {{0, 2, 3},
                {0, 3, 1},
                {4, 5, 7},
                {4, 7, 6},
                {0, 1, 5},
                {0, 5, 4},
                {2, 6, 7},
                {2, 7, 3},
                {0, 4, 6},
                {0, 6, 2},
                {1, 3, 7},
                {1, 7, 5}},
               true);
  maker.point_light({0, 0, 3}, 10.0);
  const Solved s(maker.take(), {.element_size = 2.0, .max_level = 0, .direct_samples = 1024});
  // E = I h / d^3 over [0, 2]^2 without [0, 1]^2, midpoint rule.
  double sum = 0.0;
  int points = 0;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) {
      const double x = (i + 0.5) / 100, y = (j + 0.5) / 100;
      if (x < 1 && y < 1) continue;
      sum += 10.0 * 3 / std::pow(x * x + y * y + 9, 1.5);
      ++points;
    }
  const Vec3f free(1.6f, 1.4f, 0.0f);  // in the first triangle
  const auto e = s.result.field.element_at(s.scene, scene::ObjectId(0U), 0, free);
  ASSERT_NE(e, scene::SurfaceField::kNone);
  EXPECT_NEAR(s.area(e), 3.0, 1e-5);  // the footprint is cut out
  // The shadow of the slab's edge takes 0.1 %.
  EXPECT_NEAR(s.direct(e), sum / points, 4 * s.error(e) + 1e-3 * sum / points);
  EXPECT_LT(s.error(e), 0.01 * s.direct(e));
}

}  // namespace
}  // namespace atrium::radiosity
