#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace atrium {

/// What files say, fit for a message or a terminal: white space becomes a space, other control
/// characters (escape sequences begin with one) a question mark.
[[nodiscard]] std::string printable(std::string_view text);

/// Bad input from outside: a file, a scene, a command line. The message is one line that names the
/// place (`file:line:column` where known) and the offending name; whatever the name holds, it is
/// printable(). Programs map it to exit code 2.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string_view message) : std::runtime_error(printable(message)) {}
};

/// Something failed while running that is nobody's input: a full disk, no memory, a missing module.
/// Programs map it to exit code 1.
class RuntimeFailure : public std::runtime_error {
 public:
  explicit RuntimeFailure(std::string_view message) : std::runtime_error(printable(message)) {}
};

}  // namespace atrium
