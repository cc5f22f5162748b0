#include "frames.h"

#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>

#include "camera_rig.h"
#include "stage.h"

namespace atrium::view {
namespace {

/// "OpenGL renderer string:  llvmpipe (...)" of the window's report.
std::string renderer_name(vtkRenderWindow& window) {
  std::istringstream report(window.ReportCapabilities());
  const std::string wanted = "renderer string:";
  for (std::string line; std::getline(report, line);)
    if (const auto at = line.find(wanted); at != std::string::npos)
      return line.substr(line.find_first_not_of(' ', at + wanted.size()));
  return "unknown";
}

FrameTimes::Times orbit_once(Stage& stage, int frames) {
  using Clock = std::chrono::steady_clock;
  FrameTimes::Times times;
  stage.render();  // what is sent to the driver once does not count
  stage.window().WaitForCompletion();
  for (int i = 0; i < frames; ++i) {
    const auto start = Clock::now();
    orbit(*stage.renderer().GetActiveCamera(), 3.0, 0.0);
    stage.render();
    stage.window().WaitForCompletion();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    times.mean += seconds / frames;
    times.longest = std::max(times.longest, seconds);
  }
  return times;
}

}  // namespace

FrameTimes measure_frames(Stage& stage, int frames) {
  FrameTimes times;
  times.frames = frames;
  stage.renderer().UseFXAAOff();  // as in a window
  for (const bool moving : {true, false}) {
    stage.picture().moving(moving);
    (moving ? times.moving : times.at_rest) = orbit_once(stage, frames);
  }
  times.elements = stage.mesh().polygon_count();
  times.triangles = stage.picture().triangle_count();
  times.renderer = renderer_name(stage.window());
  return times;
}

std::string describe(const FrameTimes& t) {
  char line[320];
  std::snprintf(line, sizeof line,
                "%zu polygons, %zu triangles: moving %.1f frames/s (longest %.0f ms), at rest "
                "%.1f frames/s (longest %.0f ms), %s\n",
                t.elements, t.triangles, 1.0 / t.moving.mean, 1e3 * t.moving.longest,
                1.0 / t.at_rest.mean, 1e3 * t.at_rest.longest, t.renderer.c_str());
  return line;
}

}  // namespace atrium::view
