#pragma once

#include <optional>
#include <vector>

#include "colours.h"
#include "scene/baked_model.h"

namespace atrium::view {

/// Colours of the corners of a thing without elements, or of the sky.
/// \param factors  of light groups; other than the model has: all 1.
/// \param ev  exposure of true colours; absent: white where something shines.
[[nodiscard]] std::vector<Colour> plain_colours(const scene::BakedModel& model,
                                                const scene::BakedModel::Primitive& primitive,
                                                const std::vector<double>& factors,
                                                const std::optional<double>& ev);

}  // namespace atrium::view
