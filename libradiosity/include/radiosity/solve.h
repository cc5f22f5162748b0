#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "material/spectral_basis.h"
#include "radiosity/elements.h"
#include "radiosity/memory_use.h"
#include "scene/camera.h"
#include "scene/control.h"
#include "scene/counters.h"
#include "scene/light_groups.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::radiosity {

enum class Solver {
  Rows,      ///< sparse hemisphere rows, solved at memory speed, then streamed gathering
  Shooting,  ///< classic progressive refinement (Cohen et al. 1988), point-to-polygon factors
  Matrix     ///< dense rows with many rays, solved directly (Eigen); reference for small scenes
};

/// What a solve hands over so that a later one can go on.
enum class Keep {
  Nothing,
  Samples,  ///< sums of samples; rows are traced again
  Rows      ///< and the rows, about 16 bytes per ray
};

/// A picture that will be made of a solution.
struct View {
  scene::Camera camera;
  double aspect = 4.0 / 3.0;                       ///< width / height of the whole picture
  std::array<double, 4> crop{0.0, 0.0, 1.0, 1.0};  ///< x0, y0, x1, y1: the part that is wanted
};

/// What a solve knows so far, complete: light that is still on its way is spread as ambient light
/// over what is lit.
struct Snapshot {
  const Elements& elements;
  const scene::SurfaceField& field;
  const std::vector<scene::GroupField>& groups;  ///< as SolveResult::groups
  double error_estimate = 0.0;  ///< as SolveResult::error_estimate; 0: not known yet
};

struct SolveOptions {
  Solver solver = Solver::Rows;
  double element_size = 0.0;           ///< [m] edge of an element; 0: from max_elements
  std::uint32_t max_elements = 60000;  ///< about; large scenes get larger elements
  int max_level = 3;        ///< how often an element may be halved where light changes; 0: never
  double mesh_error = 0.0;  ///< RMS that interpolation of direct light may miss, as a share of the
                            ///< irradiance, before elements are divided; 0: 0.7 error, or 3 %
  int row_rays = 64;        ///< hemisphere rays per element side kept as a row
  int gather_rays = 128;    ///< further rays per element side, streamed against the solution
  int direct_samples = 16;  ///< light samples per element side
  std::uint64_t caustic_photons =
      1000000;  ///< only traced where the scene has mirrors, solids, lobes
  /// Asked for RMS of the relative standard error of total irradiance over the area, with a floor
  /// of 1 % of the mean irradiance; 0: the fixed numbers of samples above.
  double error = 0.0;
  int max_iterations = 200;
  double tolerance = 1e-4;  ///< of the iteration, relative to the largest radiosity
  double time_limit = 0.0;  ///< [s]; 0: none
  /// [bytes] that the scene, its BVH and the solve may hold together, see MemoryUse; 0: none. Fewer
  /// elements, then shorter rows and fewer photons, keep below it.
  std::uint64_t memory_limit = 0;
  std::uint64_t seed = 1;
  Keep keep = Keep::Nothing;  ///< solver Rows only
  /// If nothing but pictures of these views will use the solution: surfaces that none of them sees,
  /// nor light straight from, get fewer samples, and errors are weighted by what they matter.
  /// Solver Rows with keep Nothing only. Empty: every surface matters.
  std::vector<View> views = {};
  scene::Grouping light_groups = scene::Grouping::One;  ///< more than one: solver Rows only
  bool paper_weights = false;  ///< scene::Weights::Paper: for pictures in paper mode
  int probes = 0;              ///< points of the Certificate; 0: none is made
  /// Called by the thread that solves, after direct light, caustics, rows and every round of
  /// samples, or now and then while patches are shot; what it is given lives for the call. Changes
  /// no bit of the result.
  std::function<void(const Snapshot&)> watch = {};
};

/// Flux [lanes' unit * m^2], lane means; emitted = absorbed + escaped + in_medium within their
/// errors.
struct FluxBalance {
  double emitted = 0.0;    ///< by the lights
  double absorbed = 0.0;   ///< counted at the surfaces
  double escaped = 0.0;    ///< counted at rays that leave the scene
  double in_medium = 0.0;  ///< counted where the air absorbs (Scene::medium_extinction)
  double standard_error = 0.0;
};

/// What points measured by path tracing, which knows nothing of elements or of the solution, say of
/// the interpolated field. Errors are relative to the irradiance that was measured, with the floor
/// of SolveOptions::error; points lie on the lit sides, uniform by area. Intervals are of 95 %.
struct Certificate {
  enum class Verdict {
    Met,         ///< the whole interval of the RMS is below the target
    NotMet,      ///< ... above the target
    NotResolved  ///< more probes are needed to say
  };
  int probes = 0;           ///< that were measured; 0: everything below means nothing
  double target = 0.0;      ///< SolveOptions::error; without one what the solution claims of itself
  double bias = 0.0;        ///< mean signed error
  double bias_error = 0.0;  ///< half the width of its interval
  double rms = 0.0, rms_low = 0.0, rms_high = 0.0;  ///< the probes' own noise taken off
  double largest = 0.0;      ///< of the absolute errors, with the probe's noise
  double probe_noise = 0.0;  ///< RMS of the probes' own standard errors
  Verdict verdict = Verdict::NotResolved;
  std::vector<std::string> not_sampled;  ///< light that the probes took from the solution
  std::uint64_t rays = 0;                ///< traced for it
};
/// "met", "not met", "not resolved".
[[nodiscard]] std::string_view verdict_name(Certificate::Verdict verdict);

struct SolveResult {
  Elements elements;  ///< geometry of the elements (layout without values)
  scene::SurfaceField field;
  std::vector<scene::GroupField> groups;  ///< whose sum the field is; empty with one group
  /// To go on from with the field's elements; empty if not asked for, or stopped before there was
  /// anything. For this version of the library.
  std::vector<char> state;
  scene::Counters counters;  ///< of this solve alone
  FluxBalance flux;
  double residual = 0.0;  ///< last change of radiosity, relative to its maximum
  int iterations = 0;
  double error_estimate = 0.0;  ///< RMS of the relative standard error of irradiance over the area
  /// RMS of what interpolation over the elements misses, estimated: direct light also within
  /// elements, indirect light between them. Solver Rows; 0 if others solved.
  double mesh_error = 0.0;
  double mesh_target = 0.0;  ///< that elements were divided for: SolveOptions::mesh_error
  Certificate certificate;  ///< if SolveOptions::probes asked for one
  MemoryUse memory;
  /// What SolveOptions::memory_limit made smaller, one line each: "1000 elements instead of 60000".
  std::vector<std::string> given_up;
  bool complete = true;  ///< false: stopped by time or request; the field is usable all the same
  /// "interrupt", "time limit"; "memory limit": the solve went to its end, but `given_up` says with
  /// what less; "iterations"; if an error was asked for "error" (reached) or "rounds" (not), else
  /// "tolerance"
  std::string stopped_by;
};

/// Where another solve left off.
struct Previous {
  const scene::SurfaceField& field;  ///< its elements
  const std::vector<char>& state;
};

/// Solves diffuse inter-reflection, also through panes, mirrors, solids and rough lobes.
/// \throws Error  if a closed enclosure reflects everything (no finite solution), or a solver that
/// knows no light groups finds several.
/// \throws std::invalid_argument  if views are given for a solution that is kept or another solver.
/// \throws RuntimeFailure  if the memory limit does not even hold the scene.
[[nodiscard]] SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                                const SolveOptions& options = {},
                                const scene::Control& control = {});

/// The same, going on from an earlier solve.
///
/// Of the same scene: an interrupted solve goes on where it was, and ends with the bits of one that
/// was not interrupted (the chunk of samples, or the photons, that it was drawing are drawn again).
/// A finished one takes the samples that a smaller SolveOptions::error needs.
///
/// Of a scene where only diffuse reflectances differ (scene::SceneHashes): elements, direct light,
/// caustics and, if they were kept, rows stay. Rows are traced again if that concerns patches that
/// were shot (their light is in the rows).
///
/// Of a scene where lights, the environment or what surfaces emit differ: elements stay, and are
/// divided further where the new light asks for it; light straight from the lights and caustics are
/// sampled anew, rows stay or are traced again, and samples of inter-reflection stay where the rows
/// know well enough what has changed for them, else they are drawn again. Interrupted before that
/// is done, it leaves no state.
///
/// \throws Error  that says what differs, if the state is damaged or of other geometry or other
/// materials, another basis or other options than error, time_limit, tolerance, max_iterations and
/// keep.
[[nodiscard]] SolveResult solve(const scene::RayQuery& query, const material::SpectralBasis& basis,
                                const SolveOptions& options, const scene::Control& control,
                                const Previous& previous);

/// Measures a field that solve() returned, or what was made of it since.
/// \param solved  elements and field. Its errors are the target if the options ask for none.
/// \throws std::invalid_argument  if the field's lanes are not the basis'.
[[nodiscard]] Certificate certify(const scene::RayQuery& query,
                                  const material::SpectralBasis& basis, const SolveResult& solved,
                                  const SolveOptions& options, const scene::Control& control = {});

}  // namespace atrium::radiosity
