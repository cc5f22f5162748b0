#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "material/frame.h"

namespace atrium::radiosity {

/// Triangles of one object in scene coordinates.
using Corners = std::vector<std::array<Vec3f, 3>>;

/// A connected, nearly flat region of one object.
struct Facet {
  std::vector<std::uint32_t> triangles;
  Vec3d normal = Vec3d::UnitZ();  ///< of the grid's plane
  Vec3d axis = Vec3d::UnitX();    ///< along the longest boundary edge, in the plane
  Vec3d centre = Vec3d::Zero();
  double area = 0.0;   ///< of the triangles [m^2]
  bool clump = false;  ///< many tiny regions merged: always one element
};

struct FacetOptions {
  double cos_cone = 0.984807753;  ///< triangle normals against Facet::normal
  double max_height = 0.1;        ///< [m] corners above or below the plane
};

/// Grows facets over the half-edge adjacency of the triangles (corners at exactly the same place
/// are one vertex; where the surface is non-manifold it is cut open), and within a plane over
/// T-junctions, where edges meet part by part. Triangles without area or with corners that are not
/// finite belong to none.
[[nodiscard]] std::vector<Facet> grow_facets(const Corners& corners, const FacetOptions& options);

/// Merges facets smaller than cell^2 whose centres share a voxel of edge `voxel` and whose normals
/// point roughly the same way. For surfaces that consist of countless small parts (leaves).
[[nodiscard]] std::vector<Facet> merge_small_facets(std::vector<Facet> facets, double cell,
                                                    double voxel);

}  // namespace atrium::radiosity
