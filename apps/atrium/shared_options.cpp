#include "shared_options.h"

#include <filesystem>

#include "option_text.h"

namespace atrium::app {

void add_common(CLI::App& app, CommonOptions& o) {
  cli::add_threads(app, o.threads);
  app.add_option("--stats", o.stats, "write phases, counters, memory, errors to this JSON file");
  CLI::Option* quiet = cli::add_quiet(app, o.quiet);
  app.add_flag("--verbose,-v", o.verbose, "say what is decided and why")->excludes(quiet);
}

void SceneParser::add(CLI::App& app, SceneOptions& o) {
  app.add_option("scene", o.files, "scene files, put together: .glb .gltf .obj .ply .stl .yaml")
      ->required()
      ->type_name("FILE");
  model_.add(app);
  app.add_option("--spectrum", o.spectrum, "spectral lanes: auto, grey, rgb, 4, 8, 16 or 32")
      ->check(CLI::IsMember({"auto", "grey", "rgb", "4", "8", "16", "32"}))
      ->capture_default_str();
}

void SceneParser::finish(SceneOptions& o) const {
  o.pane_detection = model_.pane_detection();
  o.nits_per_emissive_unit = model_.nits_per_emissive_unit();
}

void SolverParser::add(CLI::App& app, SolveSettings& o) {
  quality_.add(app);
  app.add_option("--solver", solver_, "radiosity: rows, shooting or matrix")
      ->check(CLI::IsMember({"rows", "shooting", "matrix"}))
      ->capture_default_str();
  cli::add_time_limit(app, o.time_limit);
  app.add_option("--memory-limit", o.memory_limit,
                 "what the scene and its radiosity may hold [MB]; 0: no limit")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  cli::add_seed(app, o.seed);
  app.add_option("--probes", o.probes,
                 "points where path tracing checks the radiosity and states its error; 0: none")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
}

void SolverParser::finish(SolveSettings& o) const {
  o.quality = quality_.value();
  o.solver = cli::choose<SolverChoice>(solver_, {{"rows", SolverChoice::Rows},
                                                 {"shooting", SolverChoice::Shooting},
                                                 {"matrix", SolverChoice::Matrix}});
  if (o.error > 0.0 && o.solver != SolverChoice::Rows)
    throw Error("--error: only solver 'rows' works towards an error");
}

void ModeParser::add(CLI::App& app) {
  app.add_option("--mode", text_, "radiometric, or paper (the model's terms literally)")
      ->check(CLI::IsMember({"radiometric", "paper"}))
      ->capture_default_str();
}

trace::Mode ModeParser::value() const {
  return cli::choose<trace::Mode>(
      text_, {{"radiometric", trace::Mode::Radiometric}, {"paper", trace::Mode::Paper}});
}

void ExportParser::add(CLI::App& app, ExportSettings& o) {
  app.add_option("--lightmap", o.lightmap,
                 "light of .glb in a picture of N x N texels; 0: at the vertices")
      ->check(CLI::Range(0, 16384))
      ->capture_default_str()
      ->type_name("N");
  app.add_flag("--group-colours", o.group_colours,
               "vertices of .glb carry the light of every group, too: COLOR_1, COLOR_2, ...");
  app.add_option("--exposure", exposure_,
                 "of .glb and at first of .html: auto, or the exposure value (EV at ISO 100)")
      ->capture_default_str();
}

void ExportParser::finish(ExportSettings& o, const SceneOptions& scene) const {
  o.ev = parse_exposure(exposure_);
  o.title = std::filesystem::path(scene.files.front()).stem().string();
}

}  // namespace atrium::app
