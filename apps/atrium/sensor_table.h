#pragma once

#include <span>
#include <string>

#include "radiosity/measure.h"

namespace atrium::app {

/// What the readings of valid sensors say together.
struct SensorSummary {
  std::size_t count = 0;    ///< valid sensors
  std::size_t invalid = 0;  ///< inside solids, or not reached
  double minimum = 0.0, mean = 0.0, maximum = 0.0;
  double standard_error = 0.0;  ///< of the mean, from the sensors' samples
  double u0 = 0.0, u1 = 0.0;    ///< minimum / mean, minimum / maximum; 0 in the dark
};
[[nodiscard]] SensorSummary summarise(std::span<const radiosity::Reading> readings);
/// For people, one line. \param unit  "lx" or "W/m^2".
[[nodiscard]] std::string describe(const SensorSummary& summary, const std::string& unit);

/// A line of names, then a line per sensor; no values for a sensor that is not valid.
[[nodiscard]] std::string sensor_csv(std::span<const radiosity::Sensor> sensors,
                                     std::span<const radiosity::Reading> readings,
                                     const std::string& unit);
/// \param command  as typed, for the file.
[[nodiscard]] std::string sensor_json(std::span<const radiosity::Sensor> sensors,
                                      std::span<const radiosity::Reading> readings,
                                      const std::string& unit, const std::string& command);

}  // namespace atrium::app
