#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "material/spectral_basis.h"
#include "scene/ray_query.h"
#include "scene/scene.h"
#include "scene/surface_field.h"
#include "trace/compare.h"
#include "trace/render.h"

namespace atrium::bench {

struct SolveEffort {
  double error = 0.0;       ///< of irradiance; 0: the numbers of --quality normal
  double mesh_error = 0.0;  ///< 0: from the error
  std::uint32_t max_elements = 60000;
};

/// A scene as `atrium render` sees it: its first camera and the lanes that it needs.
class PictureScene {
 public:
  /// \throws Error  as read_model() and build_scene(); without a camera.
  PictureScene(const std::filesystem::path& file, std::array<int, 2> size);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Radiosity for this view.
  [[nodiscard]] scene::SurfaceField solve(const SolveEffort& effort, std::uint64_t seed) const;
  /// \param options  width and height are set here.
  [[nodiscard]] trace::RenderResult render(trace::RenderOptions options,
                                           const scene::SurfaceField& field) const;
  /// Many samples without sharing, kept in a file: made if it is not there.
  [[nodiscard]] scene::Image reference(const std::filesystem::path& file, trace::Method method,
                                       int samples, const scene::SurfaceField& field) const;

 private:
  std::string name_;
  std::array<int, 2> size_;
  scene::Scene scene_;
  scene::RayQuery query_;
  material::SpectralBasis basis_;
};

/// A picture with its cost and its error against a reference.
struct Trial {
  trace::Comparison found;
  double estimate = 0.0, block_estimate = 0.0;
  double samples = 0.0;  ///< of a pixel, mean
  double rays = 0.0;
  double cpu = 0.0;  ///< [s]
};
[[nodiscard]] Trial try_picture(const PictureScene& scene, const scene::SurfaceField& field,
                                const scene::Image& reference, const trace::RenderOptions& options);

}  // namespace atrium::bench
