#pragma once

#include <cmath>

#include "radiosity/solve.h"
#include "unit/radiosity/box_scene.h"

namespace atrium::test {

/// A scene with its solution, grey.
struct Solved {
  Solved(scene::Scene s, const radiosity::SolveOptions& options)
      : scene(std::move(s)),
        query(scene),
        result(radiosity::solve(query, material::SpectralBasis::grey(), options)) {}

  scene::Scene scene;
  scene::RayQuery query;
  radiosity::SolveResult result;

  [[nodiscard]] std::size_t count() const { return result.field.element_count(); }
  [[nodiscard]] double area(std::size_t e) const {
    return static_cast<double>(result.field.element_area[e]);
  }
  [[nodiscard]] std::uint32_t object(std::size_t e) const {
    return result.elements.pieces[result.elements.first_piece[e]].object.value;
  }
  [[nodiscard]] Vec3f centre(std::size_t e) const {
    Vec3f sum = Vec3f::Zero();
    float weight = 0.0f;
    for (std::size_t p = result.elements.first_piece[e]; p < result.elements.first_piece[e + 1];
         ++p) {
      const auto c = result.elements.pieces[p].corners;
      for (std::size_t k = 1; k + 1 < c.size(); ++k) {
        const float area = (c[k] - c[0]).cross(c[k + 1] - c[0]).norm();
        sum += area / 3.0f * (c[0] + c[k] + c[k + 1]);
        weight += area;
      }
    }
    return sum / weight;
  }
  [[nodiscard]] double at(const std::vector<float>& a, std::size_t e, int side) const {
    return a.empty() ? 0.0 : static_cast<double>(a[e * 2 + static_cast<std::size_t>(side)]);
  }
  [[nodiscard]] double direct(std::size_t e, int side = 0) const {
    return at(result.field.irradiance.direct, e, side);
  }
  [[nodiscard]] double caustic(std::size_t e, int side = 0) const {
    return at(result.field.irradiance.caustic, e, side);
  }
  [[nodiscard]] double indirect(std::size_t e, int side = 0) const {
    return at(result.field.irradiance.indirect, e, side);
  }
  [[nodiscard]] double total(std::size_t e, int side = 0) const {
    return direct(e, side) + caustic(e, side) + indirect(e, side);
  }
  [[nodiscard]] double error(std::size_t e, int side = 0) const {
    return at(result.field.standard_error, e, side);
  }

  struct Mean {
    double value = 0.0, error = 0.0;  // standard error, elements taken as independent
  };
  /// Area mean of a quantity over elements; `of(e)` its value, `in(e)` which elements.
  template <class Of, class In>
  [[nodiscard]] Mean mean(Of&& of, In&& in, int side = 0) const {
    double sum = 0.0, areas = 0.0, variance = 0.0;
    for (std::size_t e = 0; e < count(); ++e) {
      if (!in(e)) continue;
      sum += area(e) * of(e);
      areas += area(e);
      variance += std::pow(area(e) * error(e, side), 2);
    }
    return {sum / areas, std::sqrt(variance) / areas};
  }
};

}  // namespace atrium::test
