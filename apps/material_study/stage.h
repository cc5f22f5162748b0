#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace atrium::study {

/// What is rendered: one object of the material in question.
enum class Stage {
  Sphere,  ///< on a chequered floor under two area lights and a grey sky
  Box,     ///< likewise
  Room     ///< a sphere in a room with coloured walls and a lamp under its ceiling
};
[[nodiscard]] const char* name_of(Stage stage);
inline constexpr Stage kStages[] = {Stage::Sphere, Stage::Box, Stage::Room};

/// A scene with a camera; the object is its first.
[[nodiscard]] scene::Model make_stage(Stage stage, const material::Material& material);

/// The exposure of all pictures of a stage: they can be compared.
[[nodiscard]] double exposure_of(Stage stage);

}  // namespace atrium::study
