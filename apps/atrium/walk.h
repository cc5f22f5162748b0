#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "scene/camera_path.h"
#include "view_jobs.h"

namespace atrium::app {

/// --path: which frames there are and which of them are asked for, from 1.
struct Walk {
  scene::CameraPath path;
  int frames = 1;
  double seconds = 0.0;  ///< that the frames span; 0: the path's own
  int first = 1, last = 1;
};

/// \throws Error  if the file is wrong, or does not fit --fps or --frame-range.
[[nodiscard]] Walk read_walk(const RenderCommand& c);

/// All frames, whichever are asked for. \param origin  of the scene in the world.
[[nodiscard]] std::vector<ViewJob> walk_jobs(const Walk& walk, const Vec3d& origin);

/// How to go on with the frames from `next` on; for people.
[[nodiscard]] std::string resume_text(const Walk& walk, int next);

}  // namespace atrium::app
