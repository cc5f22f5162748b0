#include "picture_checkpoint.h"

#include <cstdio>
#include <filesystem>

#include "scene/solution_io.h"
#include "trace/strategy.h"

namespace atrium::app {
namespace {

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string text_of(const scene::Camera& c) {
  std::string text =
      std::to_string(static_cast<int>(c.kind)) + " " + text_of(c.yfov) + " " + text_of(c.height);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) text += " " + text_of(c.to_scene(row, column));
  return text;
}

std::string text_of(bool on) { return on ? "on" : "off"; }

/// All that decides about samples: nothing that says how many.
std::vector<std::pair<std::string, std::string>> made_with(const LoadedScene& loaded,
                                                           const scene::Camera& camera,
                                                           const trace::RenderOptions& o) {
  std::string crop;
  for (const double x : o.crop) crop += (crop.empty() ? "" : ",") + text_of(x);
  return {{"version", ATRIUM_VERSION},
          {"spectrum", loaded.basis.describe()},
          {"camera", text_of(camera)},
          {"size", std::to_string(o.width) + "x" + std::to_string(o.height)},
          {"crop", crop},
          {"seed", std::to_string(o.seed)},
          {"--components", text_of(o.components)},
          {"--classes", text_of(o.classes)}};
}

}  // namespace

PictureCheckpoint::PictureCheckpoint(Session& session, const RenderCommand& command,
                                     const LoadedScene& loaded, const scene::Camera& camera,
                                     const trace::RenderOptions& options)
    : file_(command.checkpoint) {
  now_.scene_hash = scene::hash_scene(*loaded.scene);
  now_.made_with = made_with(loaded, camera, options);
  if (!std::filesystem::exists(file_)) return;
  kept_ = scene::read_checkpoint(file_);
  scene::check_checkpoint(*kept_, now_, file_);
  session.progress.note("goes on from " + file_);
}

void PictureCheckpoint::attach(trace::RenderOptions& options) {
  if (kept_) options.state = &kept_->state;
  options.save_state = [this](const std::vector<char>& state) {
    now_.state = state;
    scene::write_checkpoint(now_, file_);
  };
}

}  // namespace atrium::app
