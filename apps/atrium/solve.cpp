#include <algorithm>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "exports.h"
#include "material/error.h"
#include "radiosity_pass.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"
#include "statistics.h"

namespace atrium::app {

namespace {

bool is_solution(const std::string& file) { return scene::file_ending(file) == ".atrium"; }

/// Before hours of work: can everything be written that was asked for?
void check_outputs(const SolveCommand& c) {
  for (const std::string& file : c.outputs) {
    if (!is_solution(file) && !is_export(file))
      throw Error(file + ": unknown format (known: .vtp .vtu .glb .html .atrium)");
    if (is_export(file)) check_export(file);
    scene::check_output(file);
  }
  check_export_options(c.exports, c.outputs);
  if (!c.common.stats.empty()) scene::check_output(c.common.stats);
}

}  // namespace

int run_solve(const SolveCommand& c, std::stop_token stop) {
  check_outputs(c);
  if (!radiosity_available()) {
    throw RuntimeFailure(
        "solve: radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
  }
  Session session(c.common, std::move(stop));
  const LoadedScene loaded = load_scene(session, c.scene, {.memory_limit = c.solve.memory_limit});
  if (session.interrupted()) return kInterrupted;
  if (loaded.basis.lanes() > kMaxLanes)
    throw Error("--spectrum " + c.scene.spectrum + ": solve takes up to " +
                std::to_string(kMaxLanes) + " lanes");
  std::string why;
  if (!radiosity_needed(loaded.features, why)) throw Error("solve: nothing to solve: " + why);

  SolveSettings settings = c.solve;
  settings.keep_state = std::any_of(c.outputs.begin(), c.outputs.end(), is_solution);
  std::optional<scene::Solution> previous;
  if (!c.solution.empty()) {
    previous = scene::read_solution(c.solution);
    if (previous->state.empty())
      throw Error(c.solution +
                  ": keeps nothing to go on from (stopped too early, or not by solve)");
  }
  RadiosityRun run =
      run_radiosity(session, loaded, settings, c.solve.time_limit, previous ? &*previous : nullptr);

  if (c.solve.error > 0.0 && run.summary.stopped_by != "error")
    session.progress.warning("the error of " + std::to_string(100.0 * c.solve.error) +
                             " % was not reached: stopped by " + run.summary.stopped_by + " at " +
                             std::to_string(100.0 * run.summary.error_estimate) + " %");
  if (previous && run.summary.mesh_error > 1.1 * run.summary.mesh_error_target)
    session.progress.warning("the elements of " + c.solution +
                             " are too coarse for this light: their error is " +
                             std::to_string(100.0 * run.summary.mesh_error) + " %, not " +
                             std::to_string(100.0 * run.summary.mesh_error_target) + " %");
  if (run.summary.certificate) session.progress.note(describe(*run.summary.certificate));

  session.clock.enter("write");
  Statistics statistics;
  statistics.seed = c.solve.seed;
  statistics.solve = run.summary;
  statistics.counters = run.summary.counters;
  for (const std::string& file : c.outputs) {
    if (!is_solution(file)) continue;
    scene::write_solution({.field = run.field,
                           .groups = run.groups,
                           .state = run.state,
                           .scene_hash = scene::hash_scene(*loaded.scene),
                           .basis = describe_lanes(loaded, c.solve),
                           .options = describe(c.solve)},
                          file);
    session.progress.note("wrote " + file);
  }
  write_exports(session, {loaded, run.field, run.groups}, c.outputs, c.exports);
  write_statistics(session, loaded, statistics);
  return session.interrupted() ? kInterrupted : 0;
}

}  // namespace atrium::app
