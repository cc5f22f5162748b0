#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "radiosity/measure.h"
#include "session.h"

namespace atrium::app {

/// At the centres of the cells of a grid, looking along u x v.
[[nodiscard]] std::vector<radiosity::Sensor> grid_sensors(const SensorGrid& grid);

/// Over the bounds of the scene at a height, looking up; places without a floor below and a
/// ceiling above (outdoors) are left out. \throws Error  if there is no such place or there are too
/// many.
[[nodiscard]] std::vector<radiosity::Sensor> work_plane_sensors(const LoadedScene& loaded,
                                                                double height, double spacing);

}  // namespace atrium::app
