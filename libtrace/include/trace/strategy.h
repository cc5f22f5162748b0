#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace atrium::trace {

/// How the reference finds light.
struct PathStrategy {
  /// Paths from the lights as well as from the eye; otherwise from the eye alone.
  bool from_lights = false;
  std::string reason;  ///< one line
  /// Light that it cannot find, for people; empty: it finds all.
  std::vector<std::string> missing;
};

/// Paths from lights pay where something smooth (or nearly) deflects the light of lights that paths
/// from the eye meet never or hardly ever: without a size, the sun, lamps that are small or within
/// glass.
[[nodiscard]] PathStrategy choose_strategy(const scene::Scene& scene);

}  // namespace atrium::trace
