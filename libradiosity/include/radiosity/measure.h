#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "material/spectral_basis.h"
#include "scene/control.h"
#include "scene/counters.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::radiosity {

/// A small plane receiver that light does not notice.
struct Sensor {
  Vec3d position;  ///< world coordinates [m]
  Vec3d normal;    ///< unit; light from this side counts
};

struct MeasureOptions {
  /// Standard error asked for at each sensor, as a share of its irradiance (or of a hundredth of
  /// the mean of the scene's surfaces where that is more); > 0.
  double error = 0.01;
  std::uint32_t max_rays = 1U << 17;  ///< of a sensor and kind of light; the error may then be more
  std::uint64_t seed = 1;
};

/// Irradiance [unit of the scene: lx or W/m^2].
struct Amount {
  std::array<double, kMaxLanes> lanes{};
  double y = 0.0;               ///< luminance-weighted sum of the lanes: in scenes in nits, lux
  double standard_error = 0.0;  ///< of y, from the spread of the samples; 0: they all agreed
};

struct Reading {
  bool valid = false;       ///< false: inside a solid, or not measured as the run was stopped
  bool on_surface = false;  ///< lies on a surface of the scene and looks away from it
  Amount direct;            ///< from lights, straight or through panes
  Amount caustic;           ///< from lights through mirrors, solids, lobes
  Amount indirect;          ///< after a diffuse reflection or transmission
  Amount total;
};

struct MeasureResult {
  std::vector<Reading> readings;  ///< as the sensors
  scene::Counters counters;
  bool complete = true;  ///< false: interrupted; the sensors not reached are not valid
  /// Readings off any surface in a scene of mirrors, solids or lobes that has lights without
  /// extent: their light on such ways is only found on surfaces and is missing here.
  std::size_t caustics_missing = 0;
};

/// Irradiance at sensors. Direct light: lights without extent exactly, one visibility ray each;
/// polygons of constant radiance by the exact point-to-polygon factor times the sampled share that
/// is visible, so that an unoccluded polygon gives the closed form; all else by sampling.
/// Indirect light: hemisphere rays that read the field. Caustics: the field's where the sensor lies
/// on one of its elements, else what the hemisphere rays find.
///
/// How many samples a sensor takes is decided by a pilot whose samples are then thrown away.
/// Readings depend on the seed and the sensor's number only.
///
/// \param field  a solution of this scene in this basis; empty: only what needs none is measured.
/// \throws std::invalid_argument  for sensors or options out of their domain, or more than
/// kMaxLanes lanes.
[[nodiscard]] MeasureResult measure(const scene::RayQuery& query,
                                    const material::SpectralBasis& basis,
                                    const scene::SurfaceField& field,
                                    std::span<const Sensor> sensors,
                                    const MeasureOptions& options = {},
                                    const scene::Control& control = {});

}  // namespace atrium::radiosity
