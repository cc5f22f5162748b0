#include "walk.h"

#include <cmath>

#include "frame_names.h"
#include "material/error.h"

namespace atrium::app {
namespace {

constexpr int kMostFrames = 1000000;

/// Frames at this rate from the first key's time up to the last one's.
int count_frames(const RenderCommand& c, const scene::CameraPath& path) {
  if (!(path.duration() > 0.0))
    throw Error("--fps: the keys of " + c.path + " have no times: give --frames");
  const double frames = std::floor(path.duration() * c.fps + 1e-9) + 1.0;
  if (!(frames <= kMostFrames)) throw Error("--fps: more than a million frames");
  return static_cast<int>(frames);
}

}  // namespace

Walk read_walk(const RenderCommand& c) {
  Walk walk{.path = scene::read_camera_path(c.path)};
  walk.frames = c.frames > 0 ? c.frames : count_frames(c, walk.path);
  if (c.fps > 0.0) walk.seconds = (walk.frames - 1) / c.fps;
  walk.last = walk.frames;
  if (!c.frame_range.empty()) {
    const auto [first, last] = parse_frame_range(c.frame_range, walk.frames);
    walk.first = first;
    walk.last = last;
  }
  return walk;
}

std::vector<ViewJob> walk_jobs(const Walk& walk, const Vec3d& origin) {
  const double end = walk.seconds > 0.0 ? walk.seconds / walk.path.duration() : 1.0;
  std::vector<ViewJob> jobs;
  jobs.reserve(static_cast<std::size_t>(walk.frames));
  for (int frame = 1; frame <= walk.frames; ++frame) {
    const double progress = walk.frames > 1 ? end * (frame - 1) / (walk.frames - 1) : 0.0;
    ViewJob job{walk.path.camera(progress), "frame " + std::to_string(frame), true, frame};
    job.camera.to_scene.pretranslate(-origin);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

std::string resume_text(const Walk& walk, int next) {
  const std::string range = std::to_string(next) + "-" + std::to_string(walk.last);
  return "frame " + std::to_string(next) + " of " + std::to_string(walk.frames) +
         " is the next: --frame-range " + range + " goes on with it";
}

}  // namespace atrium::app
