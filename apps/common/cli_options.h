#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "common/effort.h"
#include "material/error.h"

// Options that several programs have, with the same names, limits and words.
namespace atrium::app::cli {

/// The value that a word stands for; the option's own check has refused all others.
template <class T>
T choose(const std::string& text, std::initializer_list<std::pair<const char*, T>> known) {
  for (const auto& [name, value] : known)
    if (text == name) return value;
  throw Error(text + ": unknown choice");
}

/// May be repeated and takes one value per mention: a file that follows is a file.
CLI::Option* add_repeatable(CLI::App& app, const std::string& name,
                            std::vector<std::string>& values, const std::string& description,
                            const std::string& type);

void add_threads(CLI::App& app, int& threads);
CLI::Option* add_quiet(CLI::App& app, bool& quiet);
void add_seed(CLI::App& app, std::uint64_t& seed);
void add_time_limit(CLI::App& app, double& seconds);
void add_error(CLI::App& app, double& error);

/// --quality.
class QualityOption {
 public:
  /// \param name  of the effort without the option.
  explicit QualityOption(std::string name) : text_(std::move(name)) {}
  void add(CLI::App& app);
  [[nodiscard]] Quality value() const;

 private:
  std::string text_;
};

/// --emissive-unit and --no-pane-detection: how models are read.
class ModelOptions {
 public:
  void add(CLI::App& app);
  [[nodiscard]] double nits_per_emissive_unit() const;
  [[nodiscard]] bool pane_detection() const { return !no_pane_detection_; }

 private:
  std::string emissive_unit_ = "nit";
  bool no_pane_detection_ = false;
};

/// One line for people. \param program  whose --help says more.
[[nodiscard]] std::string usage_error(const CLI::ParseError& error, const std::string& program);

}  // namespace atrium::app::cli
