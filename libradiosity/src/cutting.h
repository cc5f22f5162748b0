#pragma once

#include <array>
#include <vector>

#include "facets.h"
#include "polygon.h"
#include "radiosity/elements.h"

namespace atrium::radiosity {

/// A grid over a facet's rectangle, first_cell still 0.
/// \param cell       wanted cell size [m].
/// \param max_cells  a facet that would need more gets larger cells.
[[nodiscard]] scene::SurfaceField::Facet make_grid(const Corners& corners, const Facet& facet,
                                                   double cell, double max_cells);

/// Distance from a grid line, in cells of level 0, below which a corner lies on it: what float
/// coordinates leave of that line.
[[nodiscard]] Vec2d grid_slack(const scene::SurfaceField::Facet& grid);

/// The part of a triangle in one cell.
struct CellPiece {
  std::uint32_t cell = 0;  ///< iy * nx + ix
  float area = 0.0f;
  std::vector<Vec3f> corners;
};

/// Cuts triangles along a grid and its quadtrees, in double precision over the grid as stored: the
/// parts of a triangle do not depend on the order of cuts, and none of its area is lost.
class Cutter {
 public:
  explicit Cutter(const scene::SurfaceField::Facet& grid);

  /// Appends the parts in the cells of level 0.
  void cut(const std::array<Vec3f, 3>& triangle, std::vector<CellPiece>& out);
  /// Appends the parts in the four quarters of a cell; CellPiece::cell is 0..3, in the order of
  /// SurfaceField::nodes.
  void quarter(const std::array<Vec3f, 3>& triangle, int level, std::uint32_t x, std::uint32_t y,
               std::vector<CellPiece>& out);

 private:
  /// A corner in grid coordinates (cells) and in the scene.
  struct Vertex {
    std::array<double, 2> uv;
    Vec3d p;
  };
  using Polygon = std::vector<Vertex>;
  struct Strips {
    std::uint32_t first, last;
  };
  static constexpr std::size_t kU = 0, kV = 1;

  static Vertex lerp(const Vertex& a, const Vertex& b, double t);
  void place(const std::array<Vec3f, 3>& triangle);
  [[nodiscard]] Strips strips(const Polygon& polygon, std::size_t axis) const;
  void keep_strip(Polygon& polygon, std::size_t axis, std::uint32_t strip, Strips range);
  void keep_half(Polygon& polygon, std::size_t axis, double middle, bool upper);
  void keep_side(Polygon& polygon, std::size_t axis, double line, bool upper);
  static void add(const Polygon& polygon, std::uint32_t cell, std::vector<CellPiece>& out);

  Vec3d origin_, axis_u_, axis_v_;
  std::array<std::uint32_t, 2> count_;
  std::array<double, 2> slack_;
  Polygon whole_, row_, part_, scratch_;
};

/// A facet's grid and the pieces of its triangles, sorted by element. Elements are the occupied
/// cells in the order of their cell numbers.
struct CutFacet {
  scene::SurfaceField::Facet grid;
  std::vector<std::uint32_t> element_cell;
  std::vector<std::uint32_t> first_piece;  ///< element_cell.size() + 1
  ElementPieces pieces;
};

[[nodiscard]] CutFacet cut_facet(const Corners& corners, const Facet& facet, scene::ObjectId object,
                                 double cell, double max_cells);

}  // namespace atrium::radiosity
