#include "commands.h"
#include "common/interrupt.h"
#include "common/run_main.h"

namespace {

using namespace atrium::app;

struct Run {
  std::stop_token stop;
  int operator()(const Finished& c) const { return c.code; }
  int operator()(const RenderCommand& c) const { return run_render(c, stop); }
  int operator()(const SolveCommand& c) const { return run_solve(c, stop); }
  int operator()(const ExportCommand& c) const { return run_export(c, stop); }
  int operator()(const ReweightCommand& c) const { return run_reweight(c); }
  int operator()(const MeasureCommand& c) const { return run_measure(c, stop); }
  int operator()(const InfoCommand& c) const { return run_info(c, stop); }
  int operator()(const CompareCommand& c) const { return run_compare(c); }
  int operator()(const MaterialEvalCommand& c) const { return run_material_eval(c); }
  int operator()(const MaterialDeriveCommand& c) const { return run_material_derive(c); }
  int operator()(const MaterialListCommand& c) const { return run_material_list(c); }
  int operator()(const MaterialShowCommand& c) const { return run_material_show(c); }
  int operator()(const MaterialCompareCommand& c) const { return run_material_compare(c, stop); }
};

}  // namespace

int main(int argc, char** argv) {
  run_main("atrium", [&] {
    const Command command = parse_command_line(argc, argv);
    if (const auto* finished = std::get_if<Finished>(&command)) return finished->code;
    const std::stop_source interrupts = watch_interrupts();
    return std::visit(Run{interrupts.get_token()}, command);
  });
}
