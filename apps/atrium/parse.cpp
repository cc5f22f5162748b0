// The only code that sees CLI11.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "common/suggest.h"
#include "material/error.h"
#include "option_text.h"
#include "options.h"
#include "scene/image_io.h"
#include "scene/output_file.h"

namespace atrium::app {

namespace {

/// Texts of options that are checked and converted together after parsing.
struct Texts {
  std::string camera, size, crop, exposure = "auto", tone = "filmic", method = "hybrid",
                                  quality = "normal", indirect = "auto", solver = "rows",
                                  mode = "radiometric", emissive_unit = "nit";
  bool no_pane_detection = false;
  bool light_groups = false;
};

/// The same of `material derive`.
struct DeriveTexts {
  std::string sigma, tau, thickness = "0", wavelengths = "380:780:10";
};

std::string join(int argc, char** argv) {
  std::string line = "atrium";
  for (int i = 1; i < argc; ++i) line += " " + shell_word(argv[i]);
  return line;
}

template <class T>
T choose(const std::string& text, std::initializer_list<std::pair<const char*, T>> known) {
  for (const auto& [name, value] : known) {
    if (text == name) return value;
  }
  throw Error(text + ": unknown choice");  // IsMember has refused it before
}

void add_common(CLI::App& app, CommonOptions& o) {
  app.add_option("--threads", o.threads, "threads; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--stats", o.stats, "write phases, counters, memory, errors to this JSON file");
  CLI::Option* quiet = app.add_flag("--quiet,-q", o.quiet, "no progress; warnings stay");
  app.add_flag("--verbose,-v", o.verbose, "say what is decided and why")->excludes(quiet);
}

void add_scene(CLI::App& app, SceneOptions& o, Texts& t) {
  app.add_option("scene", o.files, "scene files, put together: .glb .gltf .obj .ply .stl .yaml")
      ->required()
      ->type_name("FILE");
  app.add_option("--emissive-unit", t.emissive_unit,
                 "what emissive numbers of models are: nit, or radiance in W/(sr m^2)")
      ->check(CLI::IsMember({"nit", "radiance"}))
      ->capture_default_str();
  app.add_flag("--no-pane-detection", t.no_pane_detection,
               "keep closed solids with two parallel faces as solids");
  app.add_option("--spectrum", o.spectrum, "spectral lanes: auto, grey, rgb, 4, 8, 16 or 32")
      ->check(CLI::IsMember({"auto", "grey", "rgb", "4", "8", "16", "32"}))
      ->capture_default_str();
}

void add_solve(CLI::App& app, SolveSettings& o, Texts& t) {
  app.add_option("--quality", t.quality, "effort: draft, normal or high")
      ->check(CLI::IsMember({"draft", "normal", "high"}))
      ->capture_default_str();
  app.add_option("--solver", t.solver, "radiosity: rows, shooting or matrix")
      ->check(CLI::IsMember({"rows", "shooting", "matrix"}))
      ->capture_default_str();
  app.add_option("--time-limit", o.time_limit, "stop computing after this time [s]; 0: none")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--memory-limit", o.memory_limit,
                 "what the scene and its radiosity may hold [MB]; 0: no limit")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "of all random numbers")->capture_default_str();
  app.add_option("--probes", o.probes,
                 "points where path tracing checks the radiosity and states its error; 0: none")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
}

void add_mode(CLI::App& app, Texts& t) {
  app.add_option("--mode", t.mode, "radiometric, or paper (the model's terms literally)")
      ->check(CLI::IsMember({"radiometric", "paper"}))
      ->capture_default_str();
}

void add_render(CLI::App& app, RenderCommand& o, Texts& t) {
  add_scene(app, o.scene, t);
  app.add_option("-o,--output", o.outputs,
                 "image, may be repeated: .exr (linear, layers) .pfm .hdr (linear) .png .jpg "
                 "(tone mapped)")
      ->required()
      ->type_name("FILE");
  app.add_option("--camera", o.camera, "name or number (from 0), or all: one image each");
  app.add_option("--size", t.size, "WxH; default: 640 wide with the camera's aspect, else 640x480")
      ->type_name("WxH");
  app.add_option("--crop", t.crop, "part of the image, as shares of width and height")
      ->type_name("X0,Y0,X1,Y1");
  app.add_option("--exposure", t.exposure, "auto, or the exposure value (EV at ISO 100)")
      ->capture_default_str();
  app.add_option("--tone", t.tone, "curve for 8-bit images: filmic or srgb")
      ->check(CLI::IsMember({"filmic", "srgb"}))
      ->capture_default_str();
  app.add_option("--method", t.method,
                 "hybrid (radiosity and ray tracing), path (unbiased reference) or direct (no "
                 "inter-reflection)")
      ->check(CLI::IsMember({"hybrid", "path", "direct"}))
      ->capture_default_str();
  add_solve(app, o.solve, t);
  add_mode(app, t);
  app.add_option("--error", o.error,
                 "go on until the RMS error of pixels is below this share of the picture (0.02: 2 "
                 "%); 0: the samples of --quality")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--error-block", o.block_error, "the same after averaging 8x8 pixels")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--samples", o.samples,
                 "of a pixel; 0: from the quality (16, 64, 256); with an error asked for the most")
      ->check(CLI::Range(0, 1 << 24))
      ->capture_default_str();
  app.add_option("--indirect", t.indirect,
                 "inter-reflection in the picture: mesh (interpolated), gather (hemisphere rays), "
                 "auto: mesh for drafts")
      ->check(CLI::IsMember({"auto", "mesh", "gather"}))
      ->capture_default_str();
  app.add_flag("--components", o.components, "layers C1..C6 in .exr");
  app.add_flag("--no-filter", o.no_filter, "do not share samples between neighbouring pixels");
  app.add_option("--solution", o.solution, "use this radiosity solution instead of solving")
      ->type_name("FILE.atrium");
  app.add_option("--save-solution", o.save_solution, "keep the radiosity solution")
      ->type_name("FILE.atrium");
  add_common(app, o.common);
}

bool any_output(const RenderCommand& o, bool (*is)(const std::filesystem::path&)) {
  return std::any_of(o.outputs.begin(), o.outputs.end(),
                     [&](const std::string& f) { return is(f); });
}

/// Options that would be ignored, or that say two things, are mistakes worth a word.
void check_contradictions(const CLI::App& app, const RenderCommand& o) {
  const auto given = [&](const char* name) { return app.count(name) > 0; };
  const auto refuse = [&](const char* name, const std::string& why) {
    if (given(name)) throw Error(std::string(name) + ": " + why);
  };
  if (o.error > 0.0 || o.block_error > 0.0) {
    refuse("--quality", "says how much effort to make, --error what to reach: give one of them");
  }
  if (o.method != trace::Method::Hybrid) {
    const std::string why = "has no meaning with --method " +
                            std::string(o.method == trace::Method::Path ? "path" : "direct") +
                            ", which uses no radiosity";
    for (const char* name :
         {"--solution", "--save-solution", "--solver", "--indirect", "--memory-limit"}) {
      refuse(name, why);
    }
  }
  if (o.method == trace::Method::Path && o.mode == trace::Mode::Paper) {
    throw Error("--mode paper: --method path needs energy-conserving materials (radiometric)");
  }
  if (o.mode == trace::Mode::Paper || o.method == trace::Method::Path) {
    refuse("--no-filter", "--method path and --mode paper never share samples");
  }
  if (o.mode == trace::Mode::Paper) {
    refuse("--indirect", "paper mode reads its ambient light from the mesh");
  }
  if (!any_output(o, scene::is_display_ending)) {
    for (const char* name : {"--exposure", "--tone"}) {
      refuse(name, "only 8-bit images are tone mapped: there is no .png or .jpg output");
    }
  }
  if (!any_output(o,
                  [](const std::filesystem::path& f) { return scene::file_ending(f) == ".exr"; })) {
    refuse("--components", "only .exr holds layers: there is no such output");
  }
  if (!o.solution.empty()) {
    refuse("--save-solution", "there is nothing new to save with --solution");
    for (const char* name : {"--solver", "--memory-limit"})
      refuse(name, "nothing is solved with --solution");
  }
}

RenderCommand finish(RenderCommand o, const Texts& t, const CLI::App& app) {
  using trace::Method, trace::Mode;
  using Curve = trace::ToneMapOptions::Curve;
  if (!t.size.empty()) o.size = parse_size(t.size);
  if (!t.crop.empty()) o.crop = parse_crop(t.crop);
  o.tone.ev = parse_exposure(t.exposure);
  o.tone.curve = choose<Curve>(t.tone, {{"filmic", Curve::Filmic}, {"srgb", Curve::Srgb}});
  o.method = choose<Method>(
      t.method, {{"hybrid", Method::Hybrid}, {"path", Method::Path}, {"direct", Method::Direct}});
  o.mode = choose<Mode>(t.mode, {{"radiometric", Mode::Radiometric}, {"paper", Mode::Paper}});
  o.indirect = choose<IndirectChoice>(t.indirect, {{"auto", IndirectChoice::Auto},
                                                   {"mesh", IndirectChoice::Mesh},
                                                   {"gather", IndirectChoice::Gather}});
  check_contradictions(app, o);
  return o;
}

void finish(SolveSettings& o, const Texts& t) {
  o.paper_weights = t.mode == "paper";
  o.quality = choose<Quality>(
      t.quality, {{"draft", Quality::Draft}, {"normal", Quality::Normal}, {"high", Quality::High}});
  o.solver = choose<SolverChoice>(t.solver, {{"rows", SolverChoice::Rows},
                                             {"shooting", SolverChoice::Shooting},
                                             {"matrix", SolverChoice::Matrix}});
  if (o.error > 0.0 && o.solver != SolverChoice::Rows)
    throw Error("--error: only solver 'rows' works towards an error");
}

void finish(SceneOptions& o, const Texts& t) {
  // 179 lm/W: the luminous efficacy of white light where watts have to become lumens (DESIGN 8).
  o.pane_detection = !t.no_pane_detection;
  o.nits_per_emissive_unit = t.emissive_unit == "radiance" ? 179.0 : 1.0;
}

void finish(ExportSettings& o, const SceneOptions& scene, const Texts& t) {
  o.ev = parse_exposure(t.exposure);
  o.title = std::filesystem::path(scene.files.front()).stem().string();
}

MeasureCommand finish(MeasureCommand o, const std::vector<std::string>& grid, const CLI::App& app) {
  if (!grid.empty()) o.grid = parse_grid(grid);
  const int places = (o.points.empty() ? 0 : 1) + (o.grid ? 1 : 0) + (o.work_plane ? 1 : 0);
  if (places != 1) throw Error("measure: one of --points, --grid and --workplane is required");
  if (o.work_plane && !std::isfinite(*o.work_plane))
    throw Error("--workplane: must be a height in metres");
  if (!o.solution.empty())
    for (const char* name : {"--solver", "--quality", "--time-limit", "--memory-limit"})
      if (app.count(name) > 0)
        throw Error(std::string(name) + ": nothing is solved with --solution");
  return o;
}

MaterialDeriveCommand finish(MaterialDeriveCommand o, const DeriveTexts& t, const CLI::App& app) {
  o.sigma = parse_length("--sigma", t.sigma);
  o.tau = parse_length("--tau", t.tau);
  if (!(o.tau > 0.0)) throw Error("--tau " + t.tau + ": must be above 0");
  o.thickness = parse_length("--thickness", t.thickness);
  o.wavelengths_nm = parse_wavelengths(t.wavelengths);
  if (o.material.empty() && app.count("--n") == 0)
    throw Error("--material NAME, or --n N and --kappa K, is required");
  return o;
}

/// `atrium material ...`: a subcommand each, and what they fill.
struct MaterialParser {
  MaterialEvalCommand eval;
  MaterialDeriveCommand derive;
  MaterialListCommand list;
  MaterialShowCommand show;
  MaterialCompareCommand compare;
  DeriveTexts derive_texts;
  std::string compare_size = "80x60";

  void add(CLI::App& material) {
    material.require_subcommand(1);
    material.fallthrough();
    add_eval(*material.add_subcommand("eval", "answer queries: a JSON array in, a JSON array out"));
    add_derive(*material.add_subcommand("derive", "the model's parameters of a surface as made"));
    material.add_subcommand("list", "materials and illuminants known")
        ->add_flag("--json", list.json, "for programs");
    add_show(*material.add_subcommand("show", "data sheet of a material"));
    add_compare(*material.add_subcommand(
        "compare", "study: this model beside others, in pictures, lobes, numbers and times"));
  }
  [[nodiscard]] Command finished(const CLI::App& sub, const std::string& command_line) const {
    const std::string& name = sub.get_name();
    if (name == "eval") return eval;
    if (name == "derive") return finish(derive, derive_texts, sub);
    if (name == "list") return list;
    if (name == "compare") return finished_compare(command_line);
    return show;
  }

 private:
  void add_eval(CLI::App& sub) {
    sub.add_option("queries", eval.input, "JSON file; -: standard input")
        ->type_name("FILE")
        ->capture_default_str();
    sub.add_option("-o,--output", eval.output, "answers; default: standard output")
        ->type_name("FILE");
    sub.add_option("--kinds", eval.kinds, "describe all kinds of queries instead: markdown or json")
        ->check(CLI::IsMember({"markdown", "json"}));
  }
  void add_derive(CLI::App& sub) {
    sub.add_option("--sigma", derive_texts.sigma, "rms height: 0.2um, 200nm, 2e-7 [m]")
        ->required()
        ->type_name("LENGTH");
    sub.add_option("--tau", derive_texts.tau, "correlation length of the heights")
        ->required()
        ->type_name("LENGTH");
    CLI::Option* material =
        sub.add_option("--material", derive.material, "named optical constants")->type_name("NAME");
    sub.add_option("--n", derive.n, "absolute index of refraction")
        ->check(CLI::Range(1e-6, 1e6))
        ->excludes(material);
    sub.add_option("--kappa", derive.kappa, "index of absorption k/n")
        ->check(CLI::Range(0.0, 1e6))
        ->excludes(material)
        ->capture_default_str();
    sub.add_option("--wavelengths", derive_texts.wavelengths,
                   "in vacuum [nm]: FIRST:LAST:STEP or A,B,C")
        ->type_name("NM")
        ->capture_default_str();
    sub.add_option("--mu-s", derive.scattering, "scattering of the bulk [1/m]")
        ->check(CLI::Range(0.0, 1e12))
        ->capture_default_str();
    sub.add_option("--thickness", derive_texts.thickness, "of a transmitting body")
        ->type_name("LENGTH")
        ->capture_default_str();
    CLI::Option* json = sub.add_flag("--json", derive.json, "for programs");
    sub.add_flag("--csv", derive.csv, "for tables")->excludes(json);
  }
  void add_compare(CLI::App& sub) {
    sub.add_option("-o,--output", compare.folder,
                   "folder; gets material-study.md and images/study/*.png")
        ->required()
        ->type_name("DIR");
    sub.add_option("--materials", compare.materials,
                   "some of gold,copper,aluminium,plastic,glass; default: all")
        ->delimiter(',')
        ->type_name("NAMES");
    sub.add_option("--size", compare_size, "of each picture, 16x16 to 1000x1000")
        ->type_name("WxH")
        ->capture_default_str();
    sub.add_option("--samples", compare.samples, "of a pixel")
        ->check(CLI::Range(2, 1 << 20))
        ->capture_default_str();
    sub.add_option("--seed", compare.seed, "of all random numbers")->capture_default_str();
    sub.add_flag("--quick", compare.quick, "fewer models and cases, for a try");
    sub.add_option("--threads", compare.common.threads, "threads; 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub.add_flag("--quiet,-q", compare.common.quiet, "no progress; warnings stay");
  }
  [[nodiscard]] MaterialCompareCommand finished_compare(const std::string& command_line) const {
    MaterialCompareCommand o = compare;
    o.common.command_line = command_line;
    o.size = parse_size(compare_size);
    for (const int side : o.size)
      if (side < 16 || side > 1000)
        throw Error("--size " + compare_size + ": is not within 16x16 and 1000x1000");
    return o;
  }
  void add_show(CLI::App& sub) {
    sub.add_option("name", show.name, "see atrium material list")->required()->type_name("NAME");
    sub.add_option("-o,--output", show.output, "picture of curves and colours: .svg .png")
        ->type_name("FILE");
    sub.add_flag("--json", show.json, "for programs");
  }
};

/// The parser and the values that it fills.
struct Parser {
  CLI::App app{"Atrium: light in buildings by radiosity and ray tracing", "atrium"};
  RenderCommand render;
  SolveCommand solve;
  ExportCommand exports;
  ReweightCommand reweight;
  std::vector<std::string> reweight_factors;
  MeasureCommand measure;
  std::vector<std::string> measure_grid;
  InfoCommand info;
  CompareCommand compare;
  MaterialParser material;
  Texts render_texts, solve_texts, export_texts, measure_texts, info_texts;
  bool print_config = false;

  Parser() {
    app.set_version_flag("--version", std::string("atrium ") + ATRIUM_VERSION);
    app.set_config("--config", "", "read options from a file as --print-config writes it")
        ->configurable(false);
    app.add_flag("--print-config", print_config, "print all options in effect and leave")
        ->configurable(false);
    app.require_subcommand(1);
    app.fallthrough();
    add_render(*app.add_subcommand("render", "render a picture of a scene"), render, render_texts);
    add_solve_command(*app.add_subcommand("solve", "radiosity only, as a mesh or to render later"));
    add_export_command(*app.add_subcommand("export", "files for other programs, of a solution"));
    add_reweight_command(
        *app.add_subcommand("reweight", "dim the light groups of a solution, without a ray"));
    add_measure_command(
        *app.add_subcommand("measure", "illuminance or irradiance at points and on grids"));
    add_info_command(*app.add_subcommand("info", "what a file contains, needs and goes without"));
    add_compare_command(*app.add_subcommand("compare", "error measures between two images"));
    material.add(*app.add_subcommand("material", "explore the material model"));
  }

 private:
  void add_solve_command(CLI::App& sub) {
    add_scene(sub, solve.scene, solve_texts);
    sub.add_option(
           "-o,--output", solve.outputs,
           "result, may be repeated: .vtp .vtu (mesh with arrays), .glb .html (to look at), "
           ".atrium (for render --solution, export)")
        ->required()
        ->type_name("FILE");
    add_solve(sub, solve.solve, solve_texts);
    sub.add_option("--solution", solve.solution,
                   "go on from this solution: interrupted, or of other diffuse reflectances")
        ->type_name("FILE.atrium");
    sub.add_flag("--keep-rows", solve.solve.keep_rows,
                 "store the rows in .atrium too: larger, but later runs need not trace them again");
    sub.add_flag("--light-groups", solve_texts.light_groups,
                 "keep the light of each lamp name apart, for reweight; default: of each "
                 "light_group that the scene names");
    sub.add_option("--error", solve.solve.error,
                   "go on until the RMS of irradiance is below this share of it (0.02: 2 %); 0: "
                   "the effort of --quality. Solver rows only")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    add_mode(sub, solve_texts);
    add_exports(sub, solve.exports, solve_texts);
    add_common(sub, solve.common);
  }
  static void add_exports(CLI::App& sub, ExportSettings& o, Texts& t) {
    sub.add_option("--lightmap", o.lightmap,
                   "light of .glb in a picture of N x N texels; 0: at the vertices")
        ->check(CLI::Range(0, 16384))
        ->capture_default_str()
        ->type_name("N");
    sub.add_option("--exposure", t.exposure,
                   "of .glb and at first of .html: auto, or the exposure value (EV at ISO 100)")
        ->capture_default_str();
  }
  void add_export_command(CLI::App& sub) {
    add_scene(sub, exports.scene, export_texts);
    sub.add_option("--solution", exports.solution, "of atrium solve or reweight, of this scene")
        ->required()
        ->type_name("FILE.atrium");
    sub.add_option("-o,--output", exports.outputs,
                   "result, may be repeated: .vtp .vtu (mesh with arrays), .glb .html (to look at)")
        ->required()
        ->type_name("FILE");
    add_mode(sub, export_texts);
    add_exports(sub, exports.exports, export_texts);
    add_common(sub, exports.common);
  }
  void add_reweight_command(CLI::App& sub) {
    sub.add_option("solution", reweight.solution, "of atrium solve, with light groups")
        ->required()
        ->type_name("FILE.atrium");
    sub.add_option("--set", reweight_factors,
                   "factor of a group's light as it was solved, may be repeated; others stay")
        ->required()
        ->type_name("NAME=FACTOR");
    sub.add_option("-o,--output", reweight.output, "dimmed solution")
        ->required()
        ->type_name("FILE.atrium");
  }
  void add_measure_command(CLI::App& sub) {
    MeasureCommand& o = measure;
    add_scene(sub, o.scene, measure_texts);
    sub.add_option("--points", o.points, "sensors, one per line: x y z nx ny nz [m]")
        ->type_name("FILE");
    sub.add_option("--grid", measure_grid,
                   "sensors on a parallelogram: its corner, two edges u v, and NxM cells along "
                   "them; they look along u x v")
        ->expected(4)
        ->type_name("X,Y,Z U V NxM");
    CLI::Option* plane = sub.add_option("--workplane", o.work_plane,
                                        "sensors that look up, at this height y [m] in rooms: a "
                                        "floor below, a ceiling above")
                             ->type_name("HEIGHT");
    sub.add_option("--spacing", o.spacing, "of the sensors of a work plane [m]")
        ->check(CLI::Range(1e-6, 1e6))
        ->needs(plane)
        ->capture_default_str();
    sub.add_option("-o,--output", o.output, "table: .csv .json; default: CSV on standard output")
        ->type_name("FILE");
    sub.add_option("--error", o.error, "standard error of a sensor, as a share of its reading")
        ->check(CLI::Range(1e-5, 1.0))
        ->capture_default_str();
    sub.add_option("--solution", o.solution, "use this radiosity solution instead of solving")
        ->type_name("FILE.atrium");
    add_solve(sub, o.solve, measure_texts);
    add_common(sub, o.common);
  }
  void add_info_command(CLI::App& sub) {
    add_scene(sub, info.scene, info_texts);
    sub.get_option("scene")->description(
        "scene files, put together; or one luminaire (.ies .ldt), image, radiosity mesh (.vtp "
        ".vtu) or solution (.atrium)");
    sub.add_flag("--json", info.json, "for programs");
  }
  void add_compare_command(CLI::App& sub) {
    sub.add_option("image", compare.image, "image to judge")->required()->type_name("FILE");
    sub.add_option("reference", compare.reference,
                   "image taken as true; its stderr.* layers, if any, are accounted for")
        ->required()
        ->type_name("FILE");
    sub.add_option("-o,--output", compare.difference,
                   "difference image: relative error (.exr .pfm), or shown round grey (.png "
                   ".jpg)")
        ->type_name("FILE");
    sub.add_option("--full-scale", compare.full_scale,
                   "relative error that is white or black in 8-bit difference images")
        ->check(CLI::Range(1e-6, 1e6))
        ->capture_default_str();
    sub.add_flag("--json", compare.json, "for programs");
  }
};

/// What was given as values, the defaults in effect as comments: read back, an option that was not
/// given still counts as not given when contradictions are looked for.
void print_configuration(const CLI::App& sub, const std::string& section) {
  std::cout << '[' << section << "]\n" << sub.config_to_str(false, false);
  for (const CLI::Option* option : sub.get_options()) {
    if (option->count() > 0 || !option->get_configurable()) continue;
    const bool flag = option->get_expected_max() == 0;
    std::cout << "# " << option->get_single_name() << "="
              << (flag ? "false" : option->get_default_str()) << '\n';
  }
}

/// CLI11 would take a mistyped command for an argument too many.
void check_command(const CLI::App& app, std::string_view word, const std::string& before) {
  if (word.empty() || word.front() == '-') return;
  std::vector<std::string_view> known;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(sub->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw Error(before + std::string(word) + ": unknown command" + suggestion(word, known));
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

Command finished_command(Parser& p, const std::string& command_line) {
  const CLI::App& sub = *p.app.get_subcommands().front();
  const std::string& name = sub.get_name();
  if (name == "render") {
    finish(p.render.scene, p.render_texts);
    finish(p.render.solve, p.render_texts);
    p.render.common.command_line = command_line;
    return finish(p.render, p.render_texts, sub);
  }
  if (name == "solve") {
    finish(p.solve.scene, p.solve_texts);
    finish(p.solve.solve, p.solve_texts);
    p.solve.solve.light_groups = p.solve_texts.light_groups ? scene::Grouping::ByName
                                 : p.solve.solve.solver == SolverChoice::Rows
                                     ? scene::Grouping::Declared
                                     : scene::Grouping::One;
    if (!p.solve.solution.empty() && p.solve.solve.solver != SolverChoice::Rows)
      throw Error("--solution: only --solver rows can go on from a solution");
    p.solve.common.command_line = command_line;
    finish(p.solve.exports, p.solve.scene, p.solve_texts);
    return p.solve;
  }
  if (name == "export") {
    finish(p.exports.scene, p.export_texts);
    finish(p.exports.exports, p.exports.scene, p.export_texts);
    p.exports.paper_weights = p.export_texts.mode == "paper";
    p.exports.common.command_line = command_line;
    return p.exports;
  }
  if (name == "reweight") {
    ReweightCommand o = p.reweight;
    for (const std::string& text : p.reweight_factors)
      o.factors.push_back(parse_factor("--set", text));
    return o;
  }
  if (name == "measure") {
    finish(p.measure.scene, p.measure_texts);
    finish(p.measure.solve, p.measure_texts);
    p.measure.common.command_line = command_line;
    return finish(p.measure, p.measure_grid, sub);
  }
  if (name == "info") {
    finish(p.info.scene, p.info_texts);
    return p.info;
  }
  if (name == "material") return p.material.finished(*sub.get_subcommands().front(), command_line);
  return p.compare;
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  Parser p;
  check_command(p.app, argc > 1 ? argv[1] : "", "");
  if (argc > 2 && std::string_view(argv[1]) == "material")
    check_command(*p.app.get_subcommand("material"), argv[2], "material ");
  try {
    p.app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const CLI::App* innermost = &p.app;
    while (!innermost->get_subcommands().empty()) innermost = innermost->get_subcommands().front();
    std::cout << innermost->help();
    return Finished{0};
  } catch (const CLI::CallForVersion& e) {
    std::cout << e.what() << '\n';
    return Finished{0};
  } catch (const CLI::ParseError& e) {
    throw Error(first_line(e.what()) + " (see atrium --help)");
  }
  const Command command = finished_command(p, join(argc, argv));
  if (!p.print_config) return command;
  const CLI::App& sub = *p.app.get_subcommands().front();
  if (sub.get_subcommands().empty())
    print_configuration(sub, sub.get_name());
  else
    print_configuration(*sub.get_subcommands().front(),
                        sub.get_name() + "." + sub.get_subcommands().front()->get_name());
  return Finished{0};
}

}  // namespace atrium::app
