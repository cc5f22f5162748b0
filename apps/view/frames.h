#pragma once

#include <string>

namespace atrium::view {

class Stage;

struct FrameTimes {
  int frames = 0;
  double mean = 0.0, longest = 0.0;  ///< [s]
  std::size_t elements = 0, triangles = 0;
  std::string renderer;  ///< as OpenGL names itself
};

/// Draws an orbit of 3 degrees per frame, as a user who turns the mesh sees it.
[[nodiscard]] FrameTimes measure_frames(Stage& stage, int frames);
[[nodiscard]] std::string describe(const FrameTimes& times);

}  // namespace atrium::view
