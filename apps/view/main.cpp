#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "common/interrupt.h"
#include "material/error.h"
#include "run.h"

namespace {

int fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "atrium-view: error: %s\n", message.c_str());
  return code;
}

int run(int argc, char** argv) {
  using namespace atrium::view;
  try {
    const auto command = parse_command_line(argc, argv);
    if (const auto* finished = std::get_if<Finished>(&command)) return finished->code;
    const std::stop_source interrupts = atrium::app::watch_interrupts();
    return run_view(std::get<ViewCommand>(command), interrupts.get_token());
  } catch (const atrium::Error& e) {
    return fail(2, e.what());
  } catch (const std::bad_alloc&) {
    return fail(1, "out of memory");
  } catch (const std::exception& e) {
    return fail(1, e.what());
  }
}

}  // namespace

/// Leaves without running static destructors: threads of TBB and the one that waits for signals may
/// still use what those would destroy. All files are complete by then.
int main(int argc, char** argv) {
  const int code = run(argc, argv);
  std::fflush(nullptr);
  std::_Exit(code);
}
