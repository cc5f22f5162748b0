#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "common/phases.h"
#include "common/progress.h"
#include "options.h"
#include "scene/control.h"
#include "scene/features.h"
#include "scene/parallel.h"
#include "scene/ray_query.h"

namespace atrium::app {

/// One run of the program: its clock, its progress, its threads, its way to be stopped.
class Session {
 public:
  Session(const CommonOptions& options, std::stop_token stop);

  Progress progress;
  PhaseClock clock;

  [[nodiscard]] const CommonOptions& options() const { return options_; }
  [[nodiscard]] bool interrupted() const { return stop_.stop_requested(); }
  /// For a library call; `phase` is what its time counts as (radiosity: also "mesh", "direct").
  [[nodiscard]] scene::Control control(const std::string& phase);
  /// Only with --verbose.
  void detail(const std::string& line);

 private:
  CommonOptions options_;
  std::stop_token stop_;
  scene::ThreadLimit threads_;
};

/// A scene ready for work.
struct LoadedScene {
  std::unique_ptr<scene::Scene> scene;  // the query keeps a reference to it
  std::unique_ptr<scene::RayQuery> query;
  scene::Features features;
  material::SpectralBasis basis = material::SpectralBasis::grey();
  std::string basis_reason;        ///< why this basis, one line
  std::vector<std::size_t> views;  ///< the cameras asked for, by index
};

/// Which cameras --camera means: numbers into `cameras`.
/// \param request  name, number, "all", or empty: the first one, none if there is none.
/// \throws Error  that lists what is there.
[[nodiscard]] std::vector<std::size_t> select_cameras(const std::string& request,
                                                      const std::vector<scene::Camera>& cameras);

struct LoadSettings {
  std::string camera = {};    ///< as --camera
  bool follow_view = false;   ///< tessellate subdivision surfaces for the one camera asked for
  bool show_warnings = true;  ///< on stderr
  double memory_limit = 0.0;  ///< [MB] for geometry and textures; 0: none
};

/// Reads, repairs, indexes.
[[nodiscard]] LoadedScene load_scene(Session& session, const SceneOptions& options,
                                     const LoadSettings& settings);

}  // namespace atrium::app
