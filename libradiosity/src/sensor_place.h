#pragma once

#include <cstdint>
#include <optional>
#include <vector>

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

/// Do most directions from the sensor meet the back of a closed opaque body first?
/// \param closed_opaque  by object.
[[nodiscard]] bool inside_solid(const scene::RayQuery& query,
                                const std::vector<std::uint8_t>& closed_opaque,
                                const SensorPlace& place, scene::Counters& counters);

}  // namespace atrium::radiosity
