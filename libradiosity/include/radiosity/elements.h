#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh_io.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::radiosity {

struct ElementOptions {
  double element_size = 0.0;  ///< [m]; 0: from max_elements
  std::uint32_t max_elements = 60000;
  double normal_cone_deg = 10.0;  ///< a facet's normals lie within this angle of its mean
};

/// One convex piece of an element: the part of one triangle that lies in one grid cell.
struct ElementPiece {
  scene::ObjectId object;
  std::uint32_t triangle = 0;
  std::vector<Vec3f> corners;  ///< 3 or more, in the triangle's plane, its winding
  float area = 0.0f;
};

/// The elements of a scene: the look-up structure (a SurfaceField without values) and the pieces
/// that each element consists of.
struct Elements {
  scene::SurfaceField layout;
  std::vector<ElementPiece> pieces;
  std::vector<std::uint32_t> first_piece;  ///< element_count() + 1
};

/// Cuts the diffuse surfaces of a scene into elements. Surfaces that reflect and transmit nothing
/// diffusely get none. Half-edge adjacency by OpenMesh.
[[nodiscard]] Elements make_elements(const scene::Scene& scene, const ElementOptions& options = {});

/// The solution as polygons with the arrays of the mesh files (irradiance_direct, ..., radiosity).
[[nodiscard]] scene::PolygonMesh to_polygon_mesh(const scene::Scene& scene,
                                                 const Elements& elements,
                                                 const scene::SurfaceField& field,
                                                 const material::SpectralBasis& basis);

}  // namespace atrium::radiosity
