#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh_io.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::radiosity {

struct ElementOptions {
  double element_size = 0.0;  ///< [m]; 0: from max_elements
  std::uint32_t max_elements = 60000;
  double normal_cone_deg = 10.0;  ///< a facet's normals lie within this angle of its mean
  int max_level = 6;              ///< how often refine() may halve a cell, at most kMaxLevel
  double min_element_size = 0.0;  ///< [m] refine() makes no smaller elements; 0: max_level decides
};

/// One convex piece of an element: the part of one triangle that lies in one cell.
struct ElementPiece {
  scene::ObjectId object;
  std::uint32_t triangle = 0;
  float area = 0.0f;               ///< [m^2]
  std::span<const Vec3f> corners;  ///< 3 or more, in the triangle's plane, its winding
  static constexpr std::uint32_t kWhole = 0xffffffffU;
  std::uint32_t part = kWhole;  ///< of ElementPieces::parts(), if the triangle is divided
};

/// Part of a triangle on one side of the walls that stand on it.
struct TrianglePart {
  std::uint32_t triangle;
  std::array<Vec3f, 3> corners;
};

/// Pieces in 16 bytes each and 12 per corner.
class ElementPieces {
 public:
  [[nodiscard]] std::size_t size() const { return records_.size(); }
  [[nodiscard]] ElementPiece operator[](std::size_t p) const {
    const Record& r = records_[p];
    const std::size_t end =
        p + 1 < records_.size() ? records_[p + 1].first_corner : corners_.size();
    const bool whole = (r.source & kPart) == 0;
    const std::uint32_t part = r.source & ~kPart;
    return {r.object, whole ? r.source : parts_[part].triangle, r.area,
            std::span(corners_).subspan(r.first_corner, end - r.first_corner),
            whole ? ElementPiece::kWhole : part};
  }
  void push_back(const ElementPiece& piece) {
    const bool whole = piece.part == ElementPiece::kWhole;
    records_.push_back({piece.object, whole ? piece.triangle : kPart | piece.part, piece.area,
                        static_cast<std::uint32_t>(corners_.size())});
    corners_.insert(corners_.end(), piece.corners.begin(), piece.corners.end());
  }
  [[nodiscard]] const std::vector<TrianglePart>& parts() const { return parts_; }
  void add_part(const TrianglePart& part) { parts_.push_back(part); }
  void set_parts(std::vector<TrianglePart> parts) { parts_ = std::move(parts); }
  [[nodiscard]] std::size_t bytes() const {
    return records_.capacity() * sizeof(Record) + corners_.capacity() * sizeof(Vec3f) +
           parts_.capacity() * sizeof(TrianglePart);
  }
  void shrink_to_fit() {
    records_.shrink_to_fit();
    corners_.shrink_to_fit();
  }

 private:
  struct Record {
    scene::ObjectId object;
    std::uint32_t source;  ///< triangle, or kPart | part
    float area;
    std::uint32_t first_corner;
  };
  static constexpr std::uint32_t kPart = 0x80000000U;
  std::vector<Record> records_;
  std::vector<Vec3f> corners_;
  std::vector<TrianglePart> parts_;
};

/// The elements of a scene: the look-up structure (a SurfaceField without values) and the pieces
/// that each element consists of. Elements are ordered by facet, cell and place in the cell's
/// quadtree, so they depend on what is divided and not on the order in which it was.
struct Elements {
  scene::SurfaceField layout;
  ElementPieces pieces;
  std::vector<std::uint32_t> first_piece;  ///< element_count() + 1
  int max_level = 0;                       ///< of ElementOptions
  double min_element_size = 0.0;           ///< [m] of ElementOptions
};

/// Cuts the diffuse surfaces of a scene into elements, all of level 0. Surfaces that reflect and
/// transmit nothing diffusely get none. Half-edge adjacency by OpenMesh.
[[nodiscard]] Elements make_elements(const scene::Scene& scene, const ElementOptions& options = {});

/// May refine() divide an element? Not if it is a clump, if its quarters would be below the
/// smallest size or level, or below what float coordinates resolve.
[[nodiscard]] bool splittable(const Elements& elements, std::uint32_t element);

struct Refined {
  Elements elements;
  std::vector<std::uint32_t> parent;  ///< by new element: the old one that it is or is part of
};

/// Divides elements into up to four (quarters without surface give none), and neighbours with them
/// until leaves that touch within a facet, corners included, differ by one level at most. Marks on
/// elements that are not splittable are ignored. What an element is made of depends on its cell
/// alone, and the areas of the parts sum to that of the whole but for rounding.
///
/// \param split  by element: nonzero to divide it.
/// \throws std::invalid_argument  if `split` has another size than the elements.
[[nodiscard]] Refined refine(const scene::Scene& scene, const Elements& elements,
                             std::span<const std::uint8_t> split);

/// The elements of a field that solve() returned for this scene, or that was stored since: facets
/// and quadtrees are the field's, their pieces are cut again. \throws std::out_of_range  if the
/// field is of another scene.
[[nodiscard]] Elements restore_elements(const scene::Scene& scene,
                                        const scene::SurfaceField& field);

/// A number of an element's place: (cell of level 0 in the layout) << 32 | path down the quadtree,
/// two bits per level behind a leading one. Different for different places, and the same for an
/// element after others were divided.
[[nodiscard]] std::uint64_t element_key(const scene::SurfaceField& layout, std::uint32_t element);

/// Elements across the edges of an element's cell, within the facet: two for each of the edges
/// towards -u, +u, -v, +v, by ascending coordinate along the edge. Where one neighbour covers the
/// edge the second is kNone; kNone also where there is no surface.
using EdgeNeighbours = std::array<std::uint32_t, 8>;
[[nodiscard]] std::vector<EdgeNeighbours> edge_neighbours(const scene::SurfaceField& layout);

/// The solution as polygons with the arrays of the mesh files (irradiance_direct, ..., radiosity).
/// Cells hold the elements' values, points those of the elements' corners (corners.h). No cracks
/// within an object: a place in the middle of a longer edge is a corner of that polygon, too.
/// Points are shared within a facet and where a smooth surface goes on in another one.
[[nodiscard]] scene::PolygonMesh to_polygon_mesh(const scene::Scene& scene,
                                                 const Elements& elements,
                                                 const scene::SurfaceField& field,
                                                 const material::SpectralBasis& basis);

}  // namespace atrium::radiosity
