#include "command_parser.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

class SolveParser : public CommandParser {
 public:
  void add_to(CLI::App& sub) override {
    scene_.add(sub, o_.scene);
    cli::add_repeatable(sub, "-o,--output", o_.outputs,
                        "result: .vtp .vtu (mesh with arrays), .glb .html (to look at), .atrium "
                        "(for render --solution, export)",
                        "FILE")
        ->required();
    solver_.add(sub, o_.solve);
    sub.add_option(
           "--solution", o_.solution,
           "go on from this solution: interrupted, or of other lights or diffuse reflectances")
        ->type_name("FILE.atrium");
    sub.add_flag("--keep-rows", o_.solve.keep_rows,
                 "store the rows in .atrium too: larger, but later runs need not trace them again");
    sub.add_flag("--light-groups", light_groups_,
                 "keep the light of each lamp name apart, for reweight; default: of each "
                 "light_group that the scene names");
    cli::add_error(sub, o_.solve.error);
    mode_.add(sub);
    exports_.add(sub, o_.exports);
    add_common(sub, o_.common);
  }

  Command finish(const CLI::App&, const std::string& command_line) override {
    scene_.finish(o_.scene);
    solver_.finish(o_.solve);
    const bool rows = o_.solve.solver == SolverChoice::Rows;
    o_.solve.paper_weights = mode_.value() == trace::Mode::Paper;
    o_.solve.light_groups = light_groups_ ? scene::Grouping::ByName
                            : rows        ? scene::Grouping::Declared
                                          : scene::Grouping::One;
    if (!o_.solution.empty() && !rows)
      throw Error("--solution: only --solver rows can go on from a solution");
    o_.common.command_line = command_line;
    exports_.finish(o_.exports, o_.scene);
    return o_;
  }

 private:
  SolveCommand o_;
  SceneParser scene_;
  SolverParser solver_;
  ModeParser mode_;
  ExportParser exports_;
  bool light_groups_ = false;
};

}  // namespace

std::unique_ptr<CommandParser> solve_parser() { return std::make_unique<SolveParser>(); }

}  // namespace atrium::app
