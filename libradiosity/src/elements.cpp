#include "radiosity/elements.h"

#include <algorithm>
#include <numbers>

#include "cutting.h"
#include "division.h"
#include "facets.h"
#include "material/material.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::ObjectId;
using scene::Scene;
using scene::SurfaceField;

bool is_diffuse(const Scene& scene, std::size_t object) {
  const material::MaterialTraits t = material::traits(scene.material_of(ObjectId(object)));
  return t.diffuse_reflection || t.diffuse_transmission;
}

Corners object_corners(const Scene& scene, ObjectId id) {
  Corners corners(scene.mesh_of(id).triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    corners[t] = scene.corners(id, static_cast<std::uint32_t>(t));
  return corners;
}

double triangle_area(const std::array<Vec3f, 3>& c) {
  const Vec3d a = c[0].cast<double>();
  const double area = 0.5 * (c[1].cast<double>() - a).cross(c[2].cast<double>() - a).norm();
  return std::isfinite(area) ? area : 0.0;
}

/// Cells that a surface of this area gets; the cap keeps one huge plane from taking all of them.
double cell_count(double area, double h, double cap) {
  return std::max(1.0, std::min(area / (h * h), cap));
}

double cell_count(const std::vector<double>& areas, double h, double cap) {
  double count = 0.0;
  for (const double a : areas) count += cell_count(a, h, cap);
  return count;
}

struct CellSize {
  double cell, cap;  // edge [m]; most cells that one surface gets
};

/// The cell size at which the surfaces need about `budget` elements. No surface gets more than a
/// quarter of them unless there is not enough else to spend them on.
CellSize solve_cell_size(const std::vector<double>& areas, double budget) {
  double total = 0.0;
  for (const double a : areas) total += a;
  if (!(total > 0.0)) return {1.0, budget};
  for (double cap = budget / 4.0;; cap *= 2.0) {
    if (cap >= budget) cap = 1e12;  // one surface is nearly everything
    // Where all surfaces have their most, smaller cells are no more of them.
    const double most = static_cast<double>(areas.size()) * cap;
    if (most > 0.9 * budget) {
      const double wanted = std::min(budget, 0.999 * most);
      double log_low = 0.5 * std::log(total / budget) - 8.0;
      double log_high = 0.5 * std::log(total) + 1.0;
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (log_low + log_high);
        (cell_count(areas, std::exp(middle), cap) > wanted ? log_low : log_high) = middle;
      }
      const double h = std::exp(log_high);
      if (cap >= budget || cell_count(areas, h, cap) > 0.9 * budget)
        return {h, std::min(cap, 2.0 * budget)};
    }
  }
}

/// A facet that fell into regions: where its triangles' look-up trees and new facets are.
struct Divided {
  Division division;
  std::vector<std::uint32_t> triangles;
  std::uint32_t first_facet = 0;  ///< of the part's
};

struct ObjectPart {
  std::vector<Facet> facets;
  Corners corners;                      ///< the object's triangles, then parts of divided ones
  std::vector<std::uint32_t> original;  ///< triangle of each of these parts
  std::vector<Divided> divided;
  std::vector<CutFacet> cuts;
  double area = 0.0;
};

class Builder {
 public:
  Builder(const Scene& scene, const ElementOptions& options)
      : scene_(scene),
        options_(options),
        budget_(std::max(1U, options.max_elements)),
        parts_(scene.objects.size()) {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (is_diffuse(scene, i)) objects_.push_back(i);
  }

  Elements build() {
    measure_areas();
    scene::parallel_for(objects_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) grow(objects_[k]);
    });
    limit_facets();
    choose_final_size();
    const BarrierFinder barriers(scene_);
    const Covers covers(scene_);
    scene::parallel_for(objects_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        divide(barriers, covers, objects_[k]);
        cut(objects_[k]);
      }
    });
    return assemble();
  }

 private:
  void measure_areas() {
    std::vector<double> areas;
    for (const std::size_t object : objects_) {
      const ObjectId id(object);
      for (std::uint32_t t = 0; t < scene_.mesh_of(id).triangles.size(); ++t)
        parts_[object].area += triangle_area(scene_.corners(id, t));
      areas.push_back(parts_[object].area);
    }
    set_cell_size(areas);
  }

  void grow(std::size_t object) {
    const double cone = std::clamp(options_.normal_cone_deg, 0.0, 80.0) * std::numbers::pi / 180.0;
    // A floor for the cone: normals of float corners of one plane differ by rounding.
    const FacetOptions options{std::min(std::cos(cone), 1.0 - 1e-6), 0.5 * cell_};
    parts_[object].facets = grow_facets(object_corners(scene_, ObjectId(object)), options);
  }

  /// Scenes of countless small parts would get an element for each: clumps in growing voxels.
  void limit_facets() {
    double voxel = cell_;
    for (int round = 0; round < 8 && facet_count() > budget_ * 0.5; ++round, voxel *= 1.6)
      for (const std::size_t object : objects_)
        parts_[object].facets = merge_small_facets(std::move(parts_[object].facets), voxel, voxel);
  }

  double facet_count() const {
    std::size_t count = 0;
    for (const ObjectPart& p : parts_) count += p.facets.size();
    return static_cast<double>(count);
  }

  void choose_final_size() {
    std::vector<double> areas;
    for (const ObjectPart& p : parts_)
      for (const Facet& f : p.facets) areas.push_back(f.clump ? 0.0 : f.area);
    set_cell_size(areas);
  }

  /// A size that was asked for is kept, but for facets of very many cells. Small parts have an
  /// element each; where they are very many, half the budget is for what is larger.
  void set_cell_size(const std::vector<double>& areas) {
    const double least = static_cast<double>(areas.size()) + 0.5 * budget_;
    const CellSize size = options_.element_size > 0.0
                              ? CellSize{options_.element_size, budget_ * 4.0}
                              : solve_cell_size(areas, std::max(budget_, least));
    cell_ = size.cell;
    cap_ = size.cap;
  }

  /// Regions of a facet that other surfaces part become facets of their own.
  void divide(const BarrierFinder& barriers, const Covers& covers, std::size_t object) {
    ObjectPart& part = parts_[object];
    part.corners = object_corners(scene_, ObjectId(object));
    const Corners whole = part.corners;
    std::vector<Facet> facets;
    for (Facet& f : part.facets) {
      Division d = divide_facet(barriers, covers, ObjectId(object), whole, f, cell_);
      if (d.empty()) {
        facets.push_back(std::move(f));
        continue;
      }
      const auto shift = static_cast<std::uint32_t>(part.corners.size());
      part.corners.insert(part.corners.end(), d.corners.begin(), d.corners.end());
      part.original.insert(part.original.end(), d.original.begin(), d.original.end());
      const auto first = static_cast<std::uint32_t>(facets.size());
      for (Facet& region : d.facets) {
        for (std::uint32_t& t : region.triangles) t += shift;
        facets.push_back(std::move(region));
      }
      part.divided.push_back({std::move(d), std::move(f.triangles), first});
    }
    part.facets = std::move(facets);
  }

  void cut(std::size_t object) {
    ObjectPart& part = parts_[object];
    for (const Facet& f : part.facets)
      part.cuts.push_back(cut_facet(part.corners, f, ObjectId(object), cell_, cap_));
  }

  Elements assemble() {
    Elements e;
    e.max_level = options_.max_level;
    e.min_element_size = options_.min_element_size;
    SurfaceField& field = e.layout;
    field.triangle_facet.assign(scene_.triangle_count(), SurfaceField::kNone);
    e.first_piece.push_back(0);
    for (const std::size_t object : objects_) {
      append_cuts(field, object);
      const std::uint32_t first_part = append_parts(e.pieces, parts_[object]);
      for (std::size_t k = 0; k < parts_[object].cuts.size(); ++k)
        append(e, object, parts_[object].facets[k], parts_[object].cuts[k], first_part);
      parts_[object] = {};
    }
    e.pieces.shrink_to_fit();
    return e;
  }

  /// Look-up trees of the divided triangles; the part's facets will follow those of the field.
  void append_cuts(SurfaceField& field, std::size_t object) {
    for (Divided& d : parts_[object].divided) {
      const auto facet = static_cast<std::uint32_t>(field.facets.size()) + d.first_facet;
      const auto cut = static_cast<std::uint32_t>(field.cuts.size());
      const auto place = [&](std::uint32_t i) {
        return i == SurfaceField::kNone ? i : i + (SurfaceField::is_cut(i) ? cut : facet);
      };
      for (SurfaceField::Cut& n : d.division.nodes) {
        for (std::uint32_t& child : n.child) child = place(child);
        field.cuts.push_back(n);
      }
      for (std::size_t k = 0; k < d.triangles.size(); ++k)
        field.triangle_facet[scene_.objects[object].first_triangle + d.triangles[k]] =
            place(d.division.root[k]);
    }
  }

  /// What divided triangles fell into. \return the number of the first part.
  static std::uint32_t append_parts(ElementPieces& pieces, const ObjectPart& part) {
    const auto first = static_cast<std::uint32_t>(pieces.parts().size());
    const std::size_t whole = part.corners.size() - part.original.size();
    for (std::size_t t = whole; t < part.corners.size(); ++t)
      pieces.add_part({part.original[t - whole], part.corners[t]});
    return first;
  }

  void append(Elements& e, std::size_t object, const Facet& facet, CutFacet& cut,
              std::uint32_t first_part) {
    SurfaceField& field = e.layout;
    const auto facet_id = static_cast<std::uint32_t>(field.facets.size());
    SurfaceField::Facet& grid = field.facets.emplace_back(cut.grid);
    grid.first_cell = static_cast<std::uint32_t>(field.nodes.size());
    field.nodes.resize(field.nodes.size() + std::size_t{grid.nx} * grid.ny, SurfaceField::kNone);
    const std::size_t triangles = scene_.mesh_of(ObjectId(object)).triangles.size();
    for (const std::uint32_t t : facet.triangles)
      if (t < triangles)  // pieces are found by their cuts
        field.triangle_facet[scene_.objects[object].first_triangle + t] = facet_id;
    for (std::size_t k = 0; k < cut.element_cell.size(); ++k) {
      const std::uint32_t cell = cut.element_cell[k];
      field.nodes[grid.first_cell + cell] = static_cast<std::uint32_t>(field.element_count());
      field.element_facet.push_back(facet_id);
      field.element_level.push_back(0);
      field.element_x.push_back(cell % grid.nx);
      field.element_y.push_back(cell / grid.nx);
      float area = 0.0f;
      for (std::uint32_t p = cut.first_piece[k]; p < cut.first_piece[k + 1]; ++p) {
        ElementPiece piece = cut.pieces[p];
        area += piece.area;
        if (piece.triangle >= triangles) {
          piece.part = first_part + piece.triangle - static_cast<std::uint32_t>(triangles);
          piece.triangle = e.pieces.parts()[piece.part].triangle;
        }
        e.pieces.push_back(piece);
      }
      field.element_area.push_back(area);
      e.first_piece.push_back(static_cast<std::uint32_t>(e.pieces.size()));
    }
    cut.pieces = {};
  }

  const Scene& scene_;
  ElementOptions options_;
  double budget_;
  double cap_ = 0.0;
  double cell_ = 0.0;
  std::vector<ObjectPart> parts_;
  std::vector<std::size_t> objects_;
};

}  // namespace

Elements make_elements(const Scene& scene, const ElementOptions& options) {
  return Builder(scene, options).build();
}

}  // namespace atrium::radiosity
