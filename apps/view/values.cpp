#include "values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atrium::view {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The array of a side; nullptr: not known there.
const Array* side_array(const std::vector<Array>& arrays, const Field& field, Side side) {
  return find_array(arrays,
                    field.sided && side == Side::Back ? field.array + "_back" : field.array);
}

Values of_array(const Array& array, const Field& field, bool colours, Place place, double scale) {
  const auto n = static_cast<std::size_t>(array.components);
  if (colours && n == 3) return {place, 3, array.values};
  Values v{place, 1, {}};
  v.numbers.resize(array.values.size() / n);
  const float factor = field.lux ? static_cast<float>(scale) : 1.0f;
  for (std::size_t i = 0; i < v.numbers.size(); ++i) {
    const float* x = &array.values[i * n];
    v.numbers[i] = factor * (n == 3 ? luminance_at(x) : x[0]);
  }
  return v;
}

/// Means over the polygons that meet at each point, by area; unknown ones do not count.
Values at_points(const Mesh& mesh, const Values& cells) {
  const auto n = static_cast<std::size_t>(cells.components);
  const std::size_t points = mesh.polygons.points.size();
  Values v{Place::Points, cells.components, std::vector<float>(points * n, 0.0f)};
  std::vector<float> area(points, 0.0f);
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    if (!std::isfinite(cells.numbers[k * n])) continue;
    for (const std::uint32_t p : mesh.corners(k)) {
      area[p] += mesh.area(k);
      for (std::size_t c = 0; c < n; ++c)
        v.numbers[p * n + c] += mesh.area(k) * cells.numbers[k * n + c];
    }
  }
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t c = 0; c < n; ++c)
      v.numbers[p * n + c] = area[p] > 0.0f ? v.numbers[p * n + c] / area[p] : kUnknown;
  return v;
}

Values at_polygons(const Mesh& mesh, const Values& points) {
  const auto n = static_cast<std::size_t>(points.components);
  Values v{Place::Polygons, points.components, std::vector<float>(mesh.polygon_count() * n)};
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    for (std::size_t c = 0; c < n; ++c) {
      float sum = 0.0f;
      for (const std::uint32_t p : mesh.corners(k)) sum += points.numbers[p * n + c];
      v.numbers[k * n + c] = sum / static_cast<float>(mesh.corners(k).size());
    }
  return v;
}

/// Hides what was not computed. A point is known if one of its polygons is.
void forget_invalid(const Mesh& mesh, Side side, Values& v) {
  const std::vector<std::uint8_t> valid = valid_sides(mesh, side);
  const auto n = static_cast<std::size_t>(v.components);
  std::vector<std::uint8_t> known = valid;
  if (v.place == Place::Points) {
    known.assign(mesh.polygons.points.size(), 0);
    for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
      if (valid[k] != 0)
        for (const std::uint32_t p : mesh.corners(k)) known[p] = 1;
  }
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i] == 0)
      std::fill_n(v.numbers.begin() + static_cast<std::ptrdiff_t>(i * n), n, kUnknown);
}

Values collect(const Mesh& mesh, const Field& field, Side side, bool smooth, bool colours) {
  const Array* points = side_array(mesh.polygons.point_arrays, field, side);
  const Array* cells = side_array(mesh.polygons.cell_arrays, field, side);
  const bool at_corners = smooth && field.look != Look::Classes;
  const auto take = [&](const Array& a, Place place) {
    return of_array(a, field, colours, place, mesh.lux_per_unit);
  };
  Values v;
  if (at_corners && points != nullptr)
    v = take(*points, Place::Points);
  else if (at_corners && cells != nullptr)
    v = at_points(mesh, take(*cells, Place::Polygons));
  else if (cells != nullptr)
    v = take(*cells, Place::Polygons);
  else if (points != nullptr)
    v = at_polygons(mesh, take(*points, Place::Points));
  else
    v = {at_corners ? Place::Points : Place::Polygons, 1,
         std::vector<float>(at_corners ? mesh.polygons.points.size() : mesh.polygon_count(),
                            kUnknown)};
  if (field.sided) forget_invalid(mesh, side, v);
  return v;
}

}  // namespace

std::vector<std::uint8_t> valid_sides(const Mesh& mesh, Side side) {
  const Array* a =
      find_array(mesh.polygons.cell_arrays, side == Side::Front ? "front_valid" : "back_valid");
  std::vector<std::uint8_t> valid(mesh.polygon_count(), 1);
  if (a != nullptr && a->components == 1)
    for (std::size_t k = 0; k < valid.size(); ++k) valid[k] = a->values[k] != 0.0f ? 1 : 0;
  return valid;
}

Values values_of(const Mesh& mesh, const Field& field, Side side, bool smooth) {
  return collect(mesh, field, side, smooth,
                 field.look == Look::TrueColour || field.look == Look::Surface);
}
Values numbers_of(const Mesh& mesh, const Field& field, Side side, bool smooth) {
  return collect(mesh, field, side, smooth, false);
}

}  // namespace atrium::view
