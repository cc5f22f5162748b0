#include "run.h"

#include <vtkObject.h>

#include <cstdio>
#include <optional>

#include "common/progress.h"
#include "display.h"
#include "document.h"
#include "frames.h"
#include "material/error.h"
#include "plain_things.h"
#include "scene/parallel.h"
#include "stage.h"
#include "statistics.h"
#include "weighted_values.h"
#include "window.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "live_solve.h"
#endif

namespace atrium::view {
namespace {

constexpr int kInterrupted = 130;

void print_statistics(const ViewCommand& c, Mesh& mesh) {
  const PictureState state = initial_state(c.look, mesh);
  const Weights weights = initial_weights(c.look, mesh);
  if (!weights.as_solved()) weights.apply(mesh);
  const std::vector<Field> fields = fields_of(mesh);
  if (fields.empty()) throw Error("--statistics: the mesh has no arrays");
  const Selection which = parse_selection("--statistics", c.statistics, mesh);
  const Field& field = fields[state.field];
  const Statistics s =
      make_statistics(weighted_values(mesh, field, state.side, false, selected(mesh, which)));
  std::fputs(to_json(s, field.title, describe(mesh, which)).c_str(), stdout);
}

#ifdef ATRIUM_WITH_RADIOSITY

/// The scene in a window while it is solved.
void watch_solve(const ViewCommand& c, std::stop_token stop,
                 const std::function<void(const std::string&)>& warn) {
  LoadedScene loaded = load_scene(c.files, c.solve);
  warn_of_scene(*loaded.scene, warn);
  require_light(loaded);
  Document document{bare_mesh(loaded), loaded.views, c.files.front(), {}};
  const scene::LightGroups groups = scene::find_light_groups(*loaded.scene, c.solve.groups);
  document.things = plain_things(loaded, document.mesh, groups_named(*loaded.scene, groups.names));
  add_standard_views(document.mesh, static_cast<double>(c.size[0]) / c.size[1], document.views);
  Window window(std::move(document), c, std::make_unique<LiveSolve>(std::move(loaded), c.solve));
  window.run(std::move(stop));
}

#else

void watch_solve(const ViewCommand&, std::stop_token,
                 const std::function<void(const std::string&)>&) {
  throw RuntimeFailure("radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
}

#endif

}  // namespace

int run_view(const ViewCommand& c, const std::stop_token& stop) {
  vtkObject::GlobalWarningDisplayOff();  // errors come back as our own
  app::Progress progress(c.quiet);
  const scene::ThreadLimit threads(c.threads);
  const bool window_needed = c.statistics.empty() || !c.screenshot.empty();
  std::optional<DisplayConnection> display;
  if (window_needed) display.emplace();
  scene::Control control;
  control.stop = stop;
  control.progress = [&](std::string_view phase, double fraction, std::string_view remark) {
    progress.report(phase, fraction, remark);
  };
  const auto warn = [&](const std::string& line) { progress.warning(line); };
  const bool watch = c.live && c.screenshot.empty() && c.statistics.empty();
  if (watch) {
    watch_solve(c, stop, warn);
    return stop.stop_requested() ? kInterrupted : 0;
  }
  Document document = load_document(c, control, warn);
  if (!c.statistics.empty()) print_statistics(c, document.mesh);
  if (!window_needed) return stop.stop_requested() ? kInterrupted : 0;
  if (!c.screenshot.empty() || c.measure_frames > 0) {
    Stage stage(std::move(document), c, true);
    stage.render();
    if (c.measure_frames > 0)
      std::fputs(describe(measure_frames(stage, c.measure_frames)).c_str(), stdout);
    else
      stage.save(c.screenshot);
    return stop.stop_requested() ? kInterrupted : 0;
  }
  Window window(std::move(document), c);
  window.run(stop);
  return stop.stop_requested() ? kInterrupted : 0;
}

}  // namespace atrium::view
