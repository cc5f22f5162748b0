#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "material/spectral_basis.h"
#include "scene/ray_query.h"
#include "scene/scene.h"
#include "scene/shading.h"

namespace atrium::bench {

/// A scene that is measured: grey, whatever its colours.
class Workload {
 public:
  /// \throws Error  as read_model() and build_scene().
  explicit Workload(const std::filesystem::path& file);
  Workload(std::string name, scene::Model model);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  [[nodiscard]] const scene::RayQuery& query() const { return query_; }
  [[nodiscard]] const scene::Shading<1>& shading() const { return shading_; }
  [[nodiscard]] static material::SpectralBasis basis() { return material::SpectralBasis::grey(); }
  /// Mirrors, panes or lobes: the solvers `matrix` and `shooting` refuse those.
  [[nodiscard]] bool specular() const;

 private:
  std::string name_;
  scene::Scene scene_;
  scene::RayQuery query_;
  scene::Shading<1> shading_;
};

/// The same scene with every diffuse surface almost black (1e-6): its irradiance is the direct
/// part.
[[nodiscard]] scene::Model darkened(scene::Model model);

}  // namespace atrium::bench
