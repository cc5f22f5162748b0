#include <random>

#include <gtest/gtest.h>

#include "unit/radiosity/refined_scenes.h"

// SurfaceField::stencil() over elements of mixed levels.
namespace atrium::radiosity {
namespace {

using scene::ObjectId;
using scene::Scene;
using scene::Side;
using scene::SurfaceField;
using test::SceneMaker;

constexpr float kEdge = 4.0f;

/// A square in the plane z = 0 whose elements hold the means of a function of (x, y).
class Sampled {
 public:
  template <class F>
  Sampled(const Scene& scene, const Elements& e, F&& f) : scene_(scene), field_(e.layout) {
    field_.lanes = 1;
    field_.valid.assign(2 * field_.element_count(), 1);
    for (std::uint32_t i = 0; i < field_.element_count(); ++i) {
      // Cells of the square are whole: means by the 3 x 3 Gauss rule, exact to degree 5.
      const SurfaceField::Facet& facet = field_.facets[0];
      const Vec3d u = (facet.axis_u / facet.axis_u.squaredNorm()).cast<double>();
      const Vec3d v = (facet.axis_v / facet.axis_v.squaredNorm()).cast<double>();
      const double scale = std::ldexp(1.0, -field_.element_level[i]);
      const double node = std::sqrt(0.6);
      double mean = 0.0;
      for (const auto& [a, wa] : {std::pair(-node, 5.0), {0.0, 8.0}, {node, 5.0}})
        for (const auto& [b, wb] : {std::pair(-node, 5.0), {0.0, 8.0}, {node, 5.0}}) {
          const Vec3d p =
              facet.origin.cast<double>() + scale * (u * (field_.element_x[i] + 0.5 + 0.5 * a) +
                                                     v * (field_.element_y[i] + 0.5 + 0.5 * b));
          mean += wa * wb / 324.0 * f(p.x(), p.y());
        }
      field_.irradiance.direct.push_back(static_cast<float>(mean));
      field_.irradiance.direct.push_back(0.0f);
    }
  }

  [[nodiscard]] SurfaceField::Stencil stencil(float x, float y) const {
    return field_.stencil(scene_, ObjectId(0U), 0, {x, y, 0.0f}, Side::Front);
  }
  [[nodiscard]] double at(float x, float y) const {
    return static_cast<double>(
        field_.interpolate<1>(field_.irradiance.direct, stencil(x, y), Side::Front)[0]);
  }
  SurfaceField& field() { return field_; }

 private:
  const Scene& scene_;
  SurfaceField field_;
};

Scene square_wall() {
  SceneMaker maker;
  maker.quad(maker.material(test::diffuse(0.5)), {0, 0, 0}, {kEdge, 0, 0}, {kEdge, kEdge, 0},
             {0, kEdge, 0});
  return maker.take();
}

Elements graded(const Scene& scene, double size, int rounds, std::uint32_t seed) {
  Elements e = make_elements(scene, {.element_size = size});
  std::mt19937 random(seed);
  for (int round = 0; round < rounds; ++round)
    e = refine(scene, e, test::random_marks(e, 0.15, random)).elements;
  return e;
}

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

// Cell means of a linear function are its values at the centres. A margin of a cell of level 0 and
// a half keeps off the rim, where the value is constant beyond the outermost centres.
TEST(Stencil, LinearFunctionsAreMetOnGradedMeshes) {
  const Scene scene = square_wall();
  for (const int rounds : {0, 1, 3, 5}) {
    SCOPED_TRACE(rounds);
    const Elements e = graded(scene, 0.25, rounds, 5);
    const auto f = [](double x, double y) { return 2.0 + 0.7 * x - 0.4 * y; };
    const Sampled field(scene, e, f);
    // Values up to 5 in float, coordinates of 16 cells: a few units in the seventh digit.
    for_points(0.375, 2000, [&](float x, float y) { EXPECT_NEAR(field.at(x, y), f(x, y), 1e-5); });
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
      for_points(0.75, 4000, [&](float x, float y) {
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
