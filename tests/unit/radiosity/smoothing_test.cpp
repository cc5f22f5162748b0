#include "smoothing.h"

#include <random>

#include <gtest/gtest.h>

#include "unit/radiosity/row_box.h"

namespace atrium::radiosity {
namespace {

using test::Box;
using test::closed_box;

struct Noisy {
  SideValues<1> values;
  std::vector<double> variance;
};
/// A step across the middle of the room, and noise of this standard deviation.
Noisy step_with_noise(const Box& box, double sigma) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, sigma);
  Noisy n{SideValues<1>(box.problem.side_count()),
          std::vector<double>(box.problem.side_count(), sigma * sigma)};
  for (const SideIndex i : box.problem.sides.active) {
    const bool far = box.problem.points.sample(i / 2, Vec2f(0.5f, 0.5f)).position.x() > 1.5f;
    n.values[i] = Spectrum<1>(static_cast<float>((far ? 5.0 : 1.0) + noise(random)));
  }
  return n;
}

double flux(const Box& box, const SideValues<1>& values) {
  double sum = 0.0;
  for (const SideIndex i : box.problem.sides.active)
    sum += static_cast<double>(box.problem.area(i)) * static_cast<double>(values[i].mean());
  return sum;
}

// What a wrong sum does to a room: every bounce makes it too bright or too dark.
TEST(Smoothing, KeepsTheFlux) {
  const Box box{closed_box(0.5)};
  const Neighbours neighbours(box.elements.layout);
  const Noisy noisy = step_with_noise(box, 0.3);
  const Smoothing<1> smoothing(box.problem, neighbours, noisy.values, noisy.variance);
  const SideValues<1> smooth = smoothing(noisy.values);
  double moved = 0.0;
  for (const SideIndex i : box.problem.sides.active)
    moved = std::max(moved, std::abs(static_cast<double>((smooth[i] - noisy.values[i]).mean())));
  EXPECT_GT(moved, 0.1);
  EXPECT_NEAR(flux(box, smooth), flux(box, noisy.values), 1e-5 * flux(box, noisy.values));
}

// Without noise nothing is smoothed; with it less of it is left, and the step stays.
TEST(Smoothing, TakesNoiseOffAndLeavesSteps) {
  const Box box{closed_box(0.5)};
  const Neighbours neighbours(box.elements.layout);
  const Noisy exact = step_with_noise(box, 1e-9);
  const auto error_after = [&](double sigma) {
    const Noisy noisy = step_with_noise(box, sigma);
    const Smoothing<1> smoothing(box.problem, neighbours, noisy.values, noisy.variance);
    const SideValues<1> smooth = smoothing(noisy.values);
    double sum = 0.0;
    for (const SideIndex i : box.problem.sides.active)
      sum += std::pow(static_cast<double>((smooth[i] - exact.values[i]).mean()), 2);
    return std::sqrt(sum / static_cast<double>(box.problem.sides.active.size()));
  };
  EXPECT_LT(error_after(0.3), 0.9 * 0.3);
  EXPECT_LT(error_after(1e-4), 1e-3);
}

TEST(Smoothing, RefusesWeightsOfOtherSides) {
  const Box box{closed_box(0.5)};
  const Neighbours neighbours(box.elements.layout);
  EXPECT_THROW(Smoothing<1>(box.problem, neighbours, std::vector<float>(3)),
               std::invalid_argument);
}

}  // namespace
}  // namespace atrium::radiosity
