#pragma once

#include "trace/render.h"

namespace atrium::trace {

/// The pixels of the whole image that a crop keeps; at least one.
struct PixelWindow {
  int x0, y0, width, height;
};
[[nodiscard]] PixelWindow pixel_window(const RenderOptions& options);

}  // namespace atrium::trace
