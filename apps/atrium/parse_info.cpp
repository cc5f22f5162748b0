#include "command_parser.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class InfoParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    scene_.add(sub, o_.scene);
    sub.get_option("scene")->description(
        "scene files, put together; or one luminaire (.ies .ldt), image, radiosity mesh (.vtp "
        ".vtu) or solution (.atrium)");
    sub.add_flag("--json", o_.json, "for programs");
  }

  Command finish(const CLI::App&, const std::string&) override {
    scene_.finish(o_.scene);
    return o_;
  }

 private:
  InfoCommand o_;
  SceneParser scene_;
};

}  // namespace

std::unique_ptr<CommandParser> info_parser() { return std::make_unique<InfoParser>(); }

}  // namespace atrium::app
