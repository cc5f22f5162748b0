#include "radiosity_pass.h"

#include "material/error.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "radiosity/coplanar.h"
#include "radiosity/solve.h"
#endif

namespace atrium::app {

bool radiosity_needed(const scene::Features& features, std::string& why) {
  if (!features.diffuse && !features.diffuse_transmission) {
    why = "no surface reflects or transmits light diffusely";
  } else if (!features.any_light()) {
    why = "nothing emits light";
  }
  return why.empty();
}

std::string describe_lanes(const LoadedScene& loaded, const SolveSettings& settings) {
  return loaded.basis.describe() + (settings.paper_weights ? ", paper mode" : "");
}

std::string describe(const SolveSettings& s) {
  const char* solver = s.solver == SolverChoice::Rows       ? "rows"
                       : s.solver == SolverChoice::Shooting ? "shooting"
                                                            : "matrix";
  const char* quality = s.quality == Quality::Draft    ? "draft"
                        : s.quality == Quality::Normal ? "normal"
                                                       : "high";
  return std::string("solver ") + solver + ", quality " + quality + ", seed " +
         std::to_string(s.seed);
}

#ifdef ATRIUM_WITH_RADIOSITY

namespace {

/// Work grows with the square of the elements where every pair of them counts; a matrix has at most
/// 3000 of their sides.
std::uint32_t most_elements(SolverChoice solver, const Effort& effort) {
  switch (solver) {
    case SolverChoice::Matrix:
      return std::min<std::uint32_t>(effort.max_elements / 30, 1300);
    case SolverChoice::Shooting:
      return effort.max_elements / 10;
    case SolverChoice::Rows:
      break;
  }
  return effort.max_elements;
}

radiosity::SolveOptions solve_options(const SolveSettings& settings, double time_limit) {
  const Effort effort = effort_of(settings.quality);
  radiosity::SolveOptions o;
  o.solver = settings.solver == SolverChoice::Rows       ? radiosity::Solver::Rows
             : settings.solver == SolverChoice::Shooting ? radiosity::Solver::Shooting
                                                         : radiosity::Solver::Matrix;
  o.max_elements =
      settings.max_elements > 0 ? settings.max_elements : most_elements(settings.solver, effort);
  o.row_rays = effort.row_rays;
  o.gather_rays = effort.gather_rays;
  o.direct_samples = effort.direct_samples;
  o.caustic_photons = effort.caustic_photons;
  o.seed = settings.seed;
  if (settings.keep_state)
    o.keep = settings.keep_rows ? radiosity::Keep::Rows : radiosity::Keep::Samples;
  o.light_groups = settings.light_groups;
  o.paper_weights = settings.paper_weights;
  o.time_limit = time_limit;
  o.memory_limit = static_cast<std::uint64_t>(1e6 * settings.memory_limit);
  o.error = settings.error;
  if (settings.solver == SolverChoice::Rows)
    for (const PictureView& v : settings.views) o.views.push_back({v.camera, v.aspect, v.crop});
  o.probes = settings.probes;
  return o;
}

ProbeSummary summarise(const radiosity::Certificate& c) {
  ProbeSummary s;
  s.probes = c.probes;
  s.target = c.target;
  s.bias = c.bias;
  s.bias_error = c.bias_error;
  s.rms = c.rms;
  s.rms_low = c.rms_low;
  s.rms_high = c.rms_high;
  s.largest = c.largest;
  s.noise = c.probe_noise;
  s.verdict = radiosity::verdict_name(c.verdict);
  s.not_sampled = c.not_sampled;
  s.rays = c.rays;
  return s;
}

SolveSummary summarise(const radiosity::SolveResult& r) {
  SolveSummary s;
  s.elements = r.field.element_count();
  s.iterations = r.iterations;
  s.residual = r.residual;
  s.error_estimate = r.error_estimate;
  s.mesh_error = r.mesh_error;
  s.mesh_error_target = r.mesh_target;
  s.complete = r.complete;
  s.stopped_by = r.stopped_by;
  s.emitted = r.flux.emitted;
  s.absorbed = r.flux.absorbed;
  s.escaped = r.flux.escaped;
  s.in_medium = r.flux.in_medium;
  s.flux_error = r.flux.standard_error;
  s.memory = {{"scene", r.memory.scene},       {"bvh", r.memory.bvh},
              {"elements", r.memory.elements}, {"samples", r.memory.samples},
              {"photons", r.memory.photons},   {"rows", r.memory.rows},
              {"fields", r.memory.fields},     {"peak", r.memory.peak}};
  s.counters = r.counters;
  return s;
}

}  // namespace

bool radiosity_available() { return true; }

std::optional<double> coplanar_share(const scene::Scene& scene) {
  return radiosity::coplanar_share(scene);
}

RadiosityRun run_radiosity(Session& session, const LoadedScene& loaded,
                           const SolveSettings& settings, double time_limit,
                           const scene::Solution* previous) {
  const radiosity::SolveOptions options = solve_options(settings, time_limit);
  const scene::Control control = session.control("radiosity");
  radiosity::SolveResult result =
      previous == nullptr ? radiosity::solve(*loaded.query, loaded.basis, options, control)
                          : radiosity::solve(*loaded.query, loaded.basis, options, control,
                                             radiosity::Previous{previous->field, previous->state});
  RadiosityRun run;
  run.summary = summarise(result);
  run.summary.views = static_cast<int>(options.views.size());
  if (settings.error > 0.0) run.summary.error_target = settings.error;
  for (const std::string& what : result.given_up) session.progress.warning("memory limit: " + what);
  if (settings.probes > 0) run.summary.certificate = summarise(result.certificate);
  run.field = std::move(result.field);
  run.groups = std::move(result.groups);
  run.state = std::move(result.state);
  session.clock.leave();
  session.detail("radiosity: " + std::to_string(run.summary.elements) + " elements, " +
                 std::to_string(run.summary.iterations) + " iterations, stopped by " +
                 run.summary.stopped_by);
  return run;
}

#else

bool radiosity_available() { return false; }

std::optional<double> coplanar_share(const scene::Scene&) { return std::nullopt; }

RadiosityRun run_radiosity(Session&, const LoadedScene&, const SolveSettings&, double,
                           const scene::Solution*) {
  throw RuntimeFailure("radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
}

#endif

}  // namespace atrium::app
