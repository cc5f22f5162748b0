#pragma once

#include <vector>

#include "fields.h"
#include "mesh.h"
#include "options.h"
#include "range.h"

namespace atrium::view {

/// Elements' values of a field with their areas.
/// \param both  if the side is the one that is seen: of both sides where both are known, else of
/// the
///              back only where the front is unknown.
/// \param polygons  by polygon: does it count?
[[nodiscard]] std::vector<Weighted> weighted_values(const Mesh& mesh, const Field& field,
                                                    ShownSide side, bool both,
                                                    const std::vector<std::uint8_t>& polygons);

}  // namespace atrium::view
