#include "common/interrupt.h"
#include "common/run_main.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace atrium::view;
  atrium::app::run_main("atrium-view", [&] {
    const auto command = parse_command_line(argc, argv);
    if (const auto* finished = std::get_if<Finished>(&command)) return finished->code;
    const std::stop_source interrupts = atrium::app::watch_interrupts();
    return run_view(std::get<ViewCommand>(command), interrupts.get_token());
  });
}
