#pragma once

#include <cstdint>
#include <string>

#include "options.h"
#include "scene/features.h"
#include "scene/scene.h"

namespace atrium::app {

/// What both passes do for a picture.
struct PictureEffort {
  int samples = 0;      ///< of a pixel; with an error asked for the most
  bool spread = false;  ///< ... or the mean, more where the error is
  trace::Indirect indirect = trace::Indirect::Gather;
  std::string why;  ///< for people, one line
};

/// Effort of the picture that was asked for; sets what the solve shall do (`solve.error`,
/// `solve.max_elements`) if an error is asked for.
///
/// With --error the radiosity may be half as certain as the picture: gathering reads it behind a
/// bounce, where its errors average out, and sharing between pixels finds what it does not know.
/// Caustics are read where they are seen: with mirrors, solids or lobes it must be as certain as
/// the picture. Measured: docs/performance.md.
[[nodiscard]] PictureEffort plan_effort(RenderCommand& command, const scene::Scene& scene,
                                        const scene::Features& features);

}  // namespace atrium::app
