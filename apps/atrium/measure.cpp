#include <cstdio>
#include <filesystem>

#include "commands.h"
#include "material/error.h"
#include "radiosity_pass.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"
#include "statistics.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "sensor_file.h"
#include "sensor_table.h"
#include "sensors.h"
#endif

namespace atrium::app {

#ifdef ATRIUM_WITH_RADIOSITY

namespace {

void check_outputs(const MeasureCommand& c) {
  if (!c.output.empty()) {
    const std::string ending = scene::file_ending(c.output);
    if (ending != ".csv" && ending != ".json")
      throw Error(c.output + ": unknown format (known: .csv .json)");
    scene::check_output(c.output);
  }
  if (!c.common.stats.empty()) scene::check_output(c.common.stats);
}

/// The field that indirect light is read from; empty if there is none.
scene::SurfaceField find_field(Session& session, const MeasureCommand& c, const LoadedScene& loaded,
                               Statistics& statistics) {
  std::string why;
  if (!c.solution.empty()) {
    why = "read from " + c.solution;
    scene::Solution solution = scene::read_solution(c.solution);
    scene::check_solution(solution, *loaded.scene, describe_lanes(loaded, c.solve), c.solution);
    statistics.radiosity_skipped = why;
    session.detail("skipped: radiosity: " + why);
    return std::move(solution.field);
  }
  if (!radiosity_needed(loaded.features, why)) {
    statistics.radiosity_skipped = why;
    session.detail("skipped: radiosity: " + why);
    return {};
  }
  RadiosityRun run = run_radiosity(session, loaded, c.solve, c.solve.time_limit);
  statistics.solve = run.summary;
  statistics.counters += run.summary.counters;
  return std::move(run.field);
}

/// A sensor of a work plane that is inside a table or a wall is no sensor.
void drop_invalid(std::vector<radiosity::Sensor>& sensors,
                  std::vector<radiosity::Reading>& readings) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (!readings[i].valid) continue;
    sensors[kept] = sensors[i];
    readings[kept++] = readings[i];
  }
  sensors.resize(kept);
  readings.resize(kept);
}

void write(Session& session, const MeasureCommand& c, const std::string& unit,
           std::span<const radiosity::Sensor> sensors,
           std::span<const radiosity::Reading> readings) {
  session.clock.enter("write");
  const std::string summary = describe(summarise(readings), unit);
  if (c.output.empty()) {
    std::fputs(sensor_csv(sensors, readings, unit).c_str(), stdout);
    session.progress.note(summary);
    return;
  }
  write_text(scene::file_ending(c.output) == ".json"
                 ? sensor_json(sensors, readings, unit, c.common.command_line)
                 : sensor_csv(sensors, readings, unit),
             c.output);
  session.progress.note("wrote " + c.output);
  std::puts(summary.c_str());
}

}  // namespace

int run_measure(const MeasureCommand& c, std::stop_token stop) {
  check_outputs(c);
  std::vector<radiosity::Sensor> sensors;
  if (!c.points.empty()) sensors = read_sensors(c.points);  // before anything is solved
  Session session(c.common, std::move(stop));
  const LoadedScene loaded = load_scene(session, c.scene, {.memory_limit = c.solve.memory_limit});
  if (session.interrupted()) return kInterrupted;
  if (loaded.basis.lanes() > kMaxLanes)
    throw Error("--spectrum " + c.scene.spectrum + ": measure takes up to " +
                std::to_string(kMaxLanes) + " lanes");
  if (sensors.empty())
    sensors = c.grid ? grid_sensors(*c.grid) : work_plane_sensors(loaded, *c.work_plane, c.spacing);

  Statistics statistics;
  statistics.seed = c.solve.seed;
  const scene::SurfaceField field = find_field(session, c, loaded, statistics);
  radiosity::MeasureResult result =
      radiosity::measure(*loaded.query, loaded.basis, field, sensors,
                         {.error = c.error, .seed = c.solve.seed}, session.control("measure"));
  session.clock.leave();
  statistics.counters += result.counters;
  if (result.caustics_missing > 0)
    session.progress.warning(
        std::to_string(result.caustics_missing) +
        " sensors lie on no surface: light of point, spot or directional lights that reaches them "
        "through mirrors or glass bodies is missing");
  if (c.work_plane) drop_invalid(sensors, result.readings);
  write(session, c, loaded.scene->unit == scene::RadianceUnit::Nit ? "lx" : "W/m^2", sensors,
        result.readings);
  write_statistics(session, loaded, statistics);
  return session.interrupted() ? kInterrupted : 0;
}

#else

int run_measure(const MeasureCommand&, std::stop_token) {
  throw RuntimeFailure(
      "measure: radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
}

#endif

}  // namespace atrium::app
