#include <algorithm>
#include <stdexcept>

#include "cutting.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::Scene;
using scene::SurfaceField;

constexpr std::uint32_t kNone = SurfaceField::kNone;
// Cells below this many times what float coordinates resolve are not divided.
constexpr double kResolvable = 64.0;

/// A piece of a quarter, and which piece of the whole it is from.
struct QuarterPiece {
  std::uint32_t whole;
  CellPiece part;
};
using Quarters = std::vector<QuarterPiece>;

class Refiner {
 public:
  Refiner(const Scene& scene, const Elements& old, std::span<const std::uint8_t> split)
      : scene_(scene), old_(old), layout_(old.layout), divided_(split.size(), 0) {
    for (std::uint32_t e = 0; e < split.size(); ++e)
      if (split[e] != 0 && splittable(old_, e)) divide(e);
    balance();
  }

  Refined build() {
    cut_quarters();
    prepare();
    SurfaceField& layout = result_.elements.layout;
    for (std::uint32_t slot = 0; slot < base_cells_; ++slot) transfer(layout_.nodes[slot], slot);
    result_.elements.pieces.shrink_to_fit();
    layout.nodes.shrink_to_fit();
    return std::move(result_);
  }

 private:
  void divide(std::uint32_t e) {
    divided_[e] = 1;
    open_.push_back(e);
  }

  /// A divided element's neighbours are of its own level at least. The grids of one facet resolve
  /// the same everywhere, so a coarser neighbour of a splittable element is splittable too.
  void balance() {
    while (!open_.empty()) {
      const std::uint32_t e = open_.back();
      open_.pop_back();
      const SurfaceField::Facet& facet = layout_.facets[layout_.element_facet[e]];
      const int level = layout_.element_level[e];
      const std::int64_t x = layout_.element_x[e];
      const std::int64_t y = layout_.element_y[e];
      for (std::int64_t j = y - 1; j <= y + 1; ++j)
        for (std::int64_t i = x - 1; i <= x + 1; ++i) {
          const SurfaceField::Cell c = layout_.cell(facet, level, i, j);
          if (c.level < level && c.node != kNone && divided_[c.node] == 0) divide(c.node);
        }
    }
  }

  void cut_quarters() {
    quarters_of_.assign(divided_.size(), kNone);
    std::vector<std::uint32_t> list;
    for (std::uint32_t e = 0; e < divided_.size(); ++e)
      if (divided_[e] != 0) {
        quarters_of_[e] = static_cast<std::uint32_t>(list.size());
        list.push_back(e);
      }
    quarters_.resize(list.size());
    scene::parallel_for(list.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) quarters_[k] = quarter(list[k]);
    });
  }

  /// What all pieces of a triangle, or of one of its parts, are cut from.
  std::array<Vec3f, 3> source_of(const ElementPiece& piece) const {
    return piece.part == ElementPiece::kWhole ? scene_.corners(piece.object, piece.triangle)
                                              : old_.pieces.parts()[piece.part].corners;
  }

  Quarters quarter(std::uint32_t e) const {
    Quarters result;
    Cutter cutter(layout_.facets[layout_.element_facet[e]]);
    std::vector<CellPiece> parts;
    for (std::uint32_t p = old_.first_piece[e]; p < old_.first_piece[e + 1]; ++p) {
      const ElementPiece whole = old_.pieces[p];
      parts.clear();
      cutter.quarter(source_of(whole), layout_.element_level[e], layout_.element_x[e],
                     layout_.element_y[e], parts);
      for (CellPiece& part : parts) result.push_back({p, std::move(part)});
    }
    return result;
  }

  void prepare() {
    for (const SurfaceField::Facet& f : layout_.facets)
      base_cells_ = std::max(base_cells_, f.first_cell + f.nx * f.ny);
    Elements& e = result_.elements;
    e.max_level = old_.max_level;
    e.min_element_size = old_.min_element_size;
    e.layout.facets = layout_.facets;
    e.layout.triangle_facet = layout_.triangle_facet;
    e.layout.cuts = layout_.cuts;
    e.pieces.set_parts(old_.pieces.parts());
    e.layout.nodes.assign(base_cells_, kNone);
    e.first_piece.push_back(0);
  }

  /// Copies what is below an old node to a new one, in the order of the quadtree.
  void transfer(std::uint32_t node, std::uint32_t slot) {
    if (node == kNone) return;
    if (SurfaceField::is_inner(node)) {
      const std::uint32_t first = open_block(slot);
      for (const std::uint32_t k : {0U, 1U, 2U, 3U})
        transfer(layout_.child(node, k, k >> 1U), first + k);
      return;
    }
    const int level = layout_.element_level[node];
    const std::uint32_t x = layout_.element_x[node];
    const std::uint32_t y = layout_.element_y[node];
    if (divided_[node] == 0) {
      for (std::uint32_t p = old_.first_piece[node]; p < old_.first_piece[node + 1]; ++p)
        result_.elements.pieces.push_back(old_.pieces[p]);
      return append(node, slot, level, x, y);
    }
    const std::uint32_t first = open_block(slot);
    for (const std::uint32_t k : {0U, 1U, 2U, 3U}) {
      const std::size_t before = result_.elements.pieces.size();
      for (const QuarterPiece& piece : quarters_[quarters_of_[node]])
        if (piece.part.cell == k) take(piece);
      if (result_.elements.pieces.size() > before)
        append(node, first + k, level + 1, 2 * x + (k & 1U), 2 * y + (k >> 1U));
    }
  }

  void take(const QuarterPiece& piece) {
    ElementPiece own = old_.pieces[piece.whole];
    own.area = piece.part.area;
    own.corners = piece.part.corners;
    result_.elements.pieces.push_back(own);
  }

  std::uint32_t open_block(std::uint32_t slot) {
    std::vector<std::uint32_t>& nodes = result_.elements.layout.nodes;
    const auto first = static_cast<std::uint32_t>(nodes.size());
    nodes[slot] = SurfaceField::kInner | first;
    nodes.resize(nodes.size() + 4, kNone);
    return first;
  }

  /// An element of the pieces since the last one.
  void append(std::uint32_t parent, std::uint32_t slot, int level, std::uint32_t x,
              std::uint32_t y) {
    Elements& e = result_.elements;
    SurfaceField& layout = e.layout;
    float area = 0.0f;
    for (std::size_t p = e.first_piece.back(); p < e.pieces.size(); ++p) area += e.pieces[p].area;
    layout.nodes[slot] = static_cast<std::uint32_t>(layout.element_count());
    layout.element_facet.push_back(layout_.element_facet[parent]);
    layout.element_level.push_back(static_cast<std::uint8_t>(level));
    layout.element_x.push_back(x);
    layout.element_y.push_back(y);
    layout.element_area.push_back(area);
    e.first_piece.push_back(static_cast<std::uint32_t>(e.pieces.size()));
    result_.parent.push_back(parent);
  }

  const Scene& scene_;
  const Elements& old_;
  const SurfaceField& layout_;
  std::vector<std::uint8_t> divided_;
  std::vector<std::uint32_t> open_;         // divided, neighbours not looked at yet
  std::vector<std::uint32_t> quarters_of_;  // by old element: index into quarters_
  std::vector<Quarters> quarters_;
  std::uint32_t base_cells_ = 0;
  Refined result_;
};

}  // namespace

bool splittable(const Elements& elements, std::uint32_t element) {
  const SurfaceField& layout = elements.layout;
  const SurfaceField::Facet& facet = layout.facets[layout.element_facet[element]];
  const int level = layout.element_level[element];
  if (facet.clump != 0 || level >= std::min(elements.max_level, SurfaceField::kMaxLevel))
    return false;
  const double half = 0.5 * static_cast<double>(layout.element_size(element));
  return half >= elements.min_element_size * (1.0 - 1e-6) &&
         std::ldexp(0.5, -level) >= kResolvable * grid_slack(facet).maxCoeff();
}

Refined refine(const Scene& scene, const Elements& elements, std::span<const std::uint8_t> split) {
  if (split.size() != elements.layout.element_count())
    throw std::invalid_argument("refine: one mark per element");
  return Refiner(scene, elements, split).build();
}

std::uint64_t element_key(const SurfaceField& layout, std::uint32_t element) {
  const SurfaceField::Facet& facet = layout.facets[layout.element_facet[element]];
  const std::uint32_t level = layout.element_level[element];
  const std::uint32_t x = layout.element_x[element];
  const std::uint32_t y = layout.element_y[element];
  const std::uint32_t cell = facet.first_cell + (y >> level) * facet.nx + (x >> level);
  std::uint32_t path = 1;
  for (std::uint32_t l = level; l-- > 0;)
    path = path << 2U | ((y >> l) & 1U) << 1U | ((x >> l) & 1U);
  return std::uint64_t{cell} << 32U | path;
}

std::vector<EdgeNeighbours> edge_neighbours(const SurfaceField& layout) {
  std::vector<EdgeNeighbours> result(layout.element_count());
  scene::parallel_for(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      result[e].fill(kNone);
      const SurfaceField::Facet& facet = layout.facets[layout.element_facet[e]];
      const std::int64_t x = layout.element_x[e];
      const std::int64_t y = layout.element_y[e];
      for (unsigned edge = 0; edge < 4; ++edge) {
        const bool along_v = edge < 2;  // the edge's own direction
        const int step = (edge & 1U) != 0 ? 1 : -1;
        const std::uint32_t node = layout
                                       .cell(facet, layout.element_level[e],
                                             x + (along_v ? step : 0), y + (along_v ? 0 : step))
                                       .node;
        std::uint32_t* const out = &result[e][2 * static_cast<std::size_t>(edge)];
        if (!SurfaceField::is_inner(node)) {
          out[0] = node;
          continue;
        }
        const std::uint32_t near = step > 0 ? 0U : 1U;  // the children on this side
        for (const std::uint32_t k : {0U, 1U})
          out[k] = along_v ? layout.child(node, near, k) : layout.child(node, k, near);
      }
    }
  });
  return result;
}

}  // namespace atrium::radiosity
