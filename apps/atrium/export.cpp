#include "commands.h"
#include "exports.h"
#include "material/error.h"
#include "radiosity_pass.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"

namespace atrium::app {

namespace {

void check_outputs(const ExportCommand& c) {
  for (const std::string& file : c.outputs) {
    if (!is_export(file)) throw Error(file + ": unknown format (known: .vtp .vtu .glb .html)");
    check_export(file);
    scene::check_output(file);
  }
  check_export_options(c.exports, c.outputs);
}

}  // namespace

int run_export(const ExportCommand& c, std::stop_token stop) {
  check_outputs(c);
  if (!radiosity_available())
    throw RuntimeFailure(
        "export: radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
  scene::Solution solution = scene::read_solution(c.solution);
  Session session(c.common, std::move(stop));
  const LoadedScene loaded = load_scene(session, c.scene, {});
  if (session.interrupted()) return kInterrupted;
  SolveSettings settings;
  settings.paper_weights = c.paper_weights;
  scene::check_solution(solution, *loaded.scene, describe_lanes(loaded, settings), c.solution,
                        scene::Dimmed::Allowed);
  write_exports(session, {loaded, solution.field, solution.groups}, c.outputs, c.exports);
  return session.interrupted() ? kInterrupted : 0;
}

}  // namespace atrium::app
