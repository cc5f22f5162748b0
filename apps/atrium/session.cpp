#include "session.h"

#include <algorithm>
#include <charconv>

#include "material/error.h"
#include "scene/scene_io.h"

namespace atrium::app {

Session::Session(const CommonOptions& options, std::stop_token stop)
    : progress(options.quiet),
      options_(options),
      stop_(std::move(stop)),
      threads_(options.threads) {}

namespace {

/// The radiosity pass names its stages in remarks; two of them are timed as phases of their own.
std::string_view timed_phase(const std::string& phase, std::string_view remark) {
  if (phase == "radiosity" && remark == "elements") return "mesh";
  if (phase == "radiosity" && remark == "direct light") return "direct";
  return phase;
}

}  // namespace

scene::Control Session::control(const std::string& phase) {
  clock.enter(phase);
  scene::Control control;
  control.stop = stop_;
  control.progress = [this, phase](std::string_view part, double fraction,
                                   std::string_view remark) {
    clock.enter(timed_phase(phase, remark));
    progress.report(part, fraction, remark);
  };
  return control;
}

void Session::detail(const std::string& line) {
  if (options_.verbose) progress.note(line);
}

namespace {

std::string camera_list(const std::vector<scene::Camera>& cameras) {
  std::string list;
  for (std::size_t i = 0; i < cameras.size() && i < 20; ++i) {
    list += (i == 0 ? "" : ", ") + std::to_string(i);
    if (!cameras[i].name.empty()) list += " \"" + cameras[i].name + "\"";
  }
  return cameras.size() > 20 ? list + ", ..." : list;
}

constexpr std::size_t kWarningsShown = 10;

void show_warnings(Progress& progress, const std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < std::min(kWarningsShown, warnings.size()); ++i) {
    progress.warning(warnings[i]);
  }
  if (warnings.size() > kWarningsShown) {
    progress.warning(std::to_string(warnings.size() - kWarningsShown) +
                     " more warnings; atrium info lists them");
  }
}

}  // namespace

std::vector<std::size_t> select_cameras(const std::string& request,
                                        const std::vector<scene::Camera>& cameras) {
  if (request.empty())
    return cameras.empty() ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
  if (cameras.empty()) throw Error("--camera " + request + ": the scene has no cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].name == request) return {i};
  }
  std::vector<std::size_t> all(cameras.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  if (request == "all") return all;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(request.data(), request.data() + request.size(), index);
  if (error == std::errc() && end == request.data() + request.size() && index < cameras.size()) {
    return {index};
  }
  throw Error("--camera " + request + ": unknown; the scene has " + camera_list(cameras));
}

LoadedScene load_scene(Session& session, const SceneOptions& options,
                       const LoadSettings& settings) {
  session.clock.enter("load");
  session.progress.report("load", 0.0, {});
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  const auto memory_limit = static_cast<std::uint64_t>(1e6 * settings.memory_limit);
  scene::Model model = scene::read_model(
      files,
      {.emissive_nits_per_unit = options.nits_per_emissive_unit, .memory_limit = memory_limit});

  LoadedScene loaded;
  loaded.views = select_cameras(settings.camera, model.cameras);
  scene::BuildOptions build;
  build.pane_detection = options.pane_detection;
  build.memory_limit = memory_limit;
  if (settings.follow_view && loaded.views.size() == 1) build.view = model.cameras[loaded.views[0]];
  loaded.scene = std::make_unique<scene::Scene>(scene::build_scene(std::move(model), build));
  if (settings.show_warnings) show_warnings(session.progress, loaded.scene->report.warnings);

  loaded.query = std::make_unique<scene::RayQuery>(*loaded.scene);
  loaded.features = scene::find_features(*loaded.scene);
  scene::BasisChoice choice = scene::choose_basis(*loaded.scene, loaded.features, options.spectrum);
  loaded.basis = std::move(choice.basis);
  loaded.basis_reason = std::move(choice.reason);
  if (!choice.within_bound && settings.show_warnings)
    session.progress.warning("colours are not within the bound: " + loaded.basis.describe() + ", " +
                             loaded.basis_reason);
  session.progress.report("load", 1.0, {});
  session.detail("scene: " + std::to_string(loaded.scene->triangle_count()) + " triangles in " +
                 std::to_string(loaded.scene->objects.size()) + " objects");
  session.detail("spectrum: " + loaded.basis.describe() + ": " + loaded.basis_reason);
  for (const scene::Decision& d : scene::decide(loaded.features)) {
    session.detail((d.needed ? "needed:  " : "skipped: ") + d.what + ": " + d.reason);
  }
  session.clock.leave();
  return loaded;
}

}  // namespace atrium::app
