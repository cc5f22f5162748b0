#pragma once

#include <random>

#include "unit/radiosity/refined_scenes.h"

namespace atrium::test {

inline constexpr float kEdge = 4.0f;

/// A square in the plane z = 0 whose elements hold the means of a function of (x, y).
class Sampled {
 public:
  template <class F>
  Sampled(const scene::Scene& scene, const radiosity::Elements& e, F&& f)
      : scene_(scene), field_(e.layout) {
    field_.lanes = 1;
    field_.valid.assign(2 * field_.element_count(), 1);
    for (std::uint32_t i = 0; i < field_.element_count(); ++i) {
      // Cells of the square are whole: means by the 3 x 3 Gauss rule, exact to degree 5.
      const scene::SurfaceField::Facet& facet = field_.facets[0];
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

  [[nodiscard]] scene::SurfaceField::Stencil stencil(float x, float y) const {
    return field_.stencil(scene_, scene::ObjectId(0U), 0, {x, y, 0.0f}, scene::Side::Front);
  }
  [[nodiscard]] double at(float x, float y) const {
    return static_cast<double>(
        field_.interpolate<1>(field_.irradiance.direct, stencil(x, y), scene::Side::Front)[0]);
  }
  /// The same without the slopes at the rim: constant beyond the outermost centres.
  [[nodiscard]] double without_slopes(float x, float y) const {
    scene::SurfaceField::Stencil s = stencil(x, y);
    s.slope_count = 0;
    return static_cast<double>(
        field_.interpolate<1>(field_.irradiance.direct, s, scene::Side::Front)[0]);
  }
  [[nodiscard]] double element(float x, float y) const {
    const std::uint32_t e = field_.element_at(scene_, scene::ObjectId(0U), 0, {x, y, 0.0f});
    return static_cast<double>(field_.irradiance.direct[2 * std::size_t{e}]);
  }
  scene::SurfaceField& field() { return field_; }

 private:
  const scene::Scene& scene_;
  scene::SurfaceField field_;
};

inline scene::Scene square_wall() {
  SceneMaker maker;
  maker.quad(maker.material(diffuse(0.5)), {0, 0, 0}, {kEdge, 0, 0}, {kEdge, kEdge, 0},
             {0, kEdge, 0});
  return maker.take();
}

inline radiosity::Elements graded(const scene::Scene& scene, double size, int rounds,
                                  std::uint32_t seed) {
  radiosity::Elements e = radiosity::make_elements(scene, {.element_size = size});
  std::mt19937 random(seed);
  for (int round = 0; round < rounds; ++round)
    e = radiosity::refine(scene, e, random_marks(e, 0.15, random)).elements;
  return e;
}

}  // namespace atrium::test
