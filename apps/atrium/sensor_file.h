#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radiosity/measure.h"

namespace atrium::app {

/// Of a file or a grid.
inline constexpr std::size_t kMostSensors = 10'000'000;

/// One sensor per line, "x y z nx ny nz" in metres, separated by blanks, commas or semicolons;
/// normals of any length; # starts a comment. \throws Error "FILE:line: ..." for anything else.
[[nodiscard]] std::vector<radiosity::Sensor> read_sensors(const std::string& file);

}  // namespace atrium::app
