#pragma once

#include "common/cli_options.h"
#include "options.h"

// Options that several commands of `atrium` have. Each is added before and finished after parsing.
namespace atrium::app {

void add_common(CLI::App& app, CommonOptions& o);

/// What scenes are made of.
class SceneParser {
 public:
  void add(CLI::App& app, SceneOptions& o);
  void finish(SceneOptions& o) const;

 private:
  cli::ModelOptions model_;
};

/// How radiosity is solved.
class SolverParser {
 public:
  void add(CLI::App& app, SolveSettings& o);
  /// \throws Error.
  void finish(SolveSettings& o) const;

 private:
  cli::QualityOption quality_{"normal"};
  std::string solver_ = "rows";
};

/// --mode radiometric|paper.
class ModeParser {
 public:
  void add(CLI::App& app);
  [[nodiscard]] trace::Mode value() const;

 private:
  std::string text_ = "radiometric";
};

/// How .glb and .html are written.
class ExportParser {
 public:
  void add(CLI::App& app, ExportSettings& o);
  void finish(ExportSettings& o, const SceneOptions& scene) const;

 private:
  std::string exposure_ = "auto";
};

}  // namespace atrium::app
