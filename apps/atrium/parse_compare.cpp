#include "command_parser.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class CompareParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    sub.add_option("image", o_.image, "image to judge")->required()->type_name("FILE");
    sub.add_option("reference", o_.reference,
                   "image taken as true; its stderr.* layers, if any, are accounted for")
        ->required()
        ->type_name("FILE");
    sub.add_option("-o,--output", o_.difference,
                   "difference image: relative error (.exr .pfm), or shown round grey (.png "
                   ".jpg)")
        ->type_name("FILE");
    sub.add_option("--full-scale", o_.full_scale,
                   "relative error that is white or black in 8-bit difference images")
        ->check(CLI::Range(1e-6, 1e6))
        ->capture_default_str();
    sub.add_flag("--json", o_.json, "for programs");
  }

  Command finish(const CLI::App&, const std::string&) override { return o_; }

 private:
  CompareCommand o_;
};

}  // namespace

std::unique_ptr<CommandParser> compare_parser() { return std::make_unique<CompareParser>(); }

}  // namespace atrium::app
