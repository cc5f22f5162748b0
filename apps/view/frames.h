#pragma once

#include <string>

namespace atrium::view {

class Stage;

struct FrameTimes {
  struct Times {
    double mean = 0.0, longest = 0.0;  ///< [s]
  };
  int frames = 0;
  Times moving;   ///< while the mouse is held
  Times at_rest;  ///< with all triangles
  std::size_t elements = 0, triangles = 0;
  std::string renderer;  ///< as OpenGL names itself
};

/// Draws an orbit of 3 degrees per frame, as it is seen while the mouse turns the mesh, and with
/// all triangles.
[[nodiscard]] FrameTimes measure_frames(Stage& stage, int frames);
[[nodiscard]] std::string describe(const FrameTimes& times);

}  // namespace atrium::view
