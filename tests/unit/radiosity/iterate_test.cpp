#include "iterate.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "krylov.h"
#include "material/error.h"
#include "trapped.h"
#include "unit/radiosity/row_box.h"

namespace atrium::radiosity {
namespace {

using test::Box;
using test::closed_box;
using test::SceneMaker;

struct Answer {
  explicit Answer(Box& box) : exchange(box.problem.side_count()) {}
  SideValues<1> exchange;
  Iteration iteration;
};

Answer solve_uniform(Box& box, const Rows<1>& rows, float irradiance) {
  Answer a(box);
  const SideValues<1> source(box.problem.side_count(), Spectrum<1>(irradiance));
  const SideValues<1> none(box.problem.side_count());
  a.iteration = solve_rows(box.problem, rows, source, none, a.exchange, box.work);
  return a;
}

// Furnace: uniform irradiance S from lights and rows that sum to one give I = S rho / (1 - rho)
// in every element, whatever the rays hit. The number of applications of the rows hardly depends
// on rho: by sweeps alone 0.9999 would take 160,000.
TEST(SolveRows, FurnaceIsExactForAnyReflectanceBelowOne) {
  for (const double rho : {0.2, 0.5, 0.9, 0.99, 0.9999, 0.999999}) {
    SCOPED_TRACE(rho);
    Box box{closed_box(rho)};
    const Answer a = solve_uniform(box, box.rows(), 2.0f);
    EXPECT_TRUE(a.iteration.converged);
    EXPECT_LE(a.iteration.iterations, 40);
    EXPECT_EQ(a.iteration.trapped, 0U);
    const double rounded = static_cast<double>(static_cast<float>(rho));
    const double exact = 2.0 * rounded / (1.0 - rounded);
    for (const SideIndex i : box.problem.sides.active)
      if (side_of(i) == scene::Side::Front) {
        // The tolerance of 1e-7, floats of the result and of the sweep that ends the solve.
        EXPECT_NEAR(a.exchange[i][0], exact, 1e-6 * exact);
      }
  }
}

// A room of three colours of very different reflectance against the dense solution of the same
// rows by Eigen's LU.
TEST(SolveRows, AgreesWithADenseSolution) {
  SceneMaker maker;
  const auto a = maker.material(test::diffuse(0.9999));
  const auto b = maker.material(test::diffuse(0.999));
  const auto c = maker.material(test::diffuse(0.98));
  maker.room({0, 0, 0}, {3, 2, 2.5f}, {a, a, b, a, b, c});
  maker.point_light({1, 1, 1}, 1.0);
  Box box{maker.take()};
  const Rows<1> rows = box.rows();
  const std::vector<SideIndex>& active = box.problem.sides.active;
  const auto n = static_cast<Eigen::Index>(active.size());
  SideValues<1> source(box.problem.side_count());
  source[active[7]] = Spectrum<1>(3.0f);
  const SideValues<1> none(box.problem.side_count());
  SideValues<1> exchange(box.problem.side_count());
  const Iteration it = solve_rows(box.problem, rows, source, none, exchange, box.work);
  EXPECT_TRUE(it.converged);
  EXPECT_LE(it.iterations, 40);

  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, n);
  const auto place = [&](SideIndex i) {
    return std::lower_bound(active.begin(), active.end(), i) - active.begin();
  };
  for (Eigen::Index k = 0; k < n; ++k)
    for (std::uint64_t e = rows.first[static_cast<std::size_t>(k)];
         e < rows.first[static_cast<std::size_t>(k) + 1]; ++e)
      w(k, place(rows.entries[e].target)) +=
          static_cast<double>(rows.entries[e].weight) / 32.0 *
          static_cast<double>(box.problem.sides.reflectance[rows.entries[e].target][0]);
  Eigen::VectorXd s = Eigen::VectorXd::Zero(n);
  s(7) = 3.0;
  const Eigen::VectorXd exact =
      (Eigen::MatrixXd::Identity(n, n) - w).partialPivLu().solve(Eigen::VectorXd(w * s));
  for (Eigen::Index k = 0; k < n; ++k)
    EXPECT_NEAR(exchange[active[static_cast<std::size_t>(k)]][0], exact(k),
                3e-6 * exact.maxCoeff());
}

// Light groups: the solution of a sum is the sum of the solutions, from the same rows.
TEST(SolveRows, IsLinearInTheSource) {
  Box box{closed_box(0.95)};
  const Rows<1> rows = box.rows();
  const SideValues<1> none(box.problem.side_count());
  std::array<SideValues<1>, 3> source, result;
  for (auto& s : source) s.resize(box.problem.side_count());
  source[0][box.problem.sides.active[3]] = Spectrum<1>(1.0f);
  source[1][box.problem.sides.active[40]] = Spectrum<1>(2.5f);
  for (std::size_t i = 0; i < source[0].size(); ++i) source[2][i] = source[0][i] + source[1][i];
  for (std::size_t g = 0; g < 3; ++g) {
    result[g].resize(box.problem.side_count());
    EXPECT_TRUE(solve_rows(box.problem, rows, source[g], none, result[g], box.work).converged);
  }
  for (const SideIndex i : box.problem.sides.active) {
    const double sum = static_cast<double>(result[0][i][0]) + static_cast<double>(result[1][i][0]);
    EXPECT_NEAR(result[2][i][0], sum, 2e-6 * sum);
  }
}

TEST(SolveRows, RefusesAWhiteEnclosureByName) {
  Box box{closed_box(1.0)};
  try {
    (void)solve_uniform(box, box.rows(), 1.0f);
    FAIL() << "no refusal";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("material 'diffuse'"), std::string::npos) << e.what();
  }
}

// What no light reaches may be as white as it likes.
TEST(SolveRows, AnUnlitWhiteEnclosureIsDark) {
  Box box{closed_box(1.0)};
  const Answer a = solve_uniform(box, box.rows(), 0.0f);
  EXPECT_TRUE(a.iteration.converged);
  for (const SideIndex i : box.problem.sides.active) EXPECT_EQ(a.exchange[i][0], 0.0f);
}

// A white enclosure with one absorbing wall loses light, over however many bounces.
TEST(SolveRows, OneAbsorbingWallIsEnough) {
  SceneMaker maker;
  const auto white = maker.material(test::diffuse(1.0));
  const auto grey = maker.material(test::diffuse(0.99));
  maker.room({0, 0, 0}, {3, 2, 2.5f}, {white, white, white, white, white, grey});
  maker.point_light({1, 1, 1}, 1.0);
  Box box{maker.take()};
  const Answer a = solve_uniform(box, box.rows(256), 1.0f);
  EXPECT_TRUE(a.iteration.converged);
  EXPECT_EQ(a.iteration.trapped, 0U);
  // All flux is absorbed by the grey wall: 0.01 (1 + I) A_grey = A in the mean over the wall; the
  // rows' own A_i F_ij = A_j F_ji holds to their noise of 1 / sqrt(256 rays x 20 sides).
  double received = 0.0, area = 0.0, all = 0.0;
  for (const SideIndex i : box.problem.sides.active) {
    if (side_of(i) != scene::Side::Front) continue;
    const double own = static_cast<double>(box.problem.area(i));
    all += own;
    if (box.problem.sides.reflectance[i][0] == 1.0f) continue;
    received += own * (1.0 + static_cast<double>(a.exchange[i][0]));
    area += own;
  }
  EXPECT_NEAR(area, 6.0, 1e-4);
  EXPECT_NEAR(0.01 * received / all, 1.0, 0.03);
}

// A white slot in an absorbing room, so narrow that with few rays some of its sides see nothing
// else: the solve goes on, counts them, and what they hold stays below that of n / (n + 1).
TEST(SolveRows, AWhiteCreviceDoesNotStopTheSolve) {
  SceneMaker maker;
  const auto grey = maker.material(test::diffuse(0.3));
  const auto white = maker.material(test::diffuse(1.0));
  maker.room({0, 0, 0}, {3, 2, 2.5f}, grey);
  const float x = 1.0f, d = 0.01f;  // two plates, closed on three sides, open at the top
  maker.quad(white, {x, 0.5f, 0.2f}, {x, 1.5f, 0.2f}, {x, 1.5f, 1.2f}, {x, 0.5f, 1.2f});
  maker.quad(white, {x + d, 0.5f, 0.2f}, {x + d, 0.5f, 1.2f}, {x + d, 1.5f, 1.2f},
             {x + d, 1.5f, 0.2f});
  maker.quad(white, {x, 0.5f, 0.2f}, {x, 0.5f, 1.2f}, {x + d, 0.5f, 1.2f}, {x + d, 0.5f, 0.2f});
  maker.quad(white, {x, 1.5f, 0.2f}, {x + d, 1.5f, 0.2f}, {x + d, 1.5f, 1.2f}, {x, 1.5f, 1.2f});
  maker.quad(white, {x, 0.5f, 0.2f}, {x + d, 0.5f, 0.2f}, {x + d, 1.5f, 0.2f}, {x, 1.5f, 0.2f});
  maker.point_light({2, 1, 2}, 1.0);
  Box box{maker.take()};
  constexpr int kRays = 4;
  const Answer a = solve_uniform(box, box.rows(kRays), 1.0f);
  EXPECT_TRUE(a.iteration.converged);
  EXPECT_GT(a.iteration.trapped, 0U);
  EXPECT_LE(a.iteration.iterations, 60);
  const std::vector<std::uint8_t> trapped = find_trapped(box.problem, box.rows(kRays));
  double most = 0.0, outside = 0.0;
  for (const SideIndex i : box.problem.sides.active) {
    EXPECT_TRUE(std::isfinite(a.exchange[i][0]));
    double& m = trapped[i] != 0 ? most : outside;
    m = std::max(m, static_cast<double>(a.exchange[i][0]));
  }
  EXPECT_GT(most, 0.0);
  // A trapped side depends on trapped sides alone: I = (I + 1) n / (n + 1), so I = n.
  EXPECT_LE(most, kRays * (1.0 + 1e-5));
  EXPECT_GT(most, outside * 0.1);
}

// x of A x = b, known beforehand, two lanes; A has one eigenvalue of 1e-5, the rest near 1.
TEST(Gmres, FindsANearlySingularSolution) {
  constexpr std::size_t n = 500;
  Eigen::VectorXd u = Eigen::VectorXd::Ones(n).normalized();
  std::vector<double> exact(2 * n), b(2 * n), x(2 * n, 0.0);
  const LaneOperator apply = [&](const std::vector<double>& v, std::vector<double>& y) {
    for (std::size_t lane = 0; lane < 2; ++lane) {
      const double small = lane == 0 ? 1e-5 : 0.3;
      double dot = 0.0;
      for (std::size_t k = 0; k < n; ++k) dot += u(static_cast<Eigen::Index>(k)) * v[2 * k + lane];
      for (std::size_t k = 0; k < n; ++k)
        y[2 * k + lane] = v[2 * k + lane] * (1.0 + 0.1 * std::sin(static_cast<double>(k))) -
                          (1.0 - small) * dot * u(static_cast<Eigen::Index>(k)) *
                              (1.0 + 0.1 * std::sin(static_cast<double>(k)));
    }
  };
  for (std::size_t i = 0; i < 2 * n; ++i) exact[i] = 1.0 + std::cos(0.37 * static_cast<double>(i));
  apply(exact, b);
  const KrylovResult r = solve_gmres(
      apply, 2, b, 1e-9, 100, [] { return false; }, x);
  EXPECT_TRUE(r.converged);
  EXPECT_LE(r.iterations, 60);
  double error = 0.0, norm = 0.0;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    error += std::pow(x[i] - exact[i], 2);
    norm += exact[i] * exact[i];
  }
  EXPECT_LT(std::sqrt(error / norm), 1e-8);
  const KrylovResult cut = solve_gmres(
      apply, 2, b, 1e-9, 3, [] { return false; }, x = b);
  EXPECT_FALSE(cut.converged);
  EXPECT_EQ(cut.iterations, 3);
}

}  // namespace
}  // namespace atrium::radiosity
