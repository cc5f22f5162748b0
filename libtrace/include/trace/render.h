#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "material/spectral_basis.h"
#include "scene/camera.h"
#include "scene/control.h"
#include "scene/counters.h"
#include "scene/image.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::trace {

enum class Method {
  Hybrid,  ///< direct light and specular paths traced, diffuse inter-reflection from the field
  Path,    ///< unbiased path tracing of the same scene: the reference
  Direct   ///< direct light and specular paths only
};
enum class Mode {
  Radiometric,  ///< energy-conserving BSDFs
  Paper         ///< Hansmann & Warncke 1998, terms C1..C6 literally
};
/// How the hybrid finds C2/C6 at a visible diffuse point.
enum class Indirect {
  Mesh,   ///< interpolated field
  Gather  ///< hemisphere rays that read the field where they end
};

struct RenderOptions {
  Method method = Method::Hybrid;
  Mode mode = Mode::Radiometric;
  Indirect indirect = Indirect::Gather;
  int width = 640;
  int height = 480;
  std::array<double, 4> crop{0.0, 0.0, 1.0, 1.0};  ///< x0, y0, x1, y1 as shares of the image
  int samples = 64;                                ///< camera samples per pixel
  double time_limit = 0.0;  ///< [s], looked at between passes over the image; 0: none
  std::uint64_t seed = 1;
  int max_specular_depth = 64;  ///< mirror and glass events of one path (hybrid, paper)
  /// Average body light over neighbouring pixels of one surface as far as their noise allows (not
  /// in Method::Path or paper mode). Its bias is not estimated yet: stderr.* is the noise alone.
  bool share_samples = true;
  bool components = false;  ///< layers C1..C6 and emission
};

struct RenderResult {
  /// Linear. Always R,G,B, albedo.*, normal.*, depth.Z, irradiance.*, stderr.*; with
  /// components C1.R ... C6.B and emission.*, whose sum is R,G,B.
  scene::Image image;
  scene::Counters counters;
  int samples_done = 0;         ///< per pixel, smallest
  double error_estimate = 0.0;  ///< RMS of stderr.* over pixels, relative to the mean of the image
  bool complete = true;         ///< false: stopped by time or request
};

/// Renders one view. Deterministic for a scene, options and seed at any thread count (time limits
/// and interrupts apart).
/// \param field  may be empty: then there is no diffuse inter-reflection. Method::Hybrid only.
[[nodiscard]] RenderResult render(const scene::RayQuery& query,
                                  const material::SpectralBasis& basis, const scene::Camera& camera,
                                  const scene::SurfaceField& field, const RenderOptions& options,
                                  const scene::Control& control = {});

}  // namespace atrium::trace
