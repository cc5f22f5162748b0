#pragma once

#include <cstddef>

#include "scene/parallel.h"

namespace atrium::trace {

/// pixel(x, y, number) for every pixel of a picture, rows in parallel.
template <class F>
void for_pixels(int width, int height, F&& pixel) {
  scene::parallel_for(static_cast<std::size_t>(height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      std::size_t i = y * static_cast<std::size_t>(width);
      for (int x = 0; x < width; ++x, ++i) pixel(x, static_cast<int>(y), i);
    }
  });
}

}  // namespace atrium::trace
