#include "command_parser.h"
#include "option_text.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class ReweightParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    sub.add_option("solution", o_.solution, "of atrium solve, with light groups")
        ->required()
        ->type_name("FILE.atrium");
    cli::add_repeatable(sub, "--set", factors_,
                        "factor of a group's light as it was solved, others stay", "NAME=FACTOR")
        ->required();
    sub.add_option("-o,--output", o_.output, "dimmed solution")
        ->required()
        ->type_name("FILE.atrium");
  }

  Command finish(const CLI::App&, const std::string&) override {
    for (const std::string& text : factors_) o_.factors.push_back(parse_factor("--set", text));
    return o_;
  }

 private:
  ReweightCommand o_;
  std::vector<std::string> factors_;
};

}  // namespace

std::unique_ptr<CommandParser> reweight_parser() { return std::make_unique<ReweightParser>(); }

}  // namespace atrium::app
