#pragma once

#include <optional>

#include "radiosity/measure.h"
#include "scene/ray_query.h"

namespace atrium::radiosity {

/// A sensor in the scene's coordinates.
struct SensorPlace {
  Vec3d position;
  Vec3d normal;
  Vec3f origin;  ///< of its rays: off the surface by more than the rounding of coordinates
  std::optional<scene::SurfacePoint> surface;  ///< that it lies on and looks away from
  scene::Side side = scene::Side::Front;       ///< of that surface
};

/// A sensor lies on a surface if that is within 1e-5 of the scene's size along its normal.
[[nodiscard]] SensorPlace place_sensor(const scene::RayQuery& query, const Sensor& sensor,
                                       scene::Counters& counters);

}  // namespace atrium::radiosity
