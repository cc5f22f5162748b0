#pragma once

#include <optional>

#include "options.h"
#include "scene/checkpoint_io.h"
#include "session.h"

namespace atrium::app {

/// The file of --checkpoint: what it holds goes on, what is traced goes there.
class PictureCheckpoint {
 public:
  /// Reads the file if there is one. \throws Error  if it is of another picture.
  PictureCheckpoint(Session& session, const RenderCommand& command, const LoadedScene& loaded,
                    const scene::Camera& camera, const trace::RenderOptions& options);
  /// Sets what RenderOptions have of it; they must not outlive this.
  void attach(trace::RenderOptions& options);

 private:
  std::string file_;
  scene::Checkpoint now_;
  std::optional<scene::Checkpoint> kept_;
};

}  // namespace atrium::app
