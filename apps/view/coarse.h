#pragma once

#include "mesh.h"
#include "triangles.h"

namespace atrium::view {

/// Fewer triangles over the same points, for what is drawn while it moves: points of one direction
/// in one cell of a grid become one of them, triangles that collapse go. Surfaces stay where they
/// are and keep their colours; rims get uneven by as much as a cell.
/// \param wanted  triangles, about; fewer than that stay as they are.
[[nodiscard]] Triangles coarsen(const Mesh& mesh, const Triangles& triangles, std::size_t wanted);

}  // namespace atrium::view
