#pragma once

#include <filesystem>
#include <string>

#include "scene/sun.h"

namespace atrium::scene {

/// What a weather file says about the light of one hour.
struct WeatherHour {
  Place place;
  std::string city;
  /// Middle of the hour, which is where the sun stands for its averages. The year is the row's.
  LocalTime middle;
  double direct_normal = 0.0;       ///< [W/m^2], mean of the hour
  double diffuse_horizontal = 0.0;  ///< [W/m^2], mean of the hour
  double dew_point_c = 0.0;
};

/// Reads one row of an EnergyPlus weather file. \param hour  1 to 24 as in the file: the hour that
/// ends then, standard time.
/// \throws Error "FILE:LINE: ..." for a file that is none, a row that is missing, fields that are
/// missing, out of range or marked as missing (9999).
/// Source: EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
[[nodiscard]] WeatherHour read_epw(const std::filesystem::path& file, int month, int day, int hour);

}  // namespace atrium::scene
