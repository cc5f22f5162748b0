#pragma once

#include <vector>

#include "fields.h"
#include "mesh.h"
#include "scene/surface_field.h"

namespace atrium::view {

using scene::Side;

/// Where values belong.
enum class Place { Points, Polygons };

/// Numbers of a field, NaN where nothing is known: sides that were not computed, and the back of
/// what has no back.
struct Values {
  Place place = Place::Points;
  int components = 1;  ///< 1; 3 for colours
  std::vector<float> numbers;

  [[nodiscard]] std::size_t size() const {
    return numbers.size() / static_cast<std::size_t>(components);
  }
};

/// One number each: of three it is their luminance; or three for looks in colour.
/// \param smooth  at points. Values that the mesh has at polygons only are the mean, by area, of
/// those that meet at the point, and the other way round; classes are at polygons always.
[[nodiscard]] Values values_of(const Mesh& mesh, const Field& field, Side side, bool smooth);
/// Always one number each.
[[nodiscard]] Values numbers_of(const Mesh& mesh, const Field& field, Side side, bool smooth);

/// By polygon: was this side computed? All 1 where the mesh does not say.
[[nodiscard]] std::vector<std::uint8_t> valid_sides(const Mesh& mesh, Side side);

}  // namespace atrium::view
