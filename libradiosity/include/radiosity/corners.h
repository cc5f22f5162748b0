#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/surface_field.h"

namespace atrium::radiosity {

/// The corners of the elements' cells, shared by the cells of a facet that meet there. With a value
/// at each and bilinear interpolation in each cell a field is continuous within its facets: a
/// hanging corner, in the middle of a larger cell's edge, has the mean of that edge's ends.
struct CellCorners {
  /// Where a corner is, and at which level its value is taken: that of the largest cell there.
  struct Corner {
    std::uint32_t facet = 0;
    std::uint8_t level = 0;
    std::uint32_t x = 0, y = 0;  ///< in cells of that level
  };
  struct Hanging {
    std::uint32_t corner;
    std::array<std::uint32_t, 2> between;
  };
  std::vector<Corner> corners;
  std::vector<std::array<std::uint32_t, 4>> of_element;  ///< 00, 10, 01, 11, as nodes
  std::vector<Hanging> hanging;  ///< what depends on others comes after them
};

[[nodiscard]] CellCorners cell_corners(const scene::SurfaceField& layout);

/// Values at corners, index (corner * 2 + side) * lanes + lane: those of SurfaceField::stencil(),
/// hanging ones constrained. Where no element is valid, 0.
/// \param array  one of the field's, index (element * 2 + side) * lanes + lane, or empty: so is
///               the result.
/// \throws std::invalid_argument  if the corners are those of another layout.
[[nodiscard]] std::vector<float> corner_values(const scene::SurfaceField& field,
                                               const CellCorners& corners,
                                               const std::vector<float>& array);

/// Weights of an element's four corners at a place, bilinear; places outside its cell count as on
/// its edge.
[[nodiscard]] std::array<float, 4> corner_weights(const scene::SurfaceField& layout,
                                                  std::uint32_t element, const Vec3f& position);

}  // namespace atrium::radiosity
