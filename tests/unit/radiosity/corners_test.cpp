#include "radiosity/corners.h"

#include <gtest/gtest.h>

#include "unit/radiosity/sampled_wall.h"

namespace atrium::radiosity {
namespace {

using scene::Scene;
using scene::SurfaceField;
using test::Sampled;

Vec3f place_in(const SurfaceField& layout, std::uint32_t e, double x, double y) {
  const SurfaceField::Facet& f = layout.facets[layout.element_facet[e]];
  const Vec3d u = (f.axis_u / f.axis_u.squaredNorm()).cast<double>();
  const Vec3d v = (f.axis_v / f.axis_v.squaredNorm()).cast<double>();
  const double edge = std::ldexp(1.0, -layout.element_level[e]);
  return (f.origin.cast<double>() +
          edge * ((layout.element_x[e] + x) * u + (layout.element_y[e] + y) * v))
      .cast<float>();
}

class Interpolated {
 public:
  explicit Interpolated(const SurfaceField& field)
      : field_(field),
        corners_(cell_corners(field)),
        values_(corner_values(field, corners_, field.irradiance.direct)) {}

  [[nodiscard]] double at(std::uint32_t e, const Vec3f& p) const {
    const std::array<float, 4> w = corner_weights(field_, e, p);
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
      sum += static_cast<double>(w[k] * values_[2 * std::size_t{corners_.of_element[e][k]}]);
    return sum;
  }
  [[nodiscard]] const CellCorners& corners() const { return corners_; }

 private:
  const SurfaceField& field_;
  CellCorners corners_;
  std::vector<float> values_;
};

// Along every edge the values of both sides' elements are the same, hanging corners included.
TEST(CellCorners, ValuesAreContinuousOnGradedMeshes) {
  const Scene scene = test::square_wall();
  const Elements e = test::graded(scene, 0.5, 4, 3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0.0, 9.0);
  Sampled sampled(scene, e, [&](double, double) { return any(random); });
  const SurfaceField& field = sampled.field();
  const Interpolated values(field);
  ASSERT_GT(values.corners().hanging.size(), 50U);
  const std::vector<EdgeNeighbours> neighbours = edge_neighbours(field);
  int compared = 0;
  for (std::uint32_t i = 0; i < field.element_count(); ++i)
    for (std::size_t edge = 0; edge < 4; ++edge)
      for (const std::size_t part : {0U, 1U}) {
        const std::uint32_t j = neighbours[i][2 * edge + part];
        if (j == SurfaceField::kNone) continue;
        const bool two = neighbours[i][2 * edge + 1] != SurfaceField::kNone;
        for (const double t : {0.0, 0.3, 0.8, 1.0}) {
          const double along = two ? 0.5 * (t + static_cast<double>(part)) : t;
          const double across = edge % 2 == 0 ? 0.0 : 1.0;
          const Vec3f p =
              edge < 2 ? place_in(field, i, across, along) : place_in(field, i, along, across);
          EXPECT_NEAR(values.at(i, p), values.at(j, p), 1e-4);
          ++compared;
        }
      }
  EXPECT_GT(compared, 2000);
}

TEST(CellCorners, LinearFunctionsAreMetToTheRim) {
  const Scene scene = test::square_wall();
  for (const int rounds : {0, 1, 4}) {
    SCOPED_TRACE(rounds);
    const Elements e = test::graded(scene, 0.25, rounds, 5);
    const auto f = [](double x, double y) { return 2.0 + 0.7 * x - 0.4 * y; };
    Sampled sampled(scene, e, f);
    const Interpolated values(sampled.field());
    for (std::uint32_t i = 0; i < e.layout.element_count(); ++i)
      for (const double x : {0.0, 0.4, 1.0})
        for (const double y : {0.0, 0.7, 1.0}) {
          const Vec3f p = place_in(e.layout, i, x, y);
          EXPECT_NEAR(values.at(i, p), f(static_cast<double>(p.x()), static_cast<double>(p.y())),
                      2e-5);
        }
  }
}

// The error of bilinear interpolation between corners, to the rim: order 2, of elements order 1.
TEST(CellCorners, SmoothFunctionsConvergeInSecondOrder) {
  const Scene scene = test::square_wall();
  const auto f = [](double x, double y) {
    return std::pow((x - 1.7) * (x - 1.7) + (y - 2.2) * (y - 2.2) + 1.0, -1.5);
  };
  double before = 0.0;
  double before_elements = 0.0;
  for (const double size : {0.25, 0.125, 0.0625}) {
    const Elements e = make_elements(scene, {.element_size = size});
    Sampled sampled(scene, e, f);
    const Interpolated values(sampled.field());
    double corners = 0.0;
    double elements = 0.0;
    double sum = 0.0;
    int count = 0;
    for (std::uint32_t i = 0; i < e.layout.element_count(); ++i)
      for (double x = 0.05; x < 1.0; x += 0.1)
        for (double y = 0.05; y < 1.0; y += 0.1) {
          const Vec3f p = place_in(e.layout, i, x, y);
          const double exact = f(static_cast<double>(p.x()), static_cast<double>(p.y()));
          sum += exact;
          ++count;
          corners += std::pow(values.at(i, p) - exact, 2);
          elements +=
              std::pow(static_cast<double>(sampled.field().irradiance.direct[2 * i]) - exact, 2);
        }
    const double rms = std::sqrt(corners / count) / (sum / count);
    const double rms_elements = std::sqrt(elements / count) / (sum / count);
    const std::string name = std::to_string(size).substr(0, 6);
    RecordProperty("rms_corners " + name, std::to_string(rms));
    RecordProperty("rms_elements " + name, std::to_string(rms_elements));
    if (before > 0.0) {
      EXPECT_GT(std::log2(before / rms), 1.8);
      EXPECT_NEAR(std::log2(before_elements / rms_elements), 1.0, 0.15);
    }
    before = rms;
    before_elements = rms_elements;
  }
}

// Invalid sides hold rubbish; what is seen of a valid element comes from valid ones.
TEST(CellCorners, InvalidElementsTakeNoPart) {
  const Scene scene = test::square_wall();
  const Elements e = test::graded(scene, 0.5, 3, 6);
  Sampled sampled(scene, e, [](double, double) { return 3.0; });
  SurfaceField& field = sampled.field();
  std::mt19937 random(1);
  std::bernoulli_distribution drop(0.4);
  for (std::uint32_t i = 0; i < field.element_count(); ++i)
    if (drop(random)) {
      field.valid[2 * i] = 0;
      field.irradiance.direct[2 * i] = 1e30f;
    }
  const Interpolated values(field);
  for (std::uint32_t i = 0; i < field.element_count(); ++i) {
    if (field.valid[2 * i] == 0) continue;
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0})
        EXPECT_NEAR(values.at(i, place_in(field, i, x, y)), 3.0, 1e-5);
  }
}

}  // namespace
}  // namespace atrium::radiosity
