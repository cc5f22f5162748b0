#pragma once

#include <memory>

namespace atrium::view {

/// A connection to the X display that VTK is going to use. To be held while windows come and go: a
/// virtual server starts anew when its last client leaves, and refuses whoever comes just then.
class DisplayConnection {
 public:
  /// Asks before VTK does: it ends the process where no window can be had.
  /// \throws RuntimeFailure  if DISPLAY is not set, cannot be opened, or cannot draw OpenGL.
  DisplayConnection();

 private:
  std::shared_ptr<void> connection_;
};

}  // namespace atrium::view
