#include "trace/packs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "commands.h"
#include "material/error.h"
#include "picture_effort.h"
#include "radiosity_pass.h"
#include "scene/image_io.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"
#include "statistics.h"

namespace atrium::app {
namespace fs = std::filesystem;

namespace {

/// One picture to make.
struct ViewJob {
  scene::Camera camera;
  std::string label;  ///< camera's name or number, for messages and file names
  bool label_files = false;
};

/// Before hours of work: can everything be written that was asked for?
void check_outputs(const RenderCommand& c) {
  std::set<fs::path> seen;
  for (const std::string& file : c.outputs) {
    if (!scene::is_image_ending(file)) {
      throw Error(file + ": unknown image format (known: .exr .hdr .pfm .png .jpg)");
    }
    scene::check_output(file);
    if (!seen.insert(fs::weakly_canonical(fs::absolute(file))).second)
      throw Error(file + ": is given twice");
  }
  if (!c.save_solution.empty()) {
    if (scene::file_ending(c.save_solution) != ".atrium") {
      throw Error(c.save_solution + ": a solution file ends with .atrium");
    }
    scene::check_output(c.save_solution);
  }
  if (!c.common.stats.empty()) scene::check_output(c.common.stats);
}

bool uses_radiosity(const RenderCommand& c) { return c.method == trace::Method::Hybrid; }

std::string view_text(const LoadedScene& loaded, const scene::Camera& camera) {
  const Vec3d eye = camera.to_scene.translation() + loaded.scene->origin;
  const Vec3d forward = -camera.to_scene.linear().col(2).normalized();
  char text[160];
  std::snprintf(text, sizeof text, "from (%.2f, %.2f, %.2f) m towards (%.2f, %.2f, %.2f)", eye.x(),
                eye.y(), eye.z(), forward.x(), forward.y(), forward.z());
  return text;
}

std::vector<ViewJob> view_jobs(Session& session, const RenderCommand& c,
                               const LoadedScene& loaded) {
  std::vector<ViewJob> jobs;
  if (loaded.views.empty()) {
    const scene::Camera camera = scene::choose_interior_view(*loaded.scene, *loaded.query);
    session.progress.note("no camera in the scene: looking " + view_text(loaded, camera));
    return {{camera, "chosen", false}};
  }
  std::set<std::string> used;
  for (const std::size_t i : loaded.views) {
    ViewJob job{loaded.scene->cameras[i], loaded.scene->cameras[i].name, c.camera == "all"};
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

/// Seconds that a stage may use: its share of what is left; 0 means no limit was asked for.
double time_share(const Session& session, const RenderCommand& c, double share) {
  if (!(c.solve.time_limit > 0.0)) return 0.0;
  constexpr double kLeast = 1e-3;  // a limit that has passed is still a limit, not "none"
  return std::max(kLeast, (c.solve.time_limit - session.clock.elapsed()) * share);
}

scene::SurfaceField load_solution(const RenderCommand& c, const LoadedScene& loaded) {
  scene::Solution solution = scene::read_solution(c.solution);
  scene::check_solution(solution, *loaded.scene, describe_lanes(loaded, c.solve), c.solution);
  return std::move(solution.field);
}

/// The field that the picture reads; empty if none is needed.
scene::SurfaceField find_field(Session& session, const RenderCommand& c, const LoadedScene& loaded,
                               double time_limit, Statistics& statistics) {
  std::string why;
  if (!uses_radiosity(c)) {
    why = "the method uses none";
  } else if (!c.solution.empty()) {
    why = "read from " + c.solution;
    session.detail("skipped: radiosity: " + why);
    statistics.radiosity_skipped = why;
    return load_solution(c, loaded);
  } else {
    (void)radiosity_needed(loaded.features, why);
  }
  if (!why.empty()) {
    session.detail("skipped: radiosity: " + why);
    statistics.radiosity_skipped = why;
    return {};
  }
  RadiosityRun run = run_radiosity(session, loaded, c.solve, time_limit);
  statistics.solve = run.summary;
  statistics.counters += run.summary.counters;
  return std::move(run.field);
}

void save_solution(Session& session, const RenderCommand& c, const LoadedScene& loaded,
                   const scene::SurfaceField& field) {
  if (c.save_solution.empty()) return;
  if (field.empty()) {
    session.progress.warning(c.save_solution + ": not written, nothing was solved");
    return;
  }
  session.clock.enter("write");
  scene::write_solution({.field = field,
                         .groups = {},
                         .state = {},
                         .scene_hash = scene::hash_scene(*loaded.scene),
                         .basis = describe_lanes(loaded, c.solve),
                         .options = describe(c.solve)},
                        c.save_solution);
  session.progress.note("wrote " + c.save_solution);
}

trace::RenderOptions render_options(const Session& session, const RenderCommand& c,
                                    const PictureEffort& effort, const scene::Camera& camera,
                                    double time_limit) {
  trace::RenderOptions o;
  o.method = c.method;
  o.mode = c.mode;
  o.indirect = effort.indirect;
  // After an interrupt the picture is one cheap sample of what was solved until then.
  if (session.interrupted()) o.indirect = trace::Indirect::Mesh;
  const auto [width, height] = size_for(c, camera);
  o.width = width;
  o.height = height;
  o.crop = c.crop;
  o.samples = effort.samples;
  o.error = c.error;
  o.block_error = c.block_error;
  o.time_limit = time_limit;
  o.seed = c.solve.seed;
  o.components = c.components;
  o.share_samples = !c.no_filter;
  return o;
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

/// NAME.exr, or NAME-camera.exr where one image per camera is written.
std::string file_for(const std::string& output, const ViewJob& job) {
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

/// What one pack of wavelength bands needs; a scene of up to kMaxLanes lanes is one pack.
struct Pack {
  material::SpectralBasis basis;
  scene::SurfaceField field;
};

/// A solution for these pictures alone may leave out what they do not show.
std::vector<PictureView> views_of(const RenderCommand& c, const std::vector<ViewJob>& jobs) {
  std::vector<PictureView> views;
  if (!c.save_solution.empty()) return views;
  for (const ViewJob& job : jobs) {
    const auto [width, height] = size_for(c, job.camera);
    views.push_back({job.camera, static_cast<double>(width) / height, c.crop});
  }
  return views;
}

std::vector<Pack> solve_packs(Session& session, const RenderCommand& c, LoadedScene& loaded,
                              Statistics& statistics) {
  const material::SpectralBasis whole = loaded.basis;
  std::vector<Pack> packs;
  for (material::SpectralBasis& basis : whole.packs()) packs.push_back({std::move(basis), {}});
  if (packs.size() > 1 && !(c.solution.empty() && c.save_solution.empty()))
    throw Error("--spectrum: a solution file holds up to " + std::to_string(kMaxLanes) +
                " lanes, not " + std::to_string(whole.lanes()));
  for (std::size_t i = 0; i < packs.size(); ++i) {
    const double limit = time_share(session, c, 0.5 / static_cast<double>(packs.size() - i));
    loaded.basis = packs[i].basis;
    packs[i].field = find_field(session, c, loaded, limit, statistics);
  }
  loaded.basis = whole;
  return packs;
}

trace::RenderResult trace_packs(Session& session, const RenderCommand& c,
                                const PictureEffort& effort, const LoadedScene& loaded,
                                const std::vector<Pack>& packs, const ViewJob& job, double share) {
  trace::RenderResult result;
  for (std::size_t i = 0; i < packs.size(); ++i) {
    const double limit = time_share(session, c, share / static_cast<double>(packs.size() - i));
    const trace::RenderOptions options = render_options(session, c, effort, job.camera, limit);
    trace::RenderResult part = trace::render(*loaded.query, packs[i].basis, job.camera,
                                             packs[i].field, options, session.control("render"));
    if (i == 0)
      result = std::move(part);
    else
      trace::add_pack(result, part);
  }
  return result;
}

ViewSummary summarise(const ViewJob& job, const trace::RenderResult& r) {
  return {.camera = job.label,
          .width = r.image.width,
          .height = r.image.height,
          .samples = r.samples_done,
          .samples_mean = r.samples_mean,
          .rounds = r.rounds,
          .error_estimate = r.error_estimate,
          .bias_estimate = r.bias_estimate,
          .block_error_estimate = r.block_error_estimate,
          .stopped_by = r.stopped_by,
          .complete = r.complete,
          .files = {}};
}

void render_view(Session& session, const RenderCommand& c, const PictureEffort& effort,
                 const LoadedScene& loaded, const std::vector<Pack>& packs, const ViewJob& job,
                 double share, Statistics& statistics) {
  trace::RenderResult result = trace_packs(session, c, effort, loaded, packs, job, share);
  statistics.counters += result.counters;
  session.clock.enter("write");
  add_metadata(result.image, c, loaded, result);
  if (statistics.solve)
    result.image.metadata["atrium:radiosity"] =
        statistics.solve->views > 0 ? "for the views of this run" : "of every surface";
  ViewSummary view = summarise(job, result);
  for (const std::string& output : c.outputs) {
    const std::string file = file_for(output, job);
    scene::write_image(
        scene::is_display_ending(file) ? trace::tone_map(result.image, c.tone) : result.image,
        file);
    view.files.push_back(file);
    session.progress.note("wrote " + file);
  }
  session.detail(describe(view));
  if ((c.error > 0.0 || c.block_error > 0.0) && view.stopped_by == "samples")
    session.progress.warning("the error asked for is not reached with --samples " +
                             std::to_string(effort.samples) + ": " + describe(view));
  statistics.views.push_back(std::move(view));
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

  // A solution must fit whatever camera comes later, so the mesh must not depend on this one.
  const bool own_mesh = c.solution.empty() && c.save_solution.empty();
  LoadedScene loaded = load_scene(
      session, c.scene, {.camera = c.camera, .follow_view = own_mesh, .show_warnings = true});
  if (session.interrupted()) return kInterrupted;
  const std::vector<ViewJob> jobs = view_jobs(session, c, loaded);
  RenderCommand with_views = c;
  const PictureEffort effort = plan_effort(with_views, *loaded.scene, loaded.features);
  if (!effort.why.empty()) session.detail(effort.why);
  if (!effort.caution.empty()) session.progress.warning(effort.caution);
  statistics.picture_target = c.error;
  statistics.block_target = c.block_error;
  with_views.solve.views = views_of(c, jobs);
  const std::vector<Pack> packs = solve_packs(session, with_views, loaded, statistics);
  save_solution(session, c, loaded, packs.front().field);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (i > 0 && session.interrupted()) break;
    render_view(session, c, effort, loaded, packs, jobs[i],
                1.0 / static_cast<double>(jobs.size() - i), statistics);
  }
  warn_about_counts(session, statistics.counters);
  write_statistics(session, loaded, statistics);
  return session.interrupted() ? kInterrupted : 0;
}

}  // namespace atrium::app
