#pragma once

#include <cstdint>
#include <vector>

#include "scene/shading.h"

namespace atrium::radiosity {

/// By object: is it a closed opaque body, so that a hit on its back means "inside a solid"? Bodies
/// whose inside light reaches directly are rooms, not solids: their inner faces take part. Decided
/// by the first surfaces that light from the sources meets.
template <int N>
[[nodiscard]] std::vector<std::uint8_t> closed_opaque_bodies(const scene::Shading<N>& shading);

}  // namespace atrium::radiosity
