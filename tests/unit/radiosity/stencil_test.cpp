#include <random>

#include <gtest/gtest.h>

#include "unit/radiosity/sampled_wall.h"

// SurfaceField::stencil() over elements of mixed levels.
namespace atrium::radiosity {
namespace {

using scene::Scene;
using scene::Side;
using scene::SurfaceField;
using test::graded;
using test::kEdge;
using test::Sampled;
using test::square_wall;

/// Calls f(x, y) for points at least `margin` inside the square.
template <class F>
void for_points(double margin, int count, F&& f) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> place(static_cast<float>(margin),
                                              kEdge - static_cast<float>(margin));
  for (int i = 0; i < count; ++i) {
    const float x = place(random);
    f(x, place(random));
  }
}

TEST(Stencil, WeightsArePositiveAndSumToOne) {
  const Scene scene = square_wall();
  int longest = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const Elements e = graded(scene, 0.5, 5, seed);
    const Sampled field(scene, e, [](double, double) { return 1.0; });
    for_points(0.0, 4000, [&](float x, float y) {
      const SurfaceField::Stencil s = field.stencil(x, y);
      float sum = 0.0f;
      for (int i = 0; i < s.count; ++i) {
        EXPECT_GT(s.weight[i], 0.0f);
        sum += s.weight[i];
      }
      EXPECT_NEAR(sum, 1.0f, 1e-6f);
      longest = std::max(longest, s.count);
    });
  }
  RecordProperty("longest", longest);
  EXPECT_LT(longest, SurfaceField::Stencil::kCapacity);
}

// Cell means of a linear function are its values at the centres.
TEST(Stencil, LinearFunctionsAreMetOnGradedMeshes) {
  const Scene scene = square_wall();
  for (const int rounds : {0, 1, 3, 5}) {
    SCOPED_TRACE(rounds);
    const Elements e = graded(scene, 0.25, rounds, 5);
    const auto f = [](double x, double y) { return 2.0 + 0.7 * x - 0.4 * y; };
    const Sampled field(scene, e, f);
    // Values up to 5 in float, coordinates of 16 cells: a few units in the seventh digit.
    for_points(0.0, 2000, [&](float x, float y) { EXPECT_NEAR(field.at(x, y), f(x, y), 1e-5); });
  }
}

// Every element divided once halves all cells of the same graded mesh: errors fall to a quarter.
TEST(Stencil, SmoothFunctionsConvergeInSecondOrder) {
  const Scene scene = square_wall();
  const auto f = [](double x, double y) { return 1.0 + 0.3 * x * x - 0.2 * x * y + 0.1 * y * y; };
  for (const int rounds : {0, 4}) {
    SCOPED_TRACE(rounds);
    Elements e = graded(scene, 0.5, rounds, 2);
    e.max_level = 12;
    double before_max = 0.0;
    double before_rms = 0.0;
    for (int step = 0; step < 3; ++step) {
      const Sampled field(scene, e, f);
      double largest = 0.0;
      double squares = 0.0;
      for_points(0.0, 4000, [&](float x, float y) {
        const double error = field.at(x, y) - f(x, y);
        largest = std::max(largest, std::abs(error));
        squares += error * error;
      });
      const double rms = std::sqrt(squares / 4000);
      if (step > 0) {
        RecordProperty("order_max_" + std::to_string(rounds) + "_" + std::to_string(step),
                       std::to_string(std::log2(before_max / largest)));
        EXPECT_GT(std::log2(before_max / largest), 1.8);
        EXPECT_GT(std::log2(before_rms / rms), 1.9);
      }
      before_max = largest;
      before_rms = rms;
      e = refine(scene, e, std::vector<std::uint8_t>(e.layout.element_count(), 1)).elements;
    }
  }
}

// The step where levels meet is of second order too, far below the values' difference.
TEST(Stencil, StepsBetweenLevelsAreOfSecondOrder) {
  const Scene scene = square_wall();
  const auto f = [](double x, double y) { return std::sin(x) * std::cos(0.7 * y); };
  std::vector<double> steps;
  for (const double size : {0.5, 0.25, 0.125}) {
    Elements e = make_elements(scene, {.element_size = size});
    std::vector<std::uint8_t> marks(e.layout.element_count());
    for (std::uint32_t i = 0; i < marks.size(); ++i)
      marks[i] = e.layout.element_x[i] * size < 2.0 ? 1 : 0;
    e = refine(scene, e, marks).elements;
    const Sampled field(scene, e, f);
    const bool along_x = std::abs(e.layout.facets[0].axis_u.x()) > 0.0f;
    double step = 0.0;
    for (float t = 0.5f; t < 3.5f; t += 0.01f)
      step =
          std::max(step, along_x ? std::abs(field.at(2.0f - 1e-5f, t) - field.at(2.0f + 1e-5f, t))
                                 : std::abs(field.at(t, 2.0f - 1e-5f) - field.at(t, 2.0f + 1e-5f)));
    steps.push_back(step);
  }
  // By Taylor: h^2 f_xx / 16 across, h^2 f_yy / 6 along from the coarse side, a quarter of that
  // from the fine one; |f_xx| <= 1, |f_yy| <= 0.49.
  EXPECT_LT(steps[0], 0.25 * (1.0 / 16 + 1.25 * 0.49 / 6));
  EXPECT_GT(std::log2(steps[0] / steps[1]), 1.7);
  EXPECT_GT(std::log2(steps[1] / steps[2]), 1.7);
}

// No new extrema: the result is a mean of the elements' values.
TEST(Stencil, StaysWithinTheValues) {
  const Scene scene = square_wall();
  const Elements e = graded(scene, 0.5, 4, 9);
  Sampled field(scene, e, [](double x, double y) { return x > 1.3 && y < 2.2 ? 7.0 : 1.0; });
  for_points(0.0, 4000, [&](float x, float y) {
    EXPECT_GE(field.at(x, y), 1.0 - 1e-5);
    EXPECT_LE(field.at(x, y), 7.0 + 1e-5);
  });
}

// Where the edge of light runs between the first and the second cell from the rim, a line through
// both would be far off: the value stays constant.
TEST(Stencil, AnEdgeOfLightIsNotContinuedBeyondTheRim) {
  const Scene scene = square_wall();
  const Elements e = make_elements(scene, {.element_size = 0.5});
  const Sampled field(scene, e, [](double x, double) { return x > 0.5 ? 7.0 : 1.0; });
  for_points(0.0, 4000, [&](float x, float y) {
    EXPECT_GE(field.at(x, y), 1.0 - 1e-5);
    EXPECT_LE(field.at(x, y), 7.0 + 1e-5);
    if (x < 0.25f) {
      EXPECT_NEAR(field.at(x, y), 1.0, 1e-5);
    }
  });
}

// A line that falls to less than nothing before the rim ends at nothing.
TEST(Stencil, IsNeverNegative) {
  const Scene scene = square_wall();
  const Elements e = make_elements(scene, {.element_size = 0.5});
  const Sampled field(scene, e, [](double x, double) { return std::max(0.0, x - 0.2); });
  for_points(0.0, 4000, [&](float x, float y) { EXPECT_GE(field.at(x, y), 0.0); });
}

// A point light 1 m before a wall: the whole wall to its rim, relative to the mean. Constant beyond
// the outermost centres it would be of first order: rms_constant.
TEST(Stencil, TheRimOfALitWallIsOfSecondOrder) {
  const Scene scene = square_wall();
  const auto f = [](double x, double y) {
    return std::pow((x - 1.7) * (x - 1.7) + (y - 2.2) * (y - 2.2) + 1.0, -1.5);
  };
  double before = 0.0;
  for (const double size : {0.5, 0.25, 0.125}) {
    const Elements e = make_elements(scene, {.element_size = size});
    const Sampled field(scene, e, f);
    double squares = 0.0;
    double constant = 0.0;
    double elements = 0.0;
    double sum = 0.0;
    int rim = 0;
    for_points(0.0, 20000, [&](float x, float y) {
      const double exact = f(x, y);
      sum += exact;
      elements += std::pow(field.element(x, y) - exact, 2);
      if (std::min({x, y, kEdge - x, kEdge - y}) > 0.5f * static_cast<float>(size)) return;
      ++rim;
      squares += std::pow(field.at(x, y) - exact, 2);
      constant += std::pow(field.without_slopes(x, y) - exact, 2);
    });
    const double mean = sum / 20000;
    const double rms = std::sqrt(squares / rim) / mean;
    const std::string name = std::to_string(size).substr(0, 5);
    RecordProperty("rim_rms " + name, std::to_string(rms));
    RecordProperty("rim_rms_constant " + name, std::to_string(std::sqrt(constant / rim) / mean));
    RecordProperty("rms_of_elements " + name, std::to_string(std::sqrt(elements / 20000) / mean));
    if (before > 0.0) {
      EXPECT_GT(std::log2(before / rms), 1.7);
    }
    before = rms;
  }
}

// Elements whose side was not computed hold rubbish: none of it is seen, on any level.
TEST(Stencil, InvalidElementsTakeNoPart) {
  const Scene scene = square_wall();
  const Elements e = graded(scene, 0.5, 4, 6);
  Sampled field(scene, e, [](double, double) { return 3.0; });
  std::mt19937 random(1);
  std::bernoulli_distribution drop(0.4);
  for (std::uint32_t i = 0; i < e.layout.element_count(); ++i)
    if (drop(random)) {
      field.field().valid[2 * i] = 0;
      field.field().irradiance.direct[2 * i] = 1e30f;
    }
  int found = 0;
  for_points(0.0, 4000, [&](float x, float y) {
    const SurfaceField::Stencil s = field.stencil(x, y);
    if (s.count == 0) return;
    ++found;
    EXPECT_NEAR(field.at(x, y), 3.0, 1e-5);
  });
  EXPECT_GT(found, 3500);
}

}  // namespace
}  // namespace atrium::radiosity
