#pragma once

#include <cstdint>
#include <vector>

#include "mesh.h"

namespace atrium::view {

/// By polygon: is it part of what covers a building? Horizontal or sloped by at most 60 degrees,
/// nothing more than 0.6 m above it, and something at least 1.5 m below. So slabs go with both of
/// their faces, table tops and the ground stay. By a map of heights over the plan, whichever way
/// faces are wound.
[[nodiscard]] std::vector<std::uint8_t> find_ceilings(const Mesh& mesh);
/// The same of polygons that are no part of the building's mesh, such as lamps below its ceilings.
[[nodiscard]] std::vector<std::uint8_t> find_ceilings(const Mesh& building, const Mesh& polygons);

}  // namespace atrium::view
