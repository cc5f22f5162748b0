#include "view_jobs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "frame_names.h"

namespace atrium::app {
namespace fs = std::filesystem;

namespace {

std::string view_text(const LoadedScene& loaded, const scene::Camera& camera) {
  const Vec3d eye = camera.to_scene.translation() + loaded.scene->origin;
  const Vec3d forward = -camera.to_scene.linear().col(2).normalized();
  char text[160];
  std::snprintf(text, sizeof text, "from (%.2f, %.2f, %.2f) m towards (%.2f, %.2f, %.2f)", eye.x(),
                eye.y(), eye.z(), forward.x(), forward.y(), forward.z());
  return text;
}

}  // namespace

std::vector<ViewJob> camera_jobs(Session& session, const RenderCommand& c,
                                 const LoadedScene& loaded) {
  std::vector<ViewJob> jobs;
  if (loaded.views.empty()) {
    const scene::Camera camera = scene::choose_interior_view(*loaded.scene, *loaded.query);
    session.progress.note("no camera in the scene: looking " + view_text(loaded, camera));
    return {{camera, "chosen", false, 0}};
  }
  std::set<std::string> used;
  for (const std::size_t i : loaded.views) {
    ViewJob job{loaded.scene->cameras[i], loaded.scene->cameras[i].name, c.camera == "all", 0};
    if (job.label.empty()) job.label = std::to_string(i);
    if (!used.insert(job.label).second) job.label += "-" + std::to_string(i);
    jobs.push_back(job);
  }
  if (c.camera.empty() && loaded.scene->cameras.size() > 1) {
    session.detail("camera: " + jobs[0].label + ", the first of " +
                   std::to_string(loaded.scene->cameras.size()));
  }
  return jobs;
}

std::array<int, 2> size_for(const RenderCommand& c, const scene::Camera& camera) {
  if (c.size) return *c.size;
  constexpr int kWidth = 640;
  double aspect = camera.aspect > 0.0 ? camera.aspect : 4.0 / 3.0;
  if (camera.kind == scene::Camera::Kind::Panorama && !(camera.aspect > 0.0)) aspect = 2.0;
  return {kWidth, static_cast<int>(std::clamp(std::lround(kWidth / aspect), 1L, 65536L))};
}

std::string file_for(const std::string& output, const ViewJob& job) {
  if (job.frame > 0) return frame_name(output, job.frame);
  if (!job.label_files) return output;
  std::string label = job.label;
  for (char& ch : label) {
    const auto u = static_cast<unsigned char>(ch);
    if (!std::isalnum(u) && ch != '-' && ch != '_' && ch != '.' && u < 0x80) ch = '_';
  }
  const fs::path path(output);
  return (path.parent_path() / (path.stem().string() + "-" + label + path.extension().string()))
      .string();
}

std::vector<PictureView> views_of(const RenderCommand& c, const std::vector<ViewJob>& jobs) {
  constexpr std::size_t kMost = 16;
  std::vector<PictureView> views;
  if (!c.save_solution.empty()) return views;
  const std::size_t count = c.path.empty() ? jobs.size() : std::min(jobs.size(), kMost);
  for (std::size_t k = 0; k < count; ++k) {
    const ViewJob& job = jobs[count > 1 ? k * (jobs.size() - 1) / (count - 1) : 0];
    const auto [width, height] = size_for(c, job.camera);
    views.push_back({job.camera, static_cast<double>(width) / height, c.crop});
  }
  return views;
}

}  // namespace atrium::app
