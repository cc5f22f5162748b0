#include "cutting.h"

#include <algorithm>
#include <numeric>

namespace atrium::radiosity {
namespace {

using Grid = scene::SurfaceField::Facet;

// Smaller pieces [m^2] are none: their parts of the deepest level would be zero in float.
constexpr float kLeastArea = 1e-30f;

std::uint32_t cells_along(double length, double cell) {
  return static_cast<std::uint32_t>(std::clamp(std::round(length / cell), 1.0, 65536.0));
}

}  // namespace

// Cells span the facet's rectangle exactly, so a rectangular wall has no partial cells.
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
  grid.nx = grid.ny = 1;
  grid.clump = facet.clump ? 1 : 0;
  if (!facet.clump) {
    // The bounding rectangle may be far larger than what is in it (a diagonal strip): occupied
    // cells count against max_cells, all cells against sixteen times that.
    const double occupied = facet.area / max_cells;
    const double all = size.x() * size.y() / (16.0 * max_cells);
    const double h = std::max({cell, std::sqrt(occupied), std::sqrt(all)});
    grid.nx = cells_along(size.x(), h);
    grid.ny = cells_along(size.y(), h);
  }
  const auto scale = [](std::uint32_t n, double length) { return length > 0.0 ? n / length : 1.0; };
  grid.origin = (facet.centre + low.x() * facet.axis + low.y() * axis_v).cast<float>();
  grid.axis_u = (facet.axis * scale(grid.nx, size.x())).cast<float>();
  grid.axis_v = (axis_v * scale(grid.ny, size.y())).cast<float>();
  return grid;
}

Vec2d grid_slack(const Grid& grid) {
  const Vec2d per_metre(static_cast<double>(grid.axis_u.norm()),
                        static_cast<double>(grid.axis_v.norm()));
  const double reach = static_cast<double>(grid.origin.cwiseAbs().maxCoeff()) +
                       grid.nx / per_metre.x() + grid.ny / per_metre.y();
  return (0x1p-22 * reach * per_metre).cwiseMax(1e-6);
}

Cutter::Cutter(const Grid& grid)
    : origin_(grid.origin.cast<double>()),
      axis_u_(grid.axis_u.cast<double>()),
      axis_v_(grid.axis_v.cast<double>()),
      count_{grid.nx, grid.ny} {
  const Vec2d slack = grid_slack(grid);
  slack_ = {slack.x(), slack.y()};
}

void Cutter::cut(const std::array<Vec3f, 3>& triangle, std::vector<CellPiece>& out) {
  place(triangle);
  const Strips rows = strips(whole_, kV);
  for (std::uint32_t j = rows.first; j <= rows.last; ++j) {
    row_ = whole_;
    keep_strip(row_, kV, j, rows);
    if (row_.empty()) continue;
    const Strips columns = strips(row_, kU);
    for (std::uint32_t i = columns.first; i <= columns.last; ++i) {
      part_ = row_;
      keep_strip(part_, kU, i, columns);
      add(part_, j * count_[kU] + i, out);
    }
  }
}

void Cutter::quarter(const std::array<Vec3f, 3>& triangle, int level, std::uint32_t x,
                     std::uint32_t y, std::vector<CellPiece>& out) {
  place(triangle);
  row_ = whole_;
  keep_strip(row_, kV, y >> level, strips(row_, kV));
  if (row_.empty()) return;
  keep_strip(row_, kU, x >> level, strips(row_, kU));
  double edge = 1.0;
  const auto middle = [&](std::uint32_t k) { return (k + 0.5) * edge; };
  for (int l = level - 1; l >= 0; --l, edge *= 0.5) {
    keep_half(row_, kV, middle(y >> (l + 1)), ((y >> l) & 1U) != 0);
    keep_half(row_, kU, middle(x >> (l + 1)), ((x >> l) & 1U) != 0);
  }
  for (const std::uint32_t k : {0U, 1U, 2U, 3U}) {
    part_ = row_;
    keep_half(part_, kV, middle(y), (k & 2U) != 0);
    keep_half(part_, kU, middle(x), (k & 1U) != 0);
    add(part_, k, out);
  }
}

Cutter::Vertex Cutter::lerp(const Vertex& a, const Vertex& b, double t) {
  return {{a.uv[0] + t * (b.uv[0] - a.uv[0]), a.uv[1] + t * (b.uv[1] - a.uv[1])},
          a.p + t * (b.p - a.p)};
}

void Cutter::place(const std::array<Vec3f, 3>& triangle) {
  whole_.clear();
  for (const Vec3f& corner : triangle) {
    const Vec3d p = corner.cast<double>();
    const Vec3d d = p - origin_;
    whole_.push_back({{d.dot(axis_u_), d.dot(axis_v_)}, p});
  }
}

/// Numbers of the first and last strip that a polygon touches. Corners that lie on a grid line but
/// for rounding do not open another strip.
Cutter::Strips Cutter::strips(const Polygon& polygon, std::size_t axis) const {
  double low = 1e300;
  double high = -1e300;
  for (const Vertex& v : polygon) {
    low = std::min(low, v.uv[axis]);
    high = std::max(high, v.uv[axis]);
  }
  const double last = static_cast<double>(count_[axis] - 1);
  const double first = std::clamp(std::floor(low + slack_[axis]), 0.0, last);
  const double end = std::clamp(std::ceil(high - slack_[axis]) - 1.0, first, last);
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)};
}

/// The outermost strips of a polygon are open to the outside.
void Cutter::keep_strip(Polygon& polygon, std::size_t axis, std::uint32_t strip, Strips range) {
  if (strip < range.first || strip > range.last) return polygon.clear();
  if (strip > range.first) keep_side(polygon, axis, strip, true);
  if (strip < range.last) keep_side(polygon, axis, strip + 1.0, false);
}

void Cutter::keep_half(Polygon& polygon, std::size_t axis, double middle, bool upper) {
  const auto [low, high] = std::minmax_element(
      polygon.begin(), polygon.end(),
      [axis](const Vertex& a, const Vertex& b) { return a.uv[axis] < b.uv[axis]; });
  if (polygon.empty()) return;
  const bool all_lower = high->uv[axis] <= middle + slack_[axis];
  const bool all_upper = !all_lower && low->uv[axis] >= middle - slack_[axis];
  if (all_lower ? upper : all_upper && !upper) return polygon.clear();
  if (!all_lower && !all_upper) keep_side(polygon, axis, middle, upper);
}

void Cutter::keep_side(Polygon& polygon, std::size_t axis, double line, bool upper) {
  const double sign = upper ? 1.0 : -1.0;
  clip_polygon(
      polygon, scratch_, [&](const Vertex& v) { return sign * (v.uv[axis] - line); }, lerp);
  std::swap(polygon, scratch_);
}

void Cutter::add(const Polygon& polygon, std::uint32_t cell, std::vector<CellPiece>& out) {
  Vec3d twice = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += (polygon[i].p - polygon[0].p).cross(polygon[i + 1].p - polygon[0].p);
  CellPiece piece{cell, static_cast<float>(0.5 * twice.norm()), {}};
  if (!(piece.area > 0.0f)) return;
  piece.corners.reserve(polygon.size());
  for (const Vertex& v : polygon) piece.corners.push_back(v.p.cast<float>());
  out.push_back(std::move(piece));
}

CutFacet cut_facet(const Corners& corners, const Facet& facet, scene::ObjectId object, double cell,
                   double max_cells) {
  CutFacet result;
  result.grid = make_grid(corners, facet, cell, max_cells);
  Cutter cutter(result.grid);
  std::vector<CellPiece> pieces;
  std::vector<std::uint32_t> triangle;  // by piece
  for (const std::uint32_t t : facet.triangles) {
    cutter.cut(corners[t], pieces);
    triangle.resize(pieces.size(), t);
  }
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return pieces[a].cell < pieces[b].cell;
  });
  for (const std::uint32_t i : order) {
    const CellPiece& p = pieces[i];
    if (!(p.area > kLeastArea)) continue;
    if (result.element_cell.empty() || result.element_cell.back() != p.cell) {
      result.element_cell.push_back(p.cell);
      result.first_piece.push_back(static_cast<std::uint32_t>(result.pieces.size()));
    }
    result.pieces.push_back({object, triangle[i], p.area, p.corners});
  }
  result.first_piece.push_back(static_cast<std::uint32_t>(result.pieces.size()));
  return result;
}

}  // namespace atrium::radiosity
