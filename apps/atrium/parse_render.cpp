#include <algorithm>
#include <filesystem>

#include "command_parser.h"
#include "option_text.h"
#include "scene/image_io.h"
#include "scene/output_file.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

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
  if (o.method != trace::Method::Path)
    refuse("--checkpoint", "only --method path goes on from one; --save-solution keeps radiosity");
  if (o.camera == "all") refuse("--checkpoint", "holds one picture, not one of every camera");
  if (o.mode == trace::Mode::Paper) refuse("--classes", "paper mode knows terms, not paths");
  if (o.indirect == IndirectChoice::Mesh)
    refuse("--classes", "the mesh does not tell classes apart: --indirect gather does");
  if (o.classes) refuse("--no-filter", "--classes never shares samples");
  if (o.mode == trace::Mode::Paper) {
    refuse("--indirect", "paper mode reads its ambient light from the mesh");
  }
  if (!any_output(o, scene::is_display_ending) && !scene::is_display_ending(o.preview)) {
    for (const char* name : {"--exposure", "--tone"}) {
      refuse(name, "only 8-bit images are tone mapped: there is no .png or .jpg output");
    }
  }
  if (!any_output(o,
                  [](const std::filesystem::path& f) { return scene::file_ending(f) == ".exr"; })) {
    for (const char* name : {"--components", "--classes"})
      refuse(name, "only .exr holds layers: there is no such output");
  }
  if (o.path.empty()) {
    for (const char* name : {"--frames", "--fps", "--frame-range"})
      refuse(name, "is for walks: there is no --path");
  } else {
    refuse("--camera", "--path says where the camera is");
    if (given("--frames") == given("--fps"))
      throw Error("--path: say how many pictures by one of --frames and --fps");
  }
  if (!o.solution.empty()) {
    refuse("--save-solution", "there is nothing new to save with --solution");
    for (const char* name : {"--solver", "--memory-limit"})
      refuse(name, "nothing is solved with --solution");
  }
}

class RenderParser : public CommandParser {
 public:
  void add_to(CLI::App& app) override {
    scene_.add(app, o_.scene);
    cli::add_repeatable(app, "-o,--output", o_.outputs,
                        "image: .exr (linear, layers) .pfm .hdr (linear) .png .jpg (tone mapped)",
                        "FILE")
        ->required();
    add_picture(app);
    add_walk(app);
    app.add_option("--method", method_,
                   "hybrid (radiosity and ray tracing), path (unbiased reference) or direct (no "
                   "inter-reflection)")
        ->check(CLI::IsMember({"hybrid", "path", "direct"}))
        ->capture_default_str();
    solver_.add(app, o_.solve);
    mode_.add(app);
    add_effort(app);
    add_common(app, o_.common);
  }

  Command finish(const CLI::App& sub, const std::string& command_line) override {
    using trace::Method;
    using Curve = trace::ToneMapOptions::Curve;
    scene_.finish(o_.scene);
    solver_.finish(o_.solve);
    o_.common.command_line = command_line;
    if (!size_.empty()) o_.size = parse_size(size_);
    if (!crop_.empty()) o_.crop = parse_crop(crop_);
    o_.tone.ev = parse_exposure(exposure_);
    o_.tone.curve = cli::choose<Curve>(tone_, {{"filmic", Curve::Filmic}, {"srgb", Curve::Srgb}});
    o_.method = cli::choose<Method>(
        method_, {{"hybrid", Method::Hybrid}, {"path", Method::Path}, {"direct", Method::Direct}});
    o_.mode = mode_.value();
    o_.solve.paper_weights = o_.mode == trace::Mode::Paper;
    o_.indirect = cli::choose<IndirectChoice>(indirect_, {{"auto", IndirectChoice::Auto},
                                                          {"mesh", IndirectChoice::Mesh},
                                                          {"gather", IndirectChoice::Gather}});
    check_contradictions(sub, o_);
    return o_;
  }

 private:
  void add_picture(CLI::App& app) {
    app.add_option("--camera", o_.camera, "name or number (from 0), or all: one image each");
    app.add_option("--size", size_, "WxH; default: 640 wide with the camera's aspect, else 640x480")
        ->type_name("WxH");
    app.add_option("--crop", crop_, "part of the image, as shares of width and height")
        ->type_name("X0,Y0,X1,Y1");
    app.add_option("--exposure", exposure_, "auto, or the exposure value (EV at ISO 100)")
        ->capture_default_str();
    app.add_option("--tone", tone_, "curve for 8-bit images: filmic or srgb")
        ->check(CLI::IsMember({"filmic", "srgb"}))
        ->capture_default_str();
  }
  void add_walk(CLI::App& app) {
    app.add_option("--path", o_.path, "key frames of a camera: a numbered picture for every frame")
        ->type_name("FILE.yaml");
    app.add_option("--frames", o_.frames, "number of pictures from the path's start to its end")
        ->check(CLI::Range(1, 1000000));
    app.add_option("--fps", o_.fps, "pictures per second, for key frames with times")
        ->check(CLI::Range(1e-3, 1e6));
    app.add_option("--frame-range", o_.frame_range, "only these of the frames, from 1")
        ->type_name("A-B");
    app.add_option("--preview", o_.preview,
                   "the picture so far, rewritten every two seconds or so while it is rendered")
        ->type_name("FILE");
  }
  void add_effort(CLI::App& app) {
    app.add_option(
           "--error", o_.error,
           "go on until the RMS error of pixels is below this share of the picture (0.02: 2 "
           "%); 0: the samples of --quality")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--error-block", o_.block_error, "the same after averaging 8x8 pixels")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option(
           "--samples", o_.samples,
           "of every pixel; 0: from the quality (12, 14, 128 in the mean, more where the error is; "
           "path: 16, 64, 256 of every pixel); with an error asked for the most")
        ->check(CLI::Range(0, 1 << 24))
        ->capture_default_str();
    app.add_option("--indirect", indirect_,
                   "inter-reflection in the picture: mesh (interpolated), gather (hemisphere "
                   "rays), auto: gather")
        ->check(CLI::IsMember({"auto", "mesh", "gather"}))
        ->capture_default_str();
    app.add_option("--checkpoint", o_.checkpoint,
                   "keep the state of a --method path picture here, and go on from it if it is "
                   "there")
        ->type_name("FILE");
    app.add_flag("--components", o_.components, "layers C1..C6 in .exr");
    app.add_flag("--classes", o_.classes,
                 "layers by class of light paths (LDE, LSDE, ...) in .exr, with standard errors");
    app.add_flag("--no-filter", o_.no_filter, "do not share samples between neighbouring pixels");
    app.add_option("--solution", o_.solution, "use this radiosity solution instead of solving")
        ->type_name("FILE.atrium");
    app.add_option("--save-solution", o_.save_solution, "keep the radiosity solution")
        ->type_name("FILE.atrium");
  }

  RenderCommand o_;
  SceneParser scene_;
  SolverParser solver_;
  ModeParser mode_;
  std::string size_, crop_, exposure_ = "auto", tone_ = "filmic", method_ = "hybrid",
                            indirect_ = "auto";
};

}  // namespace

std::unique_ptr<CommandParser> render_parser() { return std::make_unique<RenderParser>(); }

}  // namespace atrium::app
