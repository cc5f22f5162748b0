#pragma once

#include <stdexcept>
#include <string>

namespace atrium {

/// Bad input from outside: a file, a scene, a command line. The message is one line that names the
/// place (`file:line:column` where known) and the offending name. Programs map it to exit code 2.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something failed while running that is nobody's input: a full disk, no memory, a missing module.
/// Programs map it to exit code 1.
class RuntimeFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace atrium
