#pragma once

#include <cstdint>
#include <vector>

#include "barriers.h"
#include "covers.h"
#include "facets.h"
#include "scene/surface_field.h"

namespace atrium::radiosity {

/// What became of a facet that barriers divide into regions: light on one side of a wall says
/// nothing about the other, so each region is a facet of its own. What lies in its plane on top of
/// it divides it, too. Regions end at the lines of walls
/// even where a doorway connects them, so that no element lies on both sides of a wall. Slivers are
/// left out: no look-up finds an element there.
struct Division {
  std::vector<Facet> facets;            ///< their triangles count in `corners`
  Corners corners;                      ///< of the pieces of the facet's triangles
  std::vector<std::uint32_t> original;  ///< the triangle that each of them is part of
  /// Trees over the planes of the triangles that lie in several regions, as in SurfaceField, with
  /// indices into `nodes` and `facets`.
  std::vector<scene::SurfaceField::Cut> nodes;
  std::vector<std::uint32_t> root;  ///< by position in the facet's triangles
  [[nodiscard]] bool empty() const { return facets.empty(); }
};

/// \param cell  [m] of the facet: gaps between barriers below 2 % of it connect nothing, and what
/// ends within 1 % of it above or below the facet stands on it.
/// \return  empty if the barriers leave the facet in one region.
[[nodiscard]] Division divide_facet(const BarrierFinder& barriers, const Covers& covers,
                                    scene::ObjectId object, const Corners& corners,
                                    const Facet& facet, double cell);

}  // namespace atrium::radiosity
