#pragma once

#include <vector>

#include "facets.h"
#include "radiosity/elements.h"

namespace atrium::radiosity {

/// A facet's grid and the pieces of its triangles, sorted by element. Elements are the occupied
/// cells in the order of their cell numbers.
struct CutFacet {
  /// first_cell is still 0
  scene::SurfaceField::Facet grid{Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), 0, 0, 0};
  std::vector<std::uint32_t> element_cell;
  std::vector<std::uint32_t> first_piece;  ///< element_cell.size() + 1
  std::vector<ElementPiece> pieces;        ///< without their object
  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(grid.nx) * grid.ny;
  }
};

/// \param cell       wanted cell size [m].
/// \param max_cells  a facet that would need more gets larger cells.
[[nodiscard]] CutFacet cut_facet(const Corners& corners, const Facet& facet, double cell,
                                 double max_cells);

}  // namespace atrium::radiosity
