#pragma once

#include <string>

#include "options.h"
#include "scene/solution_io.h"
#include "scene/surface_field.h"
#include "session.h"
#include "statistics.h"

namespace atrium::app {

struct RadiosityRun {
  scene::SurfaceField field;
  std::vector<scene::GroupField> groups;  ///< empty with one
  std::vector<char> state;                ///< to go on from
  SolveSummary summary;
};

/// false: this build has no radiosity library (ATRIUM_WITH_OPENMESH was off).
[[nodiscard]] bool radiosity_available();

/// radiosity::coplanar_share(); nothing if not available.
[[nodiscard]] std::optional<double> coplanar_share(const scene::Scene& scene);

/// Does light reach a diffuse surface at all? If not the reason is said in `why`.
[[nodiscard]] bool radiosity_needed(const scene::Features& features, std::string& why);

/// \param time_limit  [s] for this pass, 0: none. \param previous  to go on from.  \throws
/// RuntimeFailure  if not available.
[[nodiscard]] RadiosityRun run_radiosity(Session& session, const LoadedScene& loaded,
                                         const SolveSettings& settings, double time_limit,
                                         const scene::Solution* previous = nullptr);

/// What the numbers of a solution mean; a solution serves only runs that say the same.
[[nodiscard]] std::string describe_lanes(const LoadedScene& loaded, const SolveSettings& settings);

/// For people and for files: what the solution was made with.
[[nodiscard]] std::string describe(const SolveSettings& settings);

}  // namespace atrium::app
