#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

#include "commands.h"
#include "frame_names.h"
#include "material/error.h"
#include "picture_checkpoint.h"
#include "picture_pass.h"
#include "picture_radiosity.h"
#include "radiosity_pass.h"
#include "scene/image_io.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"
#include "statistics.h"
#include "trace/fireflies.h"
#include "trace/strategy.h"
#include "view_jobs.h"
#include "walk.h"

namespace atrium::app {
namespace fs = std::filesystem;

namespace {

/// Before hours of work: can everything be written that was asked for?
void check_outputs(const RenderCommand& c) {
  std::set<fs::path> seen;
  const auto check_image = [&](const std::string& file) {
    if (!scene::is_image_ending(file)) {
      throw Error(file + ": unknown image format (known: .exr .hdr .pfm .png .jpg)");
    }
    scene::check_output(file);
    if (!seen.insert(fs::weakly_canonical(fs::absolute(file))).second)
      throw Error(file + ": is given twice");
  };
  for (const std::string& output : c.outputs) {
    if (!c.path.empty()) check_frame_pattern(output);
    check_image(c.path.empty() ? output : frame_name(output, 1));
  }
  if (!c.preview.empty()) check_image(c.preview);
  if (!c.save_solution.empty()) {
    if (scene::file_ending(c.save_solution) != ".atrium") {
      throw Error(c.save_solution + ": a solution file ends with .atrium");
    }
    scene::check_output(c.save_solution);
  }
  if (!c.checkpoint.empty()) {
    scene::check_output(c.checkpoint);
    if (!seen.insert(fs::weakly_canonical(fs::absolute(c.checkpoint))).second)
      throw Error(c.checkpoint + ": is given twice");
  }
  if (!c.common.stats.empty()) scene::check_output(c.common.stats);
}

void add_metadata(scene::Image& image, const RenderCommand& c, const LoadedScene& loaded,
                  const trace::RenderResult& result) {
  const bool nits = loaded.scene->unit == scene::RadianceUnit::Nit;
  image.metadata["Software"] = std::string("atrium ") + ATRIUM_VERSION;
  image.metadata["atrium:command"] = c.common.command_line;
  image.metadata["atrium:seed"] = std::to_string(c.solve.seed);
  image.metadata["atrium:samples"] = std::to_string(result.samples_done);
  image.metadata["atrium:error"] = std::to_string(result.error_estimate);
  image.metadata["atrium:unit"] = nits ? "cd/m^2" : "W/(sr m^2)";
  image.metadata["atrium:spectrum"] = loaded.basis.describe();
  image.metadata["atrium:complete"] = result.complete ? "yes" : "no";
}

/// Everything the pictures of a run have in common.
struct Pictures {
  Session& session;
  const RenderCommand& command;
  const PictureEffort& effort;
  const LoadedScene& loaded;
  PictureRadiosity& radiosity;
  trace::ToneMapOptions tone;
};

/// The picture so far goes to --preview FILE.
std::function<void(const scene::Image&)> preview_of(const Pictures& p) {
  if (p.command.preview.empty()) return {};
  return [&p](const scene::Image& image) {
    const std::string& file = p.command.preview;
    scene::write_image(scene::is_display_ending(file) ? trace::tone_map(image, p.tone) : image,
                       file);
  };
}

ViewSummary summarise(const ViewJob& job, const trace::RenderResult& r) {
  return {.camera = job.label,
          .frame = job.frame,
          .width = r.image.width,
          .height = r.image.height,
          .samples = r.samples_done,
          .samples_mean = r.samples_mean,
          .rounds = r.rounds,
          .error_estimate = r.error_estimate,
          .bias_estimate = r.bias_estimate,
          .field_error_estimate = r.field_error_estimate,
          .block_error_estimate = r.block_error_estimate,
          .fireflies = trace::count_fireflies(r.image),
          .stopped_by = r.stopped_by,
          .complete = r.complete,
          .counters = r.counters,
          .files = {}};
}

/// Progress of one picture as a part of all of them.
scene::Control picture_control(Session& session, std::size_t number, std::size_t count,
                               const ViewJob& job) {
  scene::Control control = session.control("render");
  if (job.frame == 0) return control;
  control.progress = [&session, inner = control.progress, number, count, &job](
                         std::string_view phase, double fraction, std::string_view remark) {
    const double all = (static_cast<double>(number) + fraction) / static_cast<double>(count);
    inner(phase, all, job.label + (remark.empty() ? "" : ", " + std::string(remark)));
  };
  return control;
}

void write_picture(const Pictures& p, scene::Image& image, const ViewJob& job, ViewSummary& view) {
  for (const std::string& output : p.command.outputs) {
    const std::string file = file_for(output, job);
    scene::write_image(scene::is_display_ending(file) ? trace::tone_map(image, p.tone) : image,
                       file);
    view.files.push_back(file);
    p.session.progress.note("wrote " + file);
  }
}

/// \return false: a frame of a walk that was interrupted, which is not written.
bool render_view(const Pictures& p, const ViewJob& job, std::size_t number, std::size_t count,
                 Statistics& statistics) {
  const RenderCommand& c = p.command;
  trace::RenderOptions options = render_options(p.session, c, p.effort, job.camera);
  options.preview = preview_of(p);
  std::optional<PictureCheckpoint> checkpoint;
  if (!c.checkpoint.empty())
    checkpoint.emplace(p.session, c, p.loaded, job.camera, options).attach(options);
  const scene::Control control = picture_control(p.session, number, count, job);
  const double share = 1.0 / static_cast<double>(count - number);
  trace::RenderResult result;
  ViewSummary work;  // also of pictures that a finer solution makes again
  do {
    options.field_share = p.radiosity.field_share();
    options.field_expected = p.radiosity.field_expected();
    options.check_seed = static_cast<std::uint64_t>(p.radiosity.refinements());
    const Stopwatch watch;
    result = trace_packs(p.session, c, options, p.loaded, p.radiosity.packs(), job.camera, share,
                         control);
    work.wall += watch.wall();
    work.cpu += watch.cpu();
    work.counters += result.counters;
  } while (result.stopped_by == "radiosity" && p.radiosity.refine(result));
  ViewSummary view = summarise(job, result);
  view.wall = work.wall;
  view.cpu = work.cpu;
  view.counters = work.counters;
  statistics.counters += work.counters;
  if (job.frame > 0 && !result.complete && p.session.interrupted()) return false;
  p.session.clock.enter("write");
  add_metadata(result.image, c, p.loaded, result);
  if (statistics.solve)
    result.image.metadata["atrium:radiosity"] =
        statistics.solve->views > 0 ? "for the views of this run" : "of every surface";
  write_picture(p, result.image, job, view);
  p.session.detail(describe(view));
  if ((c.error > 0.0 || c.block_error > 0.0) && view.stopped_by == "samples")
    p.session.progress.warning("the error asked for is not reached with --samples " +
                               std::to_string(p.effort.samples) + ": " + describe(view));
  if (view.stopped_by == "radiosity")
    p.session.progress.warning(
        "the error asked for is not reached: the radiosity's own is larger, and samples do not "
        "lower it; solve to a smaller error first (atrium solve --error E -o FILE.atrium, then "
        "--solution FILE.atrium) or use --method path: " +
        describe(view));
  statistics.views.push_back(std::move(view));
  return true;
}

/// All pictures that are asked for, or up to an interrupt.
void render_views(const Pictures& p, const std::vector<ViewJob>& jobs, Statistics& statistics) {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (i > 0 && p.session.interrupted()) break;
    (void)render_view(p, jobs[i], i, jobs.size(), statistics);
  }
}

void render_walk(Pictures p, const Walk& walk, const std::vector<ViewJob>& frames,
                 Statistics& statistics) {
  Session& session = p.session;
  const bool tone_mapped =
      std::any_of(p.command.outputs.begin(), p.command.outputs.end(), scene::is_display_ending) ||
      scene::is_display_ending(p.command.preview);
  if (!p.tone.ev && tone_mapped && !session.interrupted()) {
    p.tone.ev = walk_exposure(session, p.command, p.effort, p.loaded, p.radiosity.packs(), frames,
                              statistics.counters);
    char text[64];
    std::snprintf(text, sizeof text, "exposure of all frames: --exposure %.4f", *p.tone.ev);
    session.progress.note(text);
  }
  statistics.walk = WalkSummary{walk.frames, walk.first, walk.last, p.tone.ev};
  const int number = walk.last - walk.first + 1;
  const auto count = static_cast<std::size_t>(number);
  for (std::size_t i = 0; i < count; ++i) {
    const int frame = walk.first + static_cast<int>(i);
    if (!session.interrupted() &&
        render_view(p, frames[static_cast<std::size_t>(frame - 1)], i, count, statistics))
      continue;
    session.progress.warning("interrupted: " + resume_text(walk, frame));
    return;
  }
}

/// How the reference finds light, and what of it it does not.
void explain_reference(Session& session, const RenderCommand& c, const LoadedScene& loaded,
                       Statistics& statistics) {
  if (c.method != trace::Method::Path) return;
  statistics.reference = trace::choose_strategy(*loaded.scene);
  const trace::PathStrategy& s = *statistics.reference;
  session.detail((s.from_lights ? "needed:  " : "skipped: ") + std::string("paths from lights: ") +
                 s.reason);
  for (const std::string& m : s.missing) session.progress.warning("not in the picture: " + m);
}

void warn_about_counts(Session& session, const scene::Counters& counters) {
  if (const auto n = counters[scene::Counter::SamplesDropped]; n > 0) {
    session.progress.warning(std::to_string(n) + " samples were not finite and were dropped");
  }
  if (const auto n = counters[scene::Counter::RaysRefused]; n > 0) {
    session.progress.warning(std::to_string(n) + " rays were not finite and were not traced");
  }
}

}  // namespace

int run_render(const RenderCommand& c, std::stop_token stop) {
  check_outputs(c);
  if (uses_radiosity(c) && c.solution.empty() && !radiosity_available()) {
    throw RuntimeFailure(
        "--method hybrid: radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off); "
        "--method path and direct are");
  }
  for (const std::string& file : c.scene.files) {
    if (!fs::exists(file)) throw Error(file + ": cannot be read: no such file");
  }
  // Where nothing but .pfm is written, only textures need the module; they load it.
  if (std::any_of(c.outputs.begin(), c.outputs.end(),
                  [](const std::string& file) { return scene::file_ending(file) != ".pfm"; }))
    scene::preload_image_io();
  Session session(c.common, std::move(stop));
  Statistics statistics;
  statistics.seed = c.solve.seed;

  std::optional<Walk> walk;
  if (!c.path.empty()) walk = read_walk(c);
  // A solution must fit whatever camera comes later, so the mesh must not depend on this one.
  const bool own_mesh = c.solution.empty() && c.save_solution.empty() && !walk;
  LoadedScene loaded = load_scene(
      session, c.scene,
      {.camera = c.camera, .follow_view = own_mesh, .memory_limit = c.solve.memory_limit});
  if (session.interrupted()) return kInterrupted;
  const std::vector<ViewJob> jobs =
      walk ? walk_jobs(*walk, loaded.scene->origin) : camera_jobs(session, c, loaded);
  RenderCommand with_views = c;
  const PictureEffort effort = plan_effort(with_views, *loaded.scene, loaded.features);
  if (!effort.why.empty()) session.detail(effort.why);
  explain_reference(session, c, loaded, statistics);
  statistics.picture_target = c.error;
  statistics.block_target = c.block_error;
  with_views.solve.views = views_of(c, jobs);
  PictureRadiosity radiosity(session, with_views, loaded, statistics);
  const Pictures pictures{session, c, effort, loaded, radiosity, c.tone};
  if (walk)
    render_walk(pictures, *walk, jobs, statistics);
  else
    render_views(pictures, jobs, statistics);
  warn_about_counts(session, statistics.counters);
  write_statistics(session, loaded, statistics);
  return session.interrupted() ? kInterrupted : 0;
}

}  // namespace atrium::app
