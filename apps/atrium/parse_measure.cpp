#include <cmath>

#include "command_parser.h"
#include "option_text.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class MeasureParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    scene_.add(sub, o_.scene);
    add_places(sub);
    sub.add_option("-o,--output", o_.output, "table: .csv .json; default: CSV on standard output")
        ->type_name("FILE");
    sub.add_option("--error", o_.error, "standard error of a sensor, as a share of its reading")
        ->check(CLI::Range(1e-5, 1.0))
        ->capture_default_str();
    sub.add_option("--solution", o_.solution, "use this radiosity solution instead of solving")
        ->type_name("FILE.atrium");
    solver_.add(sub, o_.solve);
    add_common(sub, o_.common);
  }

  Command finish(const CLI::App& sub, const std::string& command_line) override {
    scene_.finish(o_.scene);
    solver_.finish(o_.solve);
    o_.common.command_line = command_line;
    if (!grid_.empty()) o_.grid = parse_grid(grid_);
    const int places = (o_.points.empty() ? 0 : 1) + (o_.grid ? 1 : 0) + (o_.work_plane ? 1 : 0);
    if (places != 1) throw Error("measure: one of --points, --grid and --workplane is required");
    if (o_.work_plane && !std::isfinite(*o_.work_plane))
      throw Error("--workplane: must be a height in metres");
    if (!o_.solution.empty())
      for (const char* name : {"--solver", "--quality", "--time-limit", "--memory-limit"})
        if (sub.count(name) > 0)
          throw Error(std::string(name) + ": nothing is solved with --solution");
    return o_;
  }

 private:
  void add_places(CLI::App& sub) {
    sub.add_option("--points", o_.points, "sensors, one per line: x y z nx ny nz [m]")
        ->type_name("FILE");
    sub.add_option("--grid", grid_,
                   "sensors on a parallelogram: its corner, two edges u v, and NxM cells along "
                   "them; they look along u x v")
        ->expected(4)
        ->type_name("X,Y,Z U V NxM");
    CLI::Option* plane = sub.add_option("--workplane", o_.work_plane,
                                        "sensors that look up, at this height y [m] in rooms: a "
                                        "floor below, a ceiling above")
                             ->type_name("HEIGHT");
    sub.add_option("--spacing", o_.spacing, "of the sensors of a work plane [m]")
        ->check(CLI::Range(1e-6, 1e6))
        ->needs(plane)
        ->capture_default_str();
  }

  MeasureCommand o_;
  SceneParser scene_;
  SolverParser solver_;
  std::vector<std::string> grid_;
};

}  // namespace

std::unique_ptr<CommandParser> measure_parser() { return std::make_unique<MeasureParser>(); }

}  // namespace atrium::app
