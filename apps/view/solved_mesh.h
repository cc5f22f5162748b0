#pragma once

#include <functional>
#include <span>

#include "loaded_scene.h"
#include "mesh.h"
#include "radiosity/solve.h"

namespace atrium::view {

/// A solution as a mesh with names and, if there are several light groups, their arrays
/// (find_group_array()). Lamps belong to the group that their light is in.
[[nodiscard]] Mesh mesh_of(const LoadedScene& loaded, const radiosity::Elements& elements,
                           const scene::SurfaceField& field,
                           std::span<const scene::GroupField> groups);

/// How a scene is solved for being looked at.
[[nodiscard]] radiosity::SolveOptions solve_options(const SolveChoice& choice);

}  // namespace atrium::view
