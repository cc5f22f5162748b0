#include "scene/surface_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace atrium::scene {
namespace {

constexpr std::uint32_t kNone = SurfaceField::kNone;

struct GridPlace {
  const SurfaceField::Facet* facet = nullptr;
  float x = 0.0f, y = 0.0f;  // in cells of level 0
};

GridPlace place(const SurfaceField::Facet& facet, const Vec3f& position) {
  const Vec3f d = position - facet.origin;
  return {&facet, d.dot(facet.axis_u), d.dot(facet.axis_v)};
}

GridPlace place(const SurfaceField& field, const Scene& scene, ObjectId object,
                std::uint32_t triangle, const Vec3f& position) {
  const std::uint32_t f = field.facet_at(scene, object, triangle, position);
  if (f == kNone) return {};
  return place(field.facets[f], position);
}

/// x truncated, in [0, most]; 0 for what is no number: in this order of arguments max() takes 0.
std::uint32_t truncated(float x, float most) {
  return static_cast<std::uint32_t>(std::min(std::max(0.0f, x), most));
}
std::uint32_t cell_coordinate(float x, std::uint32_t n) {
  return truncated(x, static_cast<float>(n - 1));
}

/// The leaf that a place lies in: an element or kNone.
std::uint32_t leaf_at(const SurfaceField& field, const GridPlace& p) {
  const std::uint32_t cx = cell_coordinate(p.x, p.facet->nx);
  const std::uint32_t cy = cell_coordinate(p.y, p.facet->ny);
  std::uint32_t node = field.nodes[p.facet->first_cell + cy * p.facet->nx + cx];
  if (!SurfaceField::is_inner(node)) return node;
  float x = std::clamp(p.x - static_cast<float>(cx), 0.0f, 1.0f);
  float y = std::clamp(p.y - static_cast<float>(cy), 0.0f, 1.0f);
  do {
    const bool right = x >= 0.5f;
    const bool upper = y >= 0.5f;
    x = 2.0f * x - (right ? 1.0f : 0.0f);
    y = 2.0f * y - (upper ? 1.0f : 0.0f);
    node = field.child(node, right ? 1U : 0U, upper ? 1U : 0U);
  } while (SurfaceField::is_inner(node));
  return node;
}

/// Searches leaves near a place in the 3 x 3 cells round it.
class NearestLeaf {
 public:
  NearestLeaf(const SurfaceField& field, const GridPlace& p) : field_(field), p_(p) {}

  std::uint32_t find() {
    const auto cx = static_cast<std::int64_t>(cell_coordinate(p_.x, p_.facet->nx));
    const auto cy = static_cast<std::int64_t>(cell_coordinate(p_.y, p_.facet->ny));
    for (std::int64_t y = cy - 1; y <= cy + 1; ++y)
      for (std::int64_t x = cx - 1; x <= cx + 1; ++x)
        visit(field_.cell(*p_.facet, 0, x, y).node, static_cast<float>(x), static_cast<float>(y),
              1.0f);
    return best_;
  }

 private:
  /// Distance to the leaf, then to its centre.
  void visit(std::uint32_t node, float x, float y, float edge) {
    if (node == kNone) return;
    const auto outside = [edge](float t) { return std::max({-t, t - edge, 0.0f}); };
    const auto square = [](float a, float b) { return a * a + b * b; };
    const float to_cell = square(outside(p_.x - x), outside(p_.y - y));
    if (to_cell > to_cell_) return;
    const float half = 0.5f * edge;
    if (SurfaceField::is_inner(node)) {
      for (const std::uint32_t k : {0U, 1U, 2U, 3U})
        visit(field_.child(node, k & 1U, k >> 1U), x + half * static_cast<float>(k & 1U),
              y + half * static_cast<float>(k >> 1U), half);
      return;
    }
    const float to_centre = square(p_.x - x - half, p_.y - y - half);
    if (to_cell == to_cell_ && to_centre >= to_centre_) return;
    best_ = node;
    to_cell_ = to_cell;
    to_centre_ = to_centre;
  }

  const SurfaceField& field_;
  GridPlace p_;
  std::uint32_t best_ = kNone;
  float to_cell_ = 1e30f, to_centre_ = 1e30f;
};

// The occupied leaf nearest to a place: rounding can put a point into an empty neighbour.
std::uint32_t nearest_element(const SurfaceField& field, const GridPlace& p) {
  const std::uint32_t here = leaf_at(field, p);
  return here != kNone ? here : NearestLeaf(field, p).find();
}

/// Above all coordinates of grids (2^16 cells, divided 12 times).
constexpr float kBeyondGrids = 1e9f;

class StencilMaker {
 public:
  StencilMaker(const SurfaceField& field, const SurfaceField::Facet& facet, Side side,
               SurfaceField::Stencil& result)
      : field_(field), facet_(facet), side_(static_cast<std::size_t>(side)), result_(result) {}

  /// Bilinear between the cells of a level whose centres surround (x, y), in cells of that level.
  /// \returns false if none of them has a valid element.
  bool add_block(int level, float x, float y, float weight) {
    // Truncation of what is not negative: std::floor() is a call on the oldest processors.
    const std::int64_t ix = std::int64_t{truncated(x + 0.5f, kBeyondGrids)} - 1;
    const std::int64_t iy = std::int64_t{truncated(y + 0.5f, kBeyondGrids)} - 1;
    const float wx = x - 0.5f - static_cast<float>(ix);
    const float wy = y - 0.5f - static_cast<float>(iy);
    std::array<SurfaceField::Cell, 4> cells;
    std::array<float, 4> w{};
    unsigned known = 0;
    for (unsigned k = 0; k < 4; ++k) {
      w[k] = ((k & 1U) != 0 ? wx : 1.0f - wx) * ((k & 2U) != 0 ? wy : 1.0f - wy);
      cells[k] = field_.cell(facet_, level, ix + (k & 1U), iy + (k >> 1U));
      if (valid_area(cells[k].node) > 0.0f) known |= 1U << k;
    }
    if (known == 0) return false;
    const auto is_known = [known](unsigned k) { return (known >> k & 1U) != 0; };
    const std::array<float, 4> own = w;
    for (unsigned k = 0; k < 4; ++k) {
      if (is_known(k) || !(own[k] > 0.0f)) continue;
      // From the neighbours along the axes if there are any, else along both from the diagonal.
      const bool u = is_known(k ^ 1U);
      const bool v = is_known(k ^ 2U);
      const float share = weight * (u && v ? 0.5f : 1.0f) * own[k];
      const unsigned diagonal = k ^ 3U;
      const auto extend = [&](unsigned from, bool along_u) {
        const bool upwards = (k & (along_u ? 1U : 2U)) != 0;
        add_slope(level, ix + (from & 1U), iy + (from >> 1U), along_u, upwards ? -1 : 1, share);
      };
      w[k] = 0.0f;
      if (u) w[k ^ 1U] += (v ? 0.5f : 1.0f) * own[k];
      if (v) w[k ^ 2U] += (u ? 0.5f : 1.0f) * own[k];
      if (!u && !v) w[diagonal] += own[k];
      if (u || !v) extend(u ? k ^ 1U : diagonal, true);
      if (v || !u) extend(v ? k ^ 2U : diagonal, false);
    }
    for (unsigned k = 0; k < 4; ++k)
      if (w[k] > 0.0f) add_cell(cells[k], level, ix + (k & 1U), iy + (k >> 1U), weight * w[k]);
    return true;
  }

  void add(std::uint32_t element, float weight) {
    int i = 0;
    while (i < result_.count && result_.element[i] != element) ++i;
    if (i == SurfaceField::Stencil::kCapacity) return;
    if (i == result_.count) {
      result_.element[result_.count++] = element;
      result_.weight[i] = 0.0f;
    }
    result_.weight[i] += weight;
  }

  /// One element alone, if it is valid.
  void add(std::uint32_t element) {
    if (usable(element)) add(element, 1.0f);
  }

 private:
  [[nodiscard]] bool usable(std::uint32_t element) const {
    return element != kNone && field_.valid[std::size_t{element} * 2 + side_] != 0;
  }

  /// Area of the valid elements below a node, 0 if there are none.
  [[nodiscard]] float valid_area(std::uint32_t node) const {
    if (!SurfaceField::is_inner(node)) return usable(node) ? field_.element_area[node] : 0.0f;
    float area = 0.0f;
    for (const std::uint32_t k : {0U, 1U, 2U, 3U})
      area += valid_area(field_.child(node, k, k >> 1U));
    return area;
  }

  /// The slope at a cell by the cells that follow it in a direction. Where one of them is part of a
  /// larger leaf, by the cells of that level.
  void add_slope(int level, std::int64_t x, std::int64_t y, bool along_u, int step, float weight) {
    if (result_.slope_count == SurfaceField::Stencil::kSlopes) return;
    for (; level >= 0; --level, x >>= 1, y >>= 1, weight *= 0.5f) {
      std::array<std::uint32_t, 3> nodes{};
      bool coarser = false;
      for (int k = 0; k < 3; ++k) {
        const SurfaceField::Cell c =
            field_.cell(facet_, level, x + (along_u ? k * step : 0), y + (along_u ? 0 : k * step));
        if (!(valid_area(c.node) > 0.0f)) return;
        nodes[static_cast<std::size_t>(k)] = c.node;
        coarser = coarser || c.level < level;
      }
      if (coarser) continue;
      result_.slope[result_.slope_count++] = {nodes[0], nodes[1], nodes[2], weight};
      return;
    }
  }

  void add_cell(const SurfaceField::Cell& cell, int level, std::int64_t x, std::int64_t y,
                float weight) {
    if (cell.level == level) {
      if (SurfaceField::is_inner(cell.node))
        add_mean(cell.node, weight / valid_area(cell.node));
      else
        add(cell.node, weight);
      return;
    }
    const float scale = std::ldexp(1.0f, cell.level - level);
    add_block(cell.level, (static_cast<float>(x) + 0.5f) * scale,
              (static_cast<float>(y) + 0.5f) * scale, weight);
  }

  void add_mean(std::uint32_t node, float weight_per_area) {
    if (!SurfaceField::is_inner(node)) {
      if (usable(node)) add(node, weight_per_area * field_.element_area[node]);
      return;
    }
    for (const std::uint32_t k : {0U, 1U, 2U, 3U})
      add_mean(field_.child(node, k, k >> 1U), weight_per_area);
  }

  const SurfaceField& field_;
  const SurfaceField::Facet& facet_;
  std::size_t side_;
  SurfaceField::Stencil& result_;
};

}  // namespace

std::uint32_t SurfaceField::facet_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                     const Vec3f& position) const {
  const std::uint64_t index = scene.objects[object.value].first_triangle + triangle;
  if (index >= triangle_facet.size()) return kNone;
  std::uint32_t at = triangle_facet[index];
  while (is_cut(at)) {
    const Cut& cut = cuts[at & ~kCut];
    at = cut.child[(position - cut.point).dot(cut.normal) >= 0.0f ? 0 : 1];
  }
  return at;
}

std::uint32_t SurfaceField::element_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                       const Vec3f& position) const {
  const GridPlace p = place(*this, scene, object, triangle, position);
  return p.facet != nullptr ? nearest_element(*this, p) : kNone;
}

std::uint32_t SurfaceField::element_of_facet(std::uint32_t facet, const Vec3f& position) const {
  return nearest_element(*this, place(facets[facet], position));
}

float SurfaceField::element_size(std::uint32_t element) const {
  const Facet& f = facets[element_facet[element]];
  const float cell_size =
      1.0f / std::sqrt(std::min(f.axis_u.squaredNorm(), f.axis_v.squaredNorm()));
  return std::ldexp(cell_size, -element_level[element]);
}

SurfaceField::Spot SurfaceField::spot(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                      const Vec3f& position) const {
  Spot s;
  s.facet = facet_at(scene, object, triangle, position);
  if (s.facet == kNone) return s;
  const GridPlace p = place(facets[s.facet], position);
  s.element = nearest_element(*this, p);
  s.x = p.x;
  s.y = p.y;
  return s;
}

SurfaceField::Stencil SurfaceField::stencil(const Spot& spot, Side side) const {
  Stencil s;
  if (spot.element == kNone) return s;
  const int level = element_level[spot.element];
  const auto scale = static_cast<float>(1U << static_cast<unsigned>(level));
  const Facet& facet = facets[spot.facet];
  fill(s, facet, level, spot.x * scale, spot.y * scale, side);
  if (s.count == 0) StencilMaker(*this, facet, side, s).add(spot.element);
  return s;
}

SurfaceField::Stencil SurfaceField::stencil(const Facet& facet, int level, float x, float y,
                                            Side side) const {
  Stencil s;
  fill(s, facet, level, x, y, side);
  return s;
}

void SurfaceField::fill(Stencil& s, const Facet& facet, int level, float x, float y,
                        Side side) const {
  if (!StencilMaker(*this, facet, side, s).add_block(level, x, y, 1.0f)) return;
  float sum = 0.0f;
  for (int i = 0; i < s.count; ++i) sum += s.weight[i];
  for (int i = 0; i < s.count; ++i) s.weight[i] /= sum;
}

}  // namespace atrium::scene
