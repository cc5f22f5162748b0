#include <cmath>

#include <gtest/gtest.h>

#include "scene/square_density.h"

namespace atrium::scene {
namespace {

// Integrals over the square by bent points: f = 1 + x + 2 y has the mean 2.5. A grid of 256 x 256
// midpoints leaves less than 1e-3 at cells' borders.
TEST(SquareDensity, MakesUpForBentPoints) {
  SquareDensity::Levels levels;
  for (std::size_t k = 0; k < levels.size(); ++k)
    levels[k] = static_cast<std::uint8_t>(1 + (k * 37) % 255);
  const SquareDensity density(&levels);
  ASSERT_FALSE(density.uniform());
  constexpr int kGrid = 256;
  double sum = 0.0;
  double ones = 0.0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      float u = (static_cast<float>(i) + 0.5f) / kGrid;
      float v = (static_cast<float>(j) + 0.5f) / kGrid;
      const double q = static_cast<double>(density(u, v));
      ASSERT_GT(q, 0.0);
      ASSERT_TRUE(u >= 0.0f && u < 1.0f && v >= 0.0f && v < 1.0f);
      ASSERT_EQ(density.at({u, v}), static_cast<float>(q));
      sum += (1.0 + static_cast<double>(u) + 2.0 * static_cast<double>(v)) / q;
      ones += 1.0 / q;
    }
  // Cells of the lowest level get less than one row of the grid: a tenth of a percent is what that
  // leaves of a mean over 64 cells.
  EXPECT_NEAR(ones / (kGrid * kGrid), 1.0, 0.05);
  EXPECT_NEAR(sum / (kGrid * kGrid), 2.5, 0.125);
}

TEST(SquareDensity, IsOneWhereNothingIsKnown) {
  SquareDensity::Levels none{};
  EXPECT_TRUE(SquareDensity(&none).uniform());
  EXPECT_TRUE(SquareDensity(nullptr).uniform());
  EXPECT_EQ(SquareDensity(nullptr).at({0.3f, 0.9f}), 1.0f);
  EXPECT_EQ(fit_density(SquareDensity::Squares{}).levels, none);
}

// One cell has all: the density there is 0.3 + 0.7 * 64, elsewhere 0.3.
TEST(SquareDensity, FitsTheRootOfTheSquares) {
  SquareDensity::Squares squares{};
  squares[11] = 5.0;
  const FittedDensity fitted = fit_density(squares);
  EXPECT_NEAR(fitted.moment, 1.0 / (0.3 + 0.7 * 64.0), 1e-12);
  const SquareDensity density(&fitted.levels);
  // Levels are whole numbers up to 255, the lowest is 1.7 of them.
  EXPECT_NEAR(density.at({3.5f / 8, 1.5f / 8}), 45.1, 4.0);
  EXPECT_NEAR(density.at({6.5f / 8, 1.5f / 8}), 0.3, 0.06);
}

TEST(SquareDensity, BlurKeepsTheSum) {
  SquareDensity::Squares squares{};
  squares[0] = 1.0;
  squares[27] = 2.0;
  blur(squares);
  double sum = 0.0;
  for (const double s : squares) sum += s;
  EXPECT_NEAR(sum, 3.0, 1e-12);
  EXPECT_NEAR(squares[27], 0.5, 1e-12);
}

TEST(SquareDensity, SquareIsTheInverseOfTheHemisphere) {
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const Vec2f u((static_cast<float>(i) + 0.37f) / 64, (static_cast<float>(j) + 0.61f) / 64);
      EXPECT_LT((square_of(sample_cosine_hemisphere(u)) - u).norm(), 3e-4f) << u.transpose();
    }
}

}  // namespace
}  // namespace atrium::scene
