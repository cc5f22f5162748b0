#include <algorithm>

#include "cutting.h"
#include "polygon.h"
#include "radiosity/elements.h"

namespace atrium::radiosity {
namespace {

using scene::ObjectId;
using scene::SurfaceField;
using TriangleCorners = std::array<Vec3f, 3>;

/// Cuts the triangles of a scene along a field's facets and quadtrees.
class Restorer {
 public:
  Restorer(const scene::Scene& scene, const SurfaceField& field) : scene_(scene), field_(field) {}

  Elements restore() {
    for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
      object_ = ObjectId(o);
      const std::size_t count = scene_.mesh_of(object_).triangles.size();
      for (triangle_ = 0; triangle_ < count; ++triangle_) {
        const TriangleCorners corners = scene_.corners(object_, triangle_);
        const std::uint32_t at =
            field_.triangle_facet.at(scene_.objects[o].first_triangle + triangle_);
        divide({corners.begin(), corners.end()}, at, SurfaceField::is_cut(at));
      }
    }
    return assemble();
  }

 private:
  struct Piece {
    std::uint32_t element;
    ObjectId object;
    std::uint32_t triangle, part;
    float area;
    std::vector<Vec3f> corners;
  };

  /// Follows the planes that walls divide a triangle by.
  void divide(const std::vector<Vec3f>& polygon, std::uint32_t at, bool divided) {
    if (polygon.size() < 3 || at == SurfaceField::kNone) return;
    if (!SurfaceField::is_cut(at)) return add_polygon(polygon, at, divided);
    const SurfaceField::Cut& plane = field_.cuts.at(at & ~SurfaceField::kCut);
    for (const double sign : {1.0, -1.0}) {
      std::vector<Vec3f> half;
      clip_polygon(
          polygon, half,
          [&](const Vec3f& p) {
            return sign * static_cast<double>((p - plane.point).dot(plane.normal));
          },
          [](const Vec3f& a, const Vec3f& b, double t) {
            return Vec3f((a.cast<double>() + t * (b - a).cast<double>()).cast<float>());
          });
      divide(half, plane.child[sign > 0.0 ? 0 : 1], divided);
    }
  }

  void add_polygon(const std::vector<Vec3f>& polygon, std::uint32_t facet, bool divided) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const TriangleCorners corners{polygon[0], polygon[i], polygon[i + 1]};
      part_ = ElementPiece::kWhole;
      if (divided) {
        part_ = static_cast<std::uint32_t>(pieces_.parts().size());
        pieces_.add_part({triangle_, corners});
      }
      cut(corners, field_.facets.at(facet));
    }
  }

  void cut(const TriangleCorners& corners, const SurfaceField::Facet& facet) {
    Cutter cutter(facet);
    std::vector<CellPiece> pieces;
    cutter.cut(corners, pieces);
    for (CellPiece& p : pieces)
      descend(cutter, corners, std::move(p), field_.nodes.at(facet.first_cell + p.cell), 0,
              p.cell % facet.nx, p.cell / facet.nx);
  }

  void descend(Cutter& cutter, const TriangleCorners& corners, CellPiece piece, std::uint32_t node,
               int level, std::uint32_t x, std::uint32_t y) {
    constexpr float kLeastArea = 1e-30f;
    if (node == SurfaceField::kNone || !(piece.area > kLeastArea)) return;
    if (!SurfaceField::is_inner(node)) {
      found_.push_back({node, object_, triangle_, part_, piece.area, std::move(piece.corners)});
      return;
    }
    std::vector<CellPiece> quarters;
    cutter.quarter(corners, level, x, y, quarters);
    for (CellPiece& q : quarters) {
      const std::uint32_t k = q.cell;
      descend(cutter, corners, std::move(q), field_.child(node, k, k >> 1U), level + 1,
              2 * x + (k & 1U), 2 * y + (k >> 1U));
    }
  }

  Elements assemble() {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Piece& a, const Piece& b) { return a.element < b.element; });
    Elements e;
    e.layout = field_;
    e.pieces = std::move(pieces_);
    e.max_level = SurfaceField::kMaxLevel;
    std::size_t next = 0;
    for (std::uint32_t k = 0; k < field_.element_count(); ++k) {
      e.first_piece.push_back(static_cast<std::uint32_t>(e.pieces.size()));
      for (; next < found_.size() && found_[next].element == k; ++next) {
        const Piece& p = found_[next];
        e.pieces.push_back({p.object, p.triangle, p.area, p.corners, p.part});
      }
    }
    e.first_piece.push_back(static_cast<std::uint32_t>(e.pieces.size()));
    e.pieces.shrink_to_fit();
    return e;
  }

  const scene::Scene& scene_;
  const SurfaceField& field_;
  ElementPieces pieces_;
  std::vector<Piece> found_;
  ObjectId object_;
  std::uint32_t triangle_ = 0, part_ = ElementPiece::kWhole;
};

}  // namespace

Elements restore_elements(const scene::Scene& scene, const SurfaceField& field) {
  return Restorer(scene, field).restore();
}

}  // namespace atrium::radiosity
