#include "cutting.h"

#include <algorithm>

#include "polygon.h"

namespace atrium::radiosity {
namespace {

/// A corner in grid coordinates (cells) and in the scene.
struct Vertex {
  double u, v;
  Vec3d p;
};
using Polygon = std::vector<Vertex>;

Vertex lerp(const Vertex& a, const Vertex& b, double t) {
  return {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v), a.p + t * (b.p - a.p)};
}

struct Grid {
  Vec3d origin, axis_u, axis_v;
  std::uint32_t nx = 1, ny = 1;
  [[nodiscard]] Vertex place(const Vec3f& corner) const {
    const Vec3d p = corner.cast<double>();
    const Vec3d d = p - origin;
    return {d.dot(axis_u), d.dot(axis_v), p};
  }
};

std::uint32_t cells_along(double length, double cell) {
  return static_cast<std::uint32_t>(std::clamp(std::round(length / cell), 1.0, 65536.0));
}

/// Cells span the facet's rectangle exactly, so a rectangular wall has no partial cells.
Grid make_grid(const Corners& corners, const Facet& facet, double cell, double max_cells) {
  const Vec3d axis_v = facet.normal.cross(facet.axis).normalized();
  Vec2d low = Vec2d::Constant(1e300);
  Vec2d high = Vec2d::Constant(-1e300);
  for (const std::uint32_t t : facet.triangles)
    for (const Vec3f& c : corners[t]) {
      const Vec3d d = c.cast<double>() - facet.centre;
      const Vec2d uv(d.dot(facet.axis), d.dot(axis_v));
      low = low.cwiseMin(uv);
      high = high.cwiseMax(uv);
    }
  const Vec2d size = high - low;
  Grid grid;
  if (!facet.clump) {
    // The bounding rectangle may be far larger than what is in it (a diagonal strip): occupied
    // cells count against max_cells, all cells against sixteen times that.
    const double occupied = facet.area / max_cells;
    const double all = size.x() * size.y() / (16.0 * max_cells);
    const double h = std::max({cell, std::sqrt(occupied), std::sqrt(all)});
    grid.nx = cells_along(size.x(), h);
    grid.ny = cells_along(size.y(), h);
  }
  grid.origin = facet.centre + low.x() * facet.axis + low.y() * axis_v;
  grid.axis_u = facet.axis * (size.x() > 0.0 ? grid.nx / size.x() : 1.0);
  grid.axis_v = axis_v * (size.y() > 0.0 ? grid.ny / size.y() : 1.0);
  return grid;
}

struct CellPiece {
  std::uint32_t cell;
  ElementPiece piece;
};

class Cutter {
 public:
  explicit Cutter(const Grid& grid) : grid_(grid) {}

  void cut(const std::array<Vec3f, 3>& corners, std::uint32_t triangle) {
    polygon_ = {grid_.place(corners[0]), grid_.place(corners[1]), grid_.place(corners[2])};
    triangle_ = triangle;
    const auto [v0, v1] = range(polygon_, &Vertex::v, grid_.ny);
    for (std::uint32_t j = v0; j <= v1; ++j) {
      const Polygon& row = v0 == v1 ? polygon_ : slab(polygon_, &Vertex::v, j, grid_.ny, row_);
      if (!row.empty()) cut_row(row, j);
    }
  }

  std::vector<CellPiece> pieces;

 private:
  void cut_row(const Polygon& row, std::uint32_t j) {
    const auto [u0, u1] = range(row, &Vertex::u, grid_.nx);
    for (std::uint32_t i = u0; i <= u1; ++i) {
      const Polygon& part = u0 == u1 ? row : slab(row, &Vertex::u, i, grid_.nx, cell_);
      if (!part.empty()) add(part, j * grid_.nx + i);
    }
  }

  /// Numbers of the first and last strip that a polygon touches.
  static std::pair<std::uint32_t, std::uint32_t> range(const Polygon& polygon, double Vertex::*axis,
                                                       std::uint32_t count) {
    double low = 1e300;
    double high = -1e300;
    for (const Vertex& v : polygon) {
      low = std::min(low, v.*axis);
      high = std::max(high, v.*axis);
    }
    const double last = static_cast<double>(count - 1);
    // Corners that lie on a grid line but for rounding do not open another strip.
    const double first = std::clamp(std::floor(low + kSlack), 0.0, last);
    const double end = std::clamp(std::ceil(high - kSlack) - 1.0, first, last);
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)};
  }

  /// Between the grid lines k and k + 1; the outermost strips are open to the outside.
  const Polygon& slab(const Polygon& in, double Vertex::*axis, std::uint32_t k, std::uint32_t count,
                      Polygon& out) {
    const Polygon* source = &in;
    if (k > 0) {
      clip_polygon(
          in, scratch_, [&](const Vertex& a) { return a.*axis - k; }, lerp);
      source = &scratch_;
    }
    if (k + 1 < count)
      clip_polygon(
          *source, out, [&](const Vertex& a) { return k + 1.0 - a.*axis; }, lerp);
    else
      out = *source;
    return out;
  }

  void add(const Polygon& polygon, std::uint32_t cell) {
    CellPiece result{cell, {}};
    result.piece.triangle = triangle_;
    std::vector<Vec3d> points;
    for (const Vertex& v : polygon) points.push_back(v.p);
    result.piece.area = static_cast<float>(0.5 * polygon_area_vector(points).norm());
    if (!(result.piece.area > 0.0f)) return;
    for (const Vec3d& p : points) result.piece.corners.push_back(p.cast<float>());
    pieces.push_back(std::move(result));
  }

  static constexpr double kSlack = 1e-6;  // cells
  Grid grid_;
  Polygon polygon_, row_, cell_, scratch_;
  std::uint32_t triangle_ = 0;
};

}  // namespace

CutFacet cut_facet(const Corners& corners, const Facet& facet, double cell, double max_cells) {
  const Grid grid = make_grid(corners, facet, cell, max_cells);
  Cutter cutter(grid);
  for (const std::uint32_t t : facet.triangles) cutter.cut(corners[t], t);
  std::stable_sort(cutter.pieces.begin(), cutter.pieces.end(),
                   [](const CellPiece& a, const CellPiece& b) { return a.cell < b.cell; });
  CutFacet result;
  result.grid = {grid.origin.cast<float>(),
                 grid.axis_u.cast<float>(),
                 grid.axis_v.cast<float>(),
                 grid.nx,
                 grid.ny,
                 0};
  for (CellPiece& p : cutter.pieces) {
    if (result.element_cell.empty() || result.element_cell.back() != p.cell) {
      result.element_cell.push_back(p.cell);
      result.first_piece.push_back(static_cast<std::uint32_t>(result.pieces.size()));
    }
    result.pieces.push_back(std::move(p.piece));
  }
  result.first_piece.push_back(static_cast<std::uint32_t>(result.pieces.size()));
  return result;
}

}  // namespace atrium::radiosity
