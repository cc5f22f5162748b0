#include "picture_radiosity.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "material/error.h"
#include "radiosity_pass.h"
#include "scene/solution_io.h"

namespace atrium::app {
namespace {

constexpr int kMostRefinements = 2;       // of a run
constexpr double kMostElements = 300000;  // of a finer solution
constexpr double kAim = 0.4;  // what the radiosity's error shall be of the one asked for

}  // namespace

bool uses_radiosity(const RenderCommand& c) { return c.method == trace::Method::Hybrid; }

PictureRadiosity::PictureRadiosity(Session& session, const RenderCommand& command,
                                   LoadedScene& loaded, Statistics& statistics)
    : session_(session),
      command_(command),
      settings_(command.solve),
      loaded_(loaded),
      statistics_(statistics) {
  for (material::SpectralBasis& basis : loaded.basis.packs())
    packs_.push_back({std::move(basis), {}});
  if (packs_.size() > 1) {
    const auto refuse = [&](const std::string& what) {
      throw Error(what + ", not " + std::to_string(loaded.basis.lanes()));
    };
    const std::string most = std::to_string(kMaxLanes);
    if (!(command.solution.empty() && command.save_solution.empty()))
      refuse("--spectrum: a solution file holds up to " + most + " lanes");
    if (!command.checkpoint.empty()) refuse("--checkpoint: holds up to " + most + " lanes");
    if (!command.preview.empty())
      throw Error("--preview: a picture of more than " + most + " bands is rendered in parts");
  }
  solve();
}

void PictureRadiosity::solve() {
  const material::SpectralBasis whole = loaded_.basis;
  const scene::RayTiming before = loaded_.query->timing();
  for (std::size_t i = 0; i < packs_.size(); ++i) {
    const double limit =
        time_share(session_, command_, 0.5 / static_cast<double>(packs_.size() - i));
    loaded_.basis = packs_[i].basis;
    packs_[i].field = {};  // memory for the next one
    packs_[i].field = find_field(limit);
  }
  loaded_.basis = whole;
  statistics_.timing_of_solving += loaded_.query->timing() - before;
  save();
}

scene::SurfaceField PictureRadiosity::find_field(double time_limit) {
  const auto skip = [&](const std::string& why) {
    session_.detail("skipped: radiosity: " + why);
    statistics_.radiosity_skipped = why;
  };
  if (!uses_radiosity(command_)) {
    skip("the method uses none");
    return {};
  }
  if (!command_.solution.empty()) {
    skip("read from " + command_.solution);
    return load_solution();
  }
  if (std::string why; !radiosity_needed(loaded_.features, why)) {
    skip(why);
    return {};
  }
  RadiosityRun run = run_radiosity(session_, loaded_, settings_, time_limit);
  statistics_.counters += run.summary.counters;
  run.summary.refinements = refinements_;
  if (statistics_.solve) run.summary.counters += statistics_.solve->counters;
  statistics_.solve = run.summary;
  return std::move(run.field);
}

scene::SurfaceField PictureRadiosity::load_solution() const {
  scene::Solution solution = scene::read_solution(command_.solution);
  scene::check_solution(solution, *loaded_.scene, describe_lanes(loaded_, settings_),
                        command_.solution);
  return std::move(solution.field);
}

void PictureRadiosity::save() const {
  if (command_.save_solution.empty()) return;
  const scene::SurfaceField& field = packs_.front().field;
  if (field.empty()) {
    session_.progress.warning(command_.save_solution + ": not written, nothing was solved");
    return;
  }
  session_.clock.enter("write");
  scene::write_solution({.field = field,
                         .groups = {},
                         .state = {},
                         .scene_hash = scene::hash_scene(*loaded_.scene),
                         .basis = describe_lanes(loaded_, settings_),
                         .options = describe(settings_)},
                        command_.save_solution);
  session_.progress.note("wrote " + command_.save_solution);
}

bool PictureRadiosity::may_refine() const {
  // Frames of a walk must not depend on which of them this run makes.
  return statistics_.solve && command_.path.empty() && settings_.error > 0.0 &&
         settings_.max_elements > 0 && refinements_ < kMostRefinements && !session_.interrupted();
}

double PictureRadiosity::field_expected() const {
  const bool as_planned = statistics_.solve && statistics_.solve->complete && settings_.error > 0.0;
  return as_planned ? kAim : std::numeric_limits<double>::infinity();
}

bool PictureRadiosity::refine(const trace::RenderResult& picture) {
  if (!may_refine()) return false;
  // The mesh's error goes as its elements do. What is certain of it counts: an estimate that is
  // too large would cost far more than another solution.
  const double factor = std::clamp(picture.field_excess / kAim, 2.0, 6.0);
  const double elements = std::min(factor * settings_.max_elements, kMostElements);
  ++refinements_;
  settings_.max_elements = std::max(settings_.max_elements, static_cast<std::uint32_t>(elements));
  settings_.error /= std::min(factor, 3.0);
  char text[160];
  std::snprintf(text, sizeof text,
                "the radiosity's own error is too large for this picture: solving again, to "
                "%.2g %% on about %u elements",
                100.0 * settings_.error, settings_.max_elements);
  session_.progress.note(text);
  solve();
  return true;
}

}  // namespace atrium::app
