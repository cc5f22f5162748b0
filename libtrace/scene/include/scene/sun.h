#pragma once

#include "material/frame.h"

namespace atrium::scene {

/// A place on earth and its clock.
struct Place {
  double latitude_deg = 0.0;   ///< north positive
  double longitude_deg = 0.0;  ///< east positive
  double utc_offset = 0.0;     ///< standard time minus UTC [h], no daylight saving
};

/// A moment by the place's clock, Gregorian calendar.
struct LocalTime {
  int year = 2000;
  int month = 1;      ///< 1 to 12
  int day = 1;        ///< 1 to the month's last
  double hour = 0.0;  ///< since midnight; beyond 0 to 24 is the day before or after
};

/// Where the sun's centre stands.
struct SunPosition {
  double azimuth = 0.0;      ///< [rad] clockwise from north, [0, 2 pi)
  double elevation = 0.0;    ///< [rad] above the horizon as seen from the ground, no refraction
  double distance_au = 1.0;  ///< earth to sun [astronomical units]
  double declination = 0.0;  ///< [rad]
};

/// By the sun's mean elements and its equation of the centre with apparent longitude, sidereal time
/// and parallax. Within 0.01 degrees of the NREL Solar Position Algorithm from 1950 to 2050.
/// \throws std::invalid_argument  for a date that is none.
/// Source: Meeus, Astronomical Algorithms, 2nd ed. 1998, chapters 7, 12, 13, 25, 40.
[[nodiscard]] SunPosition sun_position(const Place& place, const LocalTime& time);

/// What the air adds to an elevation [rad]; 0 for a sun that is down.
/// \param elevation  without refraction. \param pressure_hpa, temperature_c  of the air.
/// Source: Saemundsson 1986 in Meeus, Eq. 16.4.
[[nodiscard]] double refraction(double elevation, double pressure_hpa = 1010.0,
                                double temperature_c = 10.0);

/// Unit vector towards azimuth [rad, clockwise from north] and elevation [rad], in a frame with x
/// to the east, y up and z to the south.
[[nodiscard]] Vec3d direction_of(double azimuth, double elevation);

/// Turns that frame so that north is `north` [rad] clockwise, seen from above, of -z.
[[nodiscard]] Eigen::Affine3d turned_to_north(double north);

/// Half the angle under which the sun is seen from one astronomical unit [rad]: 0.533 degrees
/// across.
inline constexpr double kSunAngularRadius = 0.2666 * 0.017453292519943295;
/// Irradiance above the air at one astronomical unit [W/m^2]; the value that the models of Perez
/// were fitted with.
inline constexpr double kSolarConstant = 1367.0;

/// Optical path through the air relative to that of the zenith. \param zenith  of the sun [rad],
/// at most pi/2. Source: Kasten & Young 1989.
[[nodiscard]] double air_mass(double zenith);

}  // namespace atrium::scene
