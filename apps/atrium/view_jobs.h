#pragma once

#include <array>
#include <string>
#include <vector>

#include "options.h"
#include "session.h"

namespace atrium::app {

/// One picture to make.
struct ViewJob {
  scene::Camera camera;
  std::string label;  ///< camera's name or number, for messages and file names
  bool label_files = false;
  int frame = 0;  ///< of a walk, from 1; 0: none
};

/// The cameras asked for, or a view that is chosen.
[[nodiscard]] std::vector<ViewJob> camera_jobs(Session& session, const RenderCommand& c,
                                               const LoadedScene& loaded);

[[nodiscard]] std::array<int, 2> size_for(const RenderCommand& c, const scene::Camera& camera);

/// NAME.exr; NAME-camera.exr where one image per camera is written; NAME-0001.exr for a frame, or
/// with its number in place of %d, %04d.
[[nodiscard]] std::string file_for(const std::string& output, const ViewJob& job);

/// What a solution for these pictures alone must show; empty: it may be used for others. Of many
/// pictures some, evenly spread: each costs rays.
[[nodiscard]] std::vector<PictureView> views_of(const RenderCommand& c,
                                                const std::vector<ViewJob>& jobs);

}  // namespace atrium::app
