#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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

/// What kinds of paths Method::Path joins.
enum class PathKind {
  Needed,   ///< as choose_strategy() has it
  FromEye,  ///< from the eye alone: lights are hit or sampled
  BothEnds  ///< from the eye and from lights
};

struct RenderOptions {
  Method method = Method::Hybrid;
  Mode mode = Mode::Radiometric;
  Indirect indirect = Indirect::Gather;
  PathKind paths = PathKind::Needed;
  int width = 640;
  int height = 480;
  std::array<double, 4> crop{0.0, 0.0, 1.0, 1.0};  ///< x0, y0, x1, y1 as shares of the image
  int samples = 64;  ///< camera samples per pixel; with an error asked for the most of a pixel
  /// Without an error asked for: `samples` is the mean, and pixels get them where they lower the
  /// error of the picture most.
  bool spread = false;
  /// RMS of the picture's relative error (trace/compare.h) to reach, per pixel and after averaging
  /// 8x8 pixels, by more samples where they lower it most; 0: not asked for. With both zero every
  /// pixel gets `samples`.
  double error = 0.0, block_error = 0.0;
  /// The share of the error asked for that the field's own may have: a picture where it is found to
  /// be larger stops by "radiosity". 1: only if samples cannot make up for it (99.9 % certain).
  double field_share = 1.0;
  /// What the field's own error is expected to be, as a share of the error asked for. Checks are
  /// noisy: the less certain they are, the more this counts in the estimate. Infinity: not known.
  double field_expected = std::numeric_limits<double>::infinity();
  /// Which numbers check the field: others for another field, so that what one of them found by
  /// chance is not found again.
  std::uint64_t check_seed = 0;
  double time_limit = 0.0;  ///< [s], looked at between passes over the image; 0: none
  std::uint64_t seed = 1;
  int max_specular_depth = 64;  ///< mirror and glass events of one path (paper mode)
  /// Average body light over neighbouring pixels of one surface as far as their noise allows (not
  /// in Method::Path or paper mode).
  bool share_samples = true;
  bool components = false;  ///< layers C1..C6 and emission
  bool classes = false;     ///< layers by class of light paths (trace/light_classes.h)
  /// Takes what a later rendering needs to go on as if there had been no end: about once a minute
  /// and at the end. Method::Path only.
  std::function<void(const std::vector<char>& state)> save_state = {};
  /// State to go on from, of the same scene, basis, camera and options (samples, errors and time
  /// limit apart); null: from the beginning. Method::Path only.
  const std::vector<char>* state = nullptr;
  /// Shown the picture so far between passes over the image, at most every preview_seconds; empty:
  /// none is made. Changes nothing of the result.
  std::function<void(const scene::Image&)> preview = {};
  double preview_seconds = 2.0;
};

struct RenderResult {
  /// Linear. Always R,G,B, albedo.*, normal.*, depth.Z, irradiance.*, samples.N (of the pixel),
  /// stderr.* (RMS error, also by sharing between pixels, smoothed over 5x5 pixels; 0 below 4
  /// samples); with components C1.R ... C6.B and emission.*, whose sum is R,G,B; with classes
  /// LE.R ... LDDDSE.B, whose sum is R,G,B, and stderr.LE.Y ... of their luminance, unsmoothed.
  scene::Image image;
  scene::Counters counters;
  int samples_done = 0;               ///< per pixel, smallest
  double samples_mean = 0.0;          ///< per pixel
  int rounds = 0;                     ///< after the first samples of every pixel, towards an error
  double error_estimate = 0.0;        ///< RMS of the relative error per pixel (trace/compare.h)
  double bias_estimate = 0.0;         ///< its part that sharing between pixels causes
  double field_error_estimate = 0.0;  ///< its part by the field; 0 without an error asked for
  double block_error_estimate = 0.0;  ///< after averaging 8x8 pixels
  /// How many times the error asked for the field's own certainly is (99.9 %), the worse of pixels
  /// and blocks; 0 if it may be nothing.
  double field_excess = 0.0;
  /// "error" (reached), "radiosity" (the field's own error is too large, see field_share),
  /// "samples", "time limit", "interrupt"
  std::string stopped_by;
  bool complete = true;  ///< false: stopped by time or request
};

/// Renders one view. Deterministic for a scene, options and seed at any thread count (time limits
/// and interrupts apart).
/// \throws Error  for a state that does not fit.
/// \throws std::invalid_argument  also for classes that cannot be told apart: Indirect::Mesh with a
/// field, paper mode.
/// \param field  may be empty: then there is no diffuse inter-reflection. Method::Hybrid only.
[[nodiscard]] RenderResult render(const scene::RayQuery& query,
                                  const material::SpectralBasis& basis, const scene::Camera& camera,
                                  const scene::SurfaceField& field, const RenderOptions& options,
                                  const scene::Control& control = {});

}  // namespace atrium::trace
