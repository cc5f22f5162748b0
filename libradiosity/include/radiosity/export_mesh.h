#pragma once

#include <span>

#include "radiosity/elements.h"
#include "scene/light_groups.h"
#include "scene/mesh_io.h"

namespace atrium::radiosity {

/// The elements of a field that was stored, cut anew from the scene's triangles: for exports. Where
/// walls divide triangles, parts are other triangles than before over the same places.
/// \throws Error, std::invalid_argument  if the field does not lie on this scene.
[[nodiscard]] Elements elements_of_field(const scene::Scene& scene,
                                         const scene::SurfaceField& field);

/// The solution as polygons with the arrays of mesh files (docs/mesh_files.md).
///
/// Cells hold the elements' values, points those of the elements' corners (corners.h). No cracks
/// within an object: a place in the middle of a longer edge is a corner of that polygon, too.
/// Points are shared within a facet and where a smooth surface goes on in another one.
///
/// \param groups  of the field, or empty. Each adds arrays of its own, as dimmed by
/// GroupField::factor, named by the group (`irradiance.GROUP`; "_" for quotes, <, > and &); they
/// sum to those of the field. What a surface emits is in the group of its object, and dimmed like
/// it. \throws std::invalid_argument  if a group's arrays have another size than the field's, or
/// the field is not one of these elements.
[[nodiscard]] scene::PolygonMesh to_polygon_mesh(const scene::Scene& scene,
                                                 const Elements& elements,
                                                 const scene::SurfaceField& field,
                                                 const material::SpectralBasis& basis,
                                                 std::span<const scene::GroupField> groups = {});

}  // namespace atrium::radiosity
