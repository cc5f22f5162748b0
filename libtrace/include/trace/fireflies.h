#pragma once

#include <cstdint>

#include "scene/image.h"

namespace atrium::trace {

/// Pixels far brighter than what is around them: the luminance is above 5 times the median of the
/// other pixels of the 5x5 around. Lamps and highlights are such pixels, too.
///
/// A firefly is one by the chance of a few samples. Of a picture alone, with stderr.* layers: a
/// pixel that stands out, by more than its standard error but by less than 6 of them (a single
/// bright sample has about 5, as the layers are smoothed over 5x5 pixels; what all samples see has
/// more). 0 without these layers.
/// \throws std::invalid_argument  without R, G, B.
[[nodiscard]] std::uint64_t count_fireflies(const scene::Image& picture);

/// Where a reference knows better: pixels that stand out in the picture and not in the reference,
/// by more than both standard errors together where there are stderr.* layers.
/// \throws std::invalid_argument  without R, G, B or for other sizes.
[[nodiscard]] std::uint64_t count_fireflies(const scene::Image& picture,
                                            const scene::Image& reference);

}  // namespace atrium::trace
