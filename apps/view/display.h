#pragma once

namespace atrium::view {

/// Asks before VTK does: it ends the process where no window can be had.
/// \throws RuntimeFailure  if DISPLAY is not set, cannot be opened, or cannot draw OpenGL.
void require_display();

}  // namespace atrium::view
