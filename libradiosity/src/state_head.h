#pragma once

#include <cstdint>
#include <string>

#include "light_archive.h"
#include "material/error.h"
#include "material/spectral_basis.h"
#include "radiosity/solve.h"
#include "scene/solution_io.h"
#include "solvers.h"

namespace atrium::radiosity {

/// What SolveResult::state belongs to; it stands in front of what the solver wrote.
struct StateHead {
  static constexpr std::uint32_t kVersion = 2;
  std::uint32_t version = kVersion;
  scene::SceneHashes scene;
  std::string basis, options;
  std::string group_names;          ///< of the light groups
  std::uint64_t group_members = 0;  ///< a number of who belongs to which
  double mesh_error = 0.0;
  std::vector<scene::Light> lights;  ///< for a scene of others to know what has changed

  template <class Archive>
  void archive(Archive& a) {
    a(version);
    if (version != kVersion) throw Error("radiosity: the solution's state is of another version");
    a(scene);
    a(basis);
    a(options);
    a(group_names);
    a(group_members);
    a(mesh_error);
    archive_lights(a, lights);
  }
};

[[nodiscard]] StateHead head_of(const scene::Scene& scene, const material::SpectralBasis& basis,
                                const SolveOptions& options);

/// What has changed from there to here.
/// \throws Error  that says what differs if a solve cannot go on.
[[nodiscard]] Changed check(const StateHead& was, const StateHead& is);

/// The elements of a field: those of level 0, divided as it says.
/// \throws Error  if that is not how they were made.
[[nodiscard]] Elements elements_of(const scene::Scene& scene, Elements elements,
                                   const scene::SurfaceField& field);

}  // namespace atrium::radiosity
