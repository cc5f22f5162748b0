// The only code of the viewer that sees CLI11.
#include <iostream>

#include "common/cli_options.h"
#include "common/option_values.h"
#include "keys.h"
#include "look_text.h"
#include "material/error.h"
#include "mesh.h"
#include "options.h"
#include "scene/output_file.h"

namespace atrium::view {
namespace {

/// Texts of options that are checked and converted together after parsing.
struct Texts {
  std::string size, range, contours, exposure = "auto", side = "seen", solver = "rows";
  std::vector<std::string> clips, weights;
  bool light_groups = false;
  app::cli::QualityOption quality{"draft"};
  app::cli::ModelOptions model;
};

void add_look(CLI::App& app, LookOptions& o, Texts& t) {
  app.add_option(
      "--field", o.field,
      "radiosity (true colour), illuminance [lx], irradiance, direct, caustic, indirect, "
      "error, level, element, material, object, reflectance, emission, or an array of "
      "the file; default: the first of these");
  app.add_option("--camera", o.camera,
                 "name or number of the scene's cameras, overview, plan, or "
                 "x,y,z:tx,ty,tz[:ux,uy,uz][:FOV]: eye, target, up, vertical field of view in "
                 "degrees")
      ->type_name("VIEW");
  app.add_option("--range", t.range, "of the colours; default: suits the values")
      ->type_name("LOW,HIGH");
  app.add_flag("--log", o.logarithmic, "logarithmic range");
  app.add_option("--exposure", t.exposure,
                 "of true colours: auto, or the exposure value (EV at ISO 100)")
      ->capture_default_str();
  app.add_option("--contours", t.contours, "about N round values, or a list A,B,C")
      ->type_name("N|LIST");
  app.add_option("--side", t.side, "of surfaces: seen (the one that faces the viewer), front, back")
      ->check(CLI::IsMember({"seen", "front", "back"}))
      ->capture_default_str();
  app.add_flag("--flat", o.flat, "one value per element instead of smooth ones");
  app.add_flag("--edges", o.edges, "edges of elements");
  app.add_flag("--cull", o.cull, "hide faces that are turned away");
  app.add_flag("--no-ceilings", o.no_ceilings, "hide what covers rooms");
  app::cli::add_repeatable(app, "--hide", o.hidden, "object=NAME or material=NAME", "WHICH");
  app::cli::add_repeatable(app, "--clip", t.clips,
                           "what stays: y<2.4, x>1 or nx,ny,nz<distance [m]", "PLANE");
  app::cli::add_repeatable(app, "--weights", t.weights, "factor of a light group", "GROUP=FACTOR");
  app.add_flag("--no-legend", o.no_legend, "no scale");
}

void add_solve(CLI::App& app, ViewCommand& o, Texts& t) {
  app.add_flag("--solve", o.live, "show a scene's solution while it converges");
  t.quality.add(app);
  app.add_option("--solver", t.solver, "rows, or shooting (diffuse scenes only)")
      ->check(CLI::IsMember({"rows", "shooting"}))
      ->capture_default_str();
  app::cli::add_error(app, o.solve.error);
  app::cli::add_time_limit(app, o.solve.time_limit);
  app.add_flag("--light-groups", t.light_groups,
               "keep the light of each lamp name apart; default: of each light_group in the scene");
  app::cli::add_seed(app, o.solve.seed);
  t.model.add(app);
}

void add_output(CLI::App& app, ViewCommand& o, Texts& t) {
  app.add_option("files", o.files,
                 "a mesh (.vtp .vtu), with scene files for cameras and names or without; or scene "
                 "files (.glb .gltf .obj .ply .stl .yaml), with their solution (.atrium) or "
                 "without: then they are solved")
      ->required()
      ->type_name("FILE");
  app.add_option("--screenshot", o.screenshot,
                 "write a picture instead of opening a window (needs an X display, too: xvfb-run "
                 "-a atrium-view ...)")
      ->type_name("FILE.png");
  app.add_option("--size", t.size, "of window or picture in pixels (1024x768)")->type_name("WxH");
  app.add_option("--statistics", o.statistics,
                 "print mean, least, most and uniformity as JSON instead of opening a window: all, "
                 "object=NAME, material=NAME or facet=ELEMENT")
      ->type_name("WHICH");
  app.add_option("--measure-frames", o.measure_frames,
                 "draw so many frames of an orbit, print how fast, and leave")
      ->check(CLI::Range(1, 100000));
  app::cli::add_threads(app, o.threads);
  app::cli::add_quiet(app, o.quiet);
}

void finish_look(LookOptions& o, const Texts& t) {
  if (!t.range.empty()) o.range = parse_range(t.range, o.logarithmic);
  if (!t.contours.empty()) o.contours = parse_contours(t.contours);
  for (const std::string& text : t.clips) o.clips.push_back(parse_clip(text));
  constexpr std::size_t kMostClips = 6;  // that graphics hardware promises
  if (o.clips.size() > kMostClips) throw Error("--clip: six planes at most");
  for (const std::string& text : t.weights)
    o.weights.push_back(app::parse_factor("--weights", text));
  o.ev = app::parse_exposure(t.exposure);
  o.side = app::cli::choose<ShownSide>(
      t.side, {{"seen", ShownSide::Seen}, {"front", ShownSide::Front}, {"back", ShownSide::Back}});
}

/// Options that would be ignored, or that say two things, are mistakes worth a word.
void check(const CLI::App& app, const ViewCommand& o) {
  const auto refuse = [&](std::initializer_list<const char*> names, const std::string& why) {
    for (const char* name : names)
      if (app.count(name) > 0) throw Error(std::string(name) + ": " + why);
  };
  std::string solved;
  for (const std::string& f : o.files) {
    if (!is_mesh_file(f) && scene::file_ending(f) != ".atrium") continue;
    if (!solved.empty()) throw Error(f + ": one mesh or solution at a time, there is " + solved);
    solved = f;
  }
  if (o.solve.shooting)
    refuse({"--error", "--light-groups", "--weights"}, "only with --solver rows");
  if (!solved.empty())
    refuse(
        {"--solve", "--solver", "--quality", "--error", "--time-limit", "--seed", "--light-groups"},
        "nothing is solved with a mesh or a solution");
  if (o.files.size() == 1 && is_mesh_file(solved))
    refuse({"--emissive-unit", "--no-pane-detection"}, "there is no scene to read");
  if (!o.statistics.empty() && o.screenshot.empty())
    refuse({"--camera", "--range", "--log", "--exposure", "--contours", "--flat", "--edges",
            "--cull", "--no-ceilings", "--hide", "--clip", "--no-legend", "--size"},
           "has no meaning for --statistics without --screenshot");
  if (!o.screenshot.empty()) {
    if (scene::file_ending(o.screenshot) != ".png")
      throw Error(o.screenshot + ": a screenshot is a .png");
    scene::check_output(o.screenshot);
  }
  if (o.measure_frames > 0)
    refuse({"--screenshot", "--statistics", "--solve"}, "not together with --measure-frames");
}

ViewCommand finish(ViewCommand o, const Texts& t, const CLI::App& app) {
  finish_look(o.look, t);
  if (!t.size.empty()) {
    o.size = app::parse_size(t.size);
    if (o.size[0] < 16 || o.size[1] < 16 || o.size[0] > 16384 || o.size[1] > 16384)
      throw Error("--size " + t.size + ": is not between 16x16 and 16384x16384");
  }
  o.solve.quality = t.quality.value();
  o.solve.shooting = t.solver == "shooting";
  o.solve.groups = t.light_groups ? scene::Grouping::ByName : scene::Grouping::Declared;
  o.solve.nits_per_emissive_unit = t.model.nits_per_emissive_unit();
  o.solve.pane_detection = t.model.pane_detection();
  check(app, o);
  return o;
}

}  // namespace

std::variant<Finished, ViewCommand> parse_command_line(int argc, char** argv) {
  CLI::App app("Shows what light a radiosity solution holds: in a window, or as a picture.",
               "atrium-view");
  app.set_version_flag("--version", "atrium-view " ATRIUM_VERSION);
  app.footer("Keys in the window:\n" + key_help());
  ViewCommand command;
  Texts texts;
  add_output(app, command, texts);
  add_look(app, command.look, texts);
  add_solve(app, command, texts);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return Finished{0};
  } catch (const CLI::CallForVersion& e) {
    std::cout << e.what() << '\n';
    return Finished{0};
  } catch (const CLI::ParseError& e) {
    throw Error(app::cli::usage_error(e, "atrium-view"));
  }
  return finish(command, texts, app);
}

}  // namespace atrium::view
