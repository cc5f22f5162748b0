#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/effort.h"
#include "picker.h"
#include "scene/light_groups.h"

// What the command line says, as values. Every default exists once: here.
namespace atrium::view {

/// Which side of surfaces is shown.
enum class ShownSide {
  Seen,  ///< the one that faces the viewer
  Front,
  Back
};

/// Contours: about so many round values, or exactly these.
struct ContourChoice {
  int count = 0;
  std::vector<double> levels;
  [[nodiscard]] bool any() const { return count > 0 || !levels.empty(); }
  friend bool operator==(const ContourChoice&, const ContourChoice&) = default;
};

/// How the mesh is shown.
struct LookOptions {
  std::string field;   ///< name; empty: the first that suits
  std::string camera;  ///< as choose_view() reads it
  std::optional<std::array<double, 2>> range;
  bool logarithmic = false;
  std::optional<double> ev;  ///< absent: automatic
  ContourChoice contours;
  std::vector<Clip> clips;
  bool flat = false, edges = false, cull = false, no_ceilings = false, no_legend = false;
  std::vector<std::string> hidden;  ///< selections as text
  ShownSide side = ShownSide::Seen;
  std::vector<std::pair<std::string, double>> weights;  ///< of light groups
};

/// How a scene is solved.
struct SolveChoice {
  bool shooting = false;  ///< solver 'shooting' instead of 'rows'
  app::Quality quality = app::Quality::Draft;
  double error = 0.0;       ///< asked for; 0: the effort of the quality
  double time_limit = 0.0;  ///< [s]; 0: none
  std::uint64_t seed = 1;
  scene::Grouping groups = scene::Grouping::Declared;
  double nits_per_emissive_unit = 1.0;
  bool pane_detection = true;
};

struct ViewCommand {
  std::vector<std::string> files;  ///< a mesh or solution, and scenes
  LookOptions look;
  SolveChoice solve;
  bool live = false;       ///< show the solution while it converges
  std::string screenshot;  ///< empty: a window
  std::array<int, 2> size{1024, 768};
  std::string statistics;  ///< selection; empty: none
  int measure_frames = 0;
  int threads = 0;  ///< 0: one per core
  bool quiet = false;
};

/// Nothing left to do but to leave with a code (help, version).
struct Finished {
  int code = 0;
};

/// \throws Error  on wrong usage, one line.
[[nodiscard]] std::variant<Finished, ViewCommand> parse_command_line(int argc, char** argv);

}  // namespace atrium::view
