#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// Edges (pairs of points) between elements, each once. An element consists of a polygon per
/// triangle of the model; edges between polygons of one element are left out where the mesh has
/// "element_id".
/// \param shown  by polygon; empty: all.
[[nodiscard]] std::vector<std::array<std::uint32_t, 2>> element_edges(
    const Mesh& mesh, const std::vector<std::uint8_t>& shown = {});

}  // namespace atrium::view
