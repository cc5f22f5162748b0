#pragma once

#include <functional>
#include <string>

namespace atrium::app {

/// The body of main(): what is thrown becomes one line "PROGRAM: error: ..." and the exit code, 2
/// for Error, else 1. Leaves without running static destructors: threads of TBB, of image libraries
/// and the one that waits for signals may still use what those would destroy. All files are
/// complete by then.
[[noreturn]] void run_main(const std::string& program, const std::function<int()>& body);

}  // namespace atrium::app
