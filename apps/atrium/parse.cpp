// The command line as a whole; the options of each command are in parse_*.cpp.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "command_parser.h"
#include "common/cli_options.h"
#include "common/suggest.h"
#include "option_text.h"

namespace atrium::app {

namespace {

std::string join(int argc, char** argv) {
  std::string line = "atrium";
  for (int i = 1; i < argc; ++i) line += " " + shell_word(argv[i]);
  return line;
}

/// CLI11 would read a device without end.
std::string config_file(const std::string& file) {
  constexpr std::uintmax_t kMostBytes = 1 << 20;
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown) && !std::filesystem::is_regular_file(file, unknown))
    return file + ": not a file";
  if (!unknown && std::filesystem::file_size(file, unknown) > kMostBytes && !unknown)
    return file + ": larger than " + std::to_string(kMostBytes) + " bytes";
  return {};
}

struct KnownCommand {
  const char* name;
  const char* description;
  std::unique_ptr<CommandParser> (*make)();
};
constexpr KnownCommand kCommands[] = {
    {"render", "render a picture of a scene", render_parser},
    {"solve", "radiosity only, as a mesh or to render later", solve_parser},
    {"export", "files for other programs, of a solution", export_parser},
    {"reweight", "dim the light groups of a solution, without a ray", reweight_parser},
    {"measure", "illuminance or irradiance at points and on grids", measure_parser},
    {"info", "what a file contains, needs and goes without", info_parser},
    {"compare", "error measures between two images", compare_parser},
    {"material", "explore the material model", material_parser}};

/// The parser and the values that it fills.
struct Parser {
  CLI::App app{"Atrium: light in buildings by radiosity and ray tracing", "atrium"};
  std::vector<std::unique_ptr<CommandParser>> commands;  ///< as kCommands
  bool print_config = false;

  Parser() {
    app.set_version_flag("--version", std::string("atrium ") + ATRIUM_VERSION);
    app.set_config("--config", "", "read options from a file as --print-config writes it")
        ->configurable(false)
        ->check(config_file, "FILE");
    app.add_flag("--print-config", print_config, "print all options in effect and leave")
        ->configurable(false);
    app.require_subcommand(1);
    app.fallthrough();
    for (const KnownCommand& c : kCommands) {
      commands.push_back(c.make());
      commands.back()->add_to(*app.add_subcommand(c.name, c.description));
    }
  }

  [[nodiscard]] Command finish(const std::string& command_line) {
    const CLI::App& sub = *app.get_subcommands().front();
    const auto known =
        std::find_if(std::begin(kCommands), std::end(kCommands),
                     [&](const KnownCommand& c) { return sub.get_name() == c.name; });
    return commands[static_cast<std::size_t>(known - kCommands)]->finish(sub, command_line);
  }
};

/// What was given as values, the defaults in effect as comments: read back, an option that was not
/// given still counts as not given when contradictions are looked for.
void print_configuration(const CLI::App& sub, const std::string& section) {
  std::cout << '[' << section << "]\n" << sub.config_to_str(false, false);
  for (const CLI::Option* option : sub.get_options()) {
    if (option->count() > 0 || !option->get_configurable()) continue;
    const bool flag = option->get_expected_max() == 0;
    std::cout << "# " << option->get_single_name() << "="
              << (flag ? "false" : option->get_default_str()) << '\n';
  }
}

/// CLI11 would take a mistyped command for an argument too many.
void check_command(const CLI::App& app, std::string_view word, const std::string& before) {
  if (word.empty() || word.front() == '-') return;
  std::vector<std::string_view> known;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(sub->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw Error(before + std::string(word) + ": unknown command" + suggestion(word, known));
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  Parser p;
  check_command(p.app, argc > 1 ? argv[1] : "", "");
  if (argc > 2 && std::string_view(argv[1]) == "material")
    check_command(*p.app.get_subcommand("material"), argv[2], "material ");
  try {
    p.app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const CLI::App* innermost = &p.app;
    while (!innermost->get_subcommands().empty()) innermost = innermost->get_subcommands().front();
    std::cout << innermost->help();
    return Finished{0};
  } catch (const CLI::CallForVersion& e) {
    std::cout << e.what() << '\n';
    return Finished{0};
  } catch (const CLI::ParseError& e) {
    throw Error(cli::usage_error(e, "atrium"));
  }
  Command command = p.finish(join(argc, argv));
  if (!p.print_config) return command;
  const CLI::App& sub = *p.app.get_subcommands().front();
  if (sub.get_subcommands().empty())
    print_configuration(sub, sub.get_name());
  else
    print_configuration(*sub.get_subcommands().front(),
                        sub.get_name() + "." + sub.get_subcommands().front()->get_name());
  return Finished{0};
}

}  // namespace atrium::app
