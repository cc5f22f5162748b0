#pragma once

#include <memory>
#include <string>

#include "options.h"

namespace CLI {
class App;
}

namespace atrium::app {

/// The options of one command and the values that they fill. One file each, parse_*.cpp.
class CommandParser {
 public:
  virtual ~CommandParser() = default;

  virtual void add_to(CLI::App& sub) = 0;
  /// After parsing. \param command_line  as typed. \throws Error  for contradictions.
  [[nodiscard]] virtual Command finish(const CLI::App& sub, const std::string& command_line) = 0;
};

[[nodiscard]] std::unique_ptr<CommandParser> render_parser();
[[nodiscard]] std::unique_ptr<CommandParser> solve_parser();
[[nodiscard]] std::unique_ptr<CommandParser> export_parser();
[[nodiscard]] std::unique_ptr<CommandParser> reweight_parser();
[[nodiscard]] std::unique_ptr<CommandParser> measure_parser();
[[nodiscard]] std::unique_ptr<CommandParser> info_parser();
[[nodiscard]] std::unique_ptr<CommandParser> compare_parser();
[[nodiscard]] std::unique_ptr<CommandParser> material_parser();

}  // namespace atrium::app
