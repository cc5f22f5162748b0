#include "common/cli_options.h"

namespace atrium::app::cli {

CLI::Option* add_repeatable(CLI::App& app, const std::string& name,
                            std::vector<std::string>& values, const std::string& description,
                            const std::string& type) {
  return app.add_option(name, values, description + ", may be repeated")
      ->type_name(type)
      ->allow_extra_args(false);
}

void add_threads(CLI::App& app, int& threads) {
  app.add_option("--threads", threads, "threads; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

CLI::Option* add_quiet(CLI::App& app, bool& quiet) {
  return app.add_flag("--quiet,-q", quiet, "no progress; warnings stay");
}

void add_seed(CLI::App& app, std::uint64_t& seed) {
  app.add_option("--seed", seed, "of all random numbers")->capture_default_str();
}

void add_time_limit(CLI::App& app, double& seconds) {
  app.add_option("--time-limit", seconds, "stop computing after this time [s]; 0: none")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
}

void add_error(CLI::App& app, double& error) {
  app.add_option("--error", error,
                 "go on until the RMS of irradiance is below this share of it (0.02: 2 %); 0: the "
                 "effort of --quality. Solver rows only")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

void QualityOption::add(CLI::App& app) {
  app.add_option("--quality", text_, "effort: draft, normal or high")
      ->check(CLI::IsMember({"draft", "normal", "high"}))
      ->capture_default_str();
}

Quality QualityOption::value() const {
  return choose<Quality>(
      text_, {{"draft", Quality::Draft}, {"normal", Quality::Normal}, {"high", Quality::High}});
}

void ModelOptions::add(CLI::App& app) {
  app.add_option("--emissive-unit", emissive_unit_,
                 "what emissive numbers of models are: nit, or radiance in W/(sr m^2)")
      ->check(CLI::IsMember({"nit", "radiance"}))
      ->capture_default_str();
  app.add_flag("--no-pane-detection", no_pane_detection_,
               "keep closed solids with two parallel faces as solids");
}

double ModelOptions::nits_per_emissive_unit() const {
  // 179 lm/W: the luminous efficacy of white light where watts have to become lumens.
  return emissive_unit_ == "radiance" ? 179.0 : 1.0;
}

std::string usage_error(const CLI::ParseError& error, const std::string& program) {
  const std::string text = error.what();
  return text.substr(0, text.find('\n')) + " (see " + program + " --help)";
}

}  // namespace atrium::app::cli
