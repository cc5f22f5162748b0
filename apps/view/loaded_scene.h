#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "material/spectral_basis.h"
#include "options.h"
#include "scene/ray_query.h"
#include "view_point.h"

namespace atrium::view {

/// A scene ready to be solved, with its cameras.
struct LoadedScene {
  std::unique_ptr<scene::Scene> scene;  // the query keeps a reference to it
  std::unique_ptr<scene::RayQuery> query;
  material::SpectralBasis basis = material::SpectralBasis::grey();
  std::vector<ViewPoint> views;  ///< the scene's cameras, else one that is chosen
};

/// \throws Error.
[[nodiscard]] LoadedScene load_scene(const std::vector<std::string>& files,
                                     const SolveChoice& options);

/// What loading warned of: the first ten lines.
void warn_of_scene(const scene::Scene& scene, const std::function<void(const std::string&)>& warn);

/// Triangles of the surfaces that will have elements, with materials and objects, without light.
[[nodiscard]] Mesh bare_mesh(const LoadedScene& loaded);

/// \throws Error  why there is nothing to solve.
void require_light(const LoadedScene& loaded);

}  // namespace atrium::view
