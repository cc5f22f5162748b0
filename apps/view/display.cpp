#include "display.h"

#include <X11/Xlib.h>

#include <cstdlib>
#include <string>

#include "material/error.h"

namespace atrium::view {

DisplayConnection::DisplayConnection() {
  const std::string hint = " (for --screenshot a virtual one does: xvfb-run -a atrium-view ...)";
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0')
    throw RuntimeFailure("no display: DISPLAY is not set" + hint);
  Display* const display = XOpenDisplay(name);
  if (display == nullptr)
    throw RuntimeFailure("no display: DISPLAY " + std::string(name) + " cannot be opened" + hint);
  connection_ = {display, [](void* d) { XCloseDisplay(static_cast<Display*>(d)); }};
  int opcode = 0, event = 0, error = 0;
  if (XQueryExtension(display, "GLX", &opcode, &event, &error) == 0)
    throw RuntimeFailure("no display: DISPLAY " + std::string(name) + " knows no OpenGL (GLX)");
}

}  // namespace atrium::view
