#include "command_parser.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class ExportCommandParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    scene_.add(sub, o_.scene);
    sub.add_option("--solution", o_.solution, "of atrium solve or reweight, of this scene")
        ->required()
        ->type_name("FILE.atrium");
    cli::add_repeatable(sub, "-o,--output", o_.outputs,
                        "result: .vtp .vtu (mesh with arrays), .glb .html (to look at)", "FILE")
        ->required();
    mode_.add(sub);
    exports_.add(sub, o_.exports);
    add_common(sub, o_.common);
  }

  Command finish(const CLI::App&, const std::string& command_line) override {
    scene_.finish(o_.scene);
    exports_.finish(o_.exports, o_.scene);
    o_.paper_weights = mode_.value() == trace::Mode::Paper;
    o_.common.command_line = command_line;
    return o_;
  }

 private:
  ExportCommand o_;
  SceneParser scene_;
  ModeParser mode_;
  ExportParser exports_;
};

}  // namespace

std::unique_ptr<CommandParser> export_parser() { return std::make_unique<ExportCommandParser>(); }

}  // namespace atrium::app
