#pragma once

#include "scene/mesh.h"
#include "scene/scene.h"

namespace atrium::scene {

/// What a mesh's material means for its repair.
struct RepairRules {
  bool repair = true;  ///< false: only what ray queries could not stand is removed
  bool one_sided_emission = false;
  bool solid = false;  ///< inside and outside matter
};

/// Makes a mesh fit for ray queries and counts what was done. In this order: triangles with
/// non-finite corners go; triangles without area; exact twins; closed parts whose winding
/// contradicts itself are wound outwards; broken normals become geometric ones; unused vertices go.
/// Sets Mesh::closed. Vertices are welded to find neighbours only, never merged.
///
/// A triangle has no area if its height is within the rounding of its corners (one part in 2^23) or
/// below 1e-10 of its longest edge. Twins with opposite windings both stay where sides matter (a
/// one-sided emitter, a solid).
void repair_mesh(Mesh& mesh, const RepairRules& rules, LoadReport& report);

/// Adds the counts and warnings of one mesh to those of the scene.
void add_report(LoadReport& sum, const LoadReport& part);

}  // namespace atrium::scene
