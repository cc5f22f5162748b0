#include <numeric>
#include <stdexcept>

#include "cutting.h"
#include "material/error.h"
#include "radiosity/export_mesh.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::ObjectId;
using scene::Scene;
using scene::SurfaceField;

constexpr std::uint32_t kNone = SurfaceField::kNone;
constexpr float kLeastArea = 1e-30f;

/// A piece and the element that it belongs to.
struct Found {
  std::uint32_t element, triangle, part;
  CellPiece piece;
};

/// What one object's triangles fall into, parts of divided triangles included.
struct ObjectPieces {
  std::vector<Found> pieces;
  std::vector<TrianglePart> parts;
};

/// Follows a triangle through the field's look-up structure, as a look-up follows a point.
class Collector {
 public:
  Collector(const Scene& scene, const SurfaceField& field, ObjectId object)
      : scene_(scene), field_(field), object_(object) {}

  ObjectPieces collect() {
    const std::uint64_t first = scene_.objects[object_.value].first_triangle;
    const auto count = static_cast<std::uint32_t>(scene_.mesh_of(object_).triangles.size());
    for (triangle_ = 0; triangle_ < count; ++triangle_) {
      const std::uint32_t root = field_.triangle_facet[first + triangle_];
      const std::array<Vec3f, 3> corners = scene_.corners(object_, triangle_);
      part_ = ElementPiece::kWhole;
      if (!SurfaceField::is_cut(root))
        add(root, corners);
      else
        divide(root,
               {corners[0].cast<double>(), corners[1].cast<double>(), corners[2].cast<double>()});
    }
    return std::move(result_);
  }

 private:
  void divide(std::uint32_t at, const std::vector<Vec3d>& polygon) {
    if (polygon.empty()) return;
    if (!SurfaceField::is_cut(at)) return add_parts(at, polygon);
    const SurfaceField::Cut& cut = field_.cuts[at & ~SurfaceField::kCut];
    const Vec3d point = cut.point.cast<double>();
    const Vec3d normal = cut.normal.cast<double>();
    for (const std::size_t side : {0U, 1U}) {
      const double sign = side == 0 ? 1.0 : -1.0;
      std::vector<Vec3d> half;
      clip_polygon(
          polygon, half, [&](const Vec3d& p) { return sign * (p - point).dot(normal); },
          [](const Vec3d& a, const Vec3d& b, double t) { return Vec3d(a + t * (b - a)); });
      divide(cut.child[side], half);
    }
  }

  void add_parts(std::uint32_t facet, const std::vector<Vec3d>& polygon) {
    if (facet == kNone) return;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const std::array<Vec3f, 3> corners{polygon[0].cast<float>(), polygon[i].cast<float>(),
                                         polygon[i + 1].cast<float>()};
      part_ = static_cast<std::uint32_t>(result_.parts.size());
      result_.parts.push_back({triangle_, corners});
      add(facet, corners);
    }
  }

  void add(std::uint32_t facet, const std::array<Vec3f, 3>& corners) {
    if (facet == kNone) return;
    const SurfaceField::Facet& grid = field_.facets[facet];
    Cutter cutter(grid);
    std::vector<CellPiece> pieces;
    cutter.cut(corners, pieces);
    for (CellPiece& piece : pieces)
      place(cutter, corners, field_.nodes[grid.first_cell + piece.cell], 0, piece.cell % grid.nx,
            piece.cell / grid.nx, piece);
  }

  void place(Cutter& cutter, const std::array<Vec3f, 3>& corners, std::uint32_t node, int level,
             std::uint32_t x, std::uint32_t y, CellPiece& piece) {
    if (node == kNone || !(piece.area > kLeastArea)) return;
    if (!SurfaceField::is_inner(node)) {
      result_.pieces.push_back({node, triangle_, part_, std::move(piece)});
      return;
    }
    std::vector<CellPiece> quarters;
    cutter.quarter(corners, level, x, y, quarters);
    for (CellPiece& q : quarters) {
      const std::uint32_t right = q.cell & 1U;
      const std::uint32_t upper = q.cell >> 1U;
      place(cutter, corners, field_.child(node, right, upper), level + 1, 2 * x + right,
            2 * y + upper, q);
    }
  }

  const Scene& scene_;
  const SurfaceField& field_;
  ObjectId object_;
  std::uint32_t triangle_ = 0, part_ = ElementPiece::kWhole;
  ObjectPieces result_;
};

SurfaceField layout_of(const SurfaceField& field) {
  SurfaceField layout = field;
  layout.lanes = 0;
  layout.irradiance = layout.body_irradiance = {};
  layout.standard_error = {};
  layout.valid = {};
  layout.unit = {};
  return layout;
}

/// Objects' pieces in the order of the elements.
void append(const std::vector<ObjectPieces>& objects, Elements& elements) {
  struct Place {
    std::uint32_t object, index;
  };
  std::vector<std::uint32_t> first_part;
  elements.first_piece.assign(elements.layout.element_count() + 1, 0);
  for (const ObjectPieces& o : objects) {
    first_part.push_back(static_cast<std::uint32_t>(elements.pieces.parts().size()));
    for (const TrianglePart& part : o.parts) elements.pieces.add_part(part);
    for (const Found& f : o.pieces) ++elements.first_piece[f.element + 1];
  }
  std::partial_sum(elements.first_piece.begin(), elements.first_piece.end(),
                   elements.first_piece.begin());
  std::vector<Place> order(elements.first_piece.back());
  std::vector<std::uint32_t> next(elements.first_piece.begin(), elements.first_piece.end() - 1);
  for (std::uint32_t o = 0; o < objects.size(); ++o)
    for (std::uint32_t i = 0; i < objects[o].pieces.size(); ++i)
      order[next[objects[o].pieces[i].element]++] = {o, i};
  for (const Place& p : order) {
    const Found& f = objects[p.object].pieces[p.index];
    const bool whole = f.part == ElementPiece::kWhole;
    elements.pieces.push_back({ObjectId(p.object), f.triangle, f.piece.area, f.piece.corners,
                               whole ? f.part : first_part[p.object] + f.part});
  }
}

}  // namespace

Elements elements_of_field(const Scene& scene, const SurfaceField& field) {
  if (field.triangle_facet.size() != scene.triangle_count())
    throw std::invalid_argument("elements_of_field: the field is of another scene");
  std::vector<ObjectPieces> objects(scene.objects.size());
  scene::parallel_for(objects.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t o = begin; o < end; ++o)
      objects[o] = Collector(scene, field, ObjectId(o)).collect();
  });
  Elements elements;
  elements.layout = layout_of(field);
  append(objects, elements);
  double area = 0.0;
  double expected = 0.0;
  for (std::size_t p = 0; p < elements.pieces.size(); ++p)
    area += static_cast<double>(elements.pieces[p].area);
  for (const float a : field.element_area) expected += static_cast<double>(a);
  if (!(std::abs(area - expected) <= 1e-3 * expected))
    throw Error("the elements of the solution do not lie on this scene");
  return elements;
}

}  // namespace atrium::radiosity
