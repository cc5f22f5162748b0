#include "scene/sun.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;
/// Dynamical minus universal time [s]. It was 29 in 1950, 64 in 2000, 69 in 2020; the sun moves
/// 0.04 arc seconds in a second.
constexpr double kDeltaT = 64.0;

double wrapped(double radians) {
  const double r = std::fmod(radians, 2.0 * kPi);
  return r < 0.0 ? r + 2.0 * kPi : r;
}

bool is_date(const LocalTime& t) {
  constexpr std::array days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (t.month < 1 || t.month > 12 || t.day < 1) return false;
  const bool leap = (t.year % 4 == 0 && t.year % 100 != 0) || t.year % 400 == 0;
  return t.day <= days[static_cast<std::size_t>(t.month - 1)] + (leap && t.month == 2 ? 1 : 0);
}

// Days since noon of 1 January 2000, universal time (Meeus, Eq. 7.1).
double days_since_2000(const LocalTime& t, double utc_offset) {
  const int y = t.month <= 2 ? t.year - 1 : t.year;
  const int m = t.month <= 2 ? t.month + 12 : t.month;
  const int a = static_cast<int>(std::floor(y / 100.0));
  const int b = 2 - a + static_cast<int>(std::floor(a / 4.0));
  const double midnight =
      std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + t.day + b - 1524.5;
  return midnight - 2451545.0 + (t.hour - utc_offset) / 24.0;
}

}  // namespace

SunPosition sun_position(const Place& place, const LocalTime& time) {
  if (!is_date(time) || !std::isfinite(time.hour))
    throw std::invalid_argument("sun_position: no such date");
  const double ut = days_since_2000(time, place.utc_offset);
  const double t = (ut + kDeltaT / 86400.0) / 36525.0;

  // Apparent longitude on the ecliptic (chapter 25).
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * kRadians;
  const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
  const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * std::sin(anomaly) +
                        (0.019993 - t * 0.000101) * std::sin(2.0 * anomaly) +
                        0.000289 * std::sin(3.0 * anomaly);
  const double node = (125.04 - 1934.136 * t) * kRadians;
  const double nutation = -0.00478 * std::sin(node);
  const double longitude = (mean_longitude + centre - 0.00569 + nutation) * kRadians;
  const double obliquity =
      (23.43929111 - t * (0.01300417 + t * 1.64e-7) + 0.00256 * std::cos(node)) * kRadians;

  SunPosition sun;
  sun.distance_au = 1.000001018 * (1.0 - eccentricity * eccentricity) /
                    (1.0 + eccentricity * std::cos(anomaly + centre * kRadians));
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  sun.declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  // Hour angle from the apparent sidereal time (chapter 12), then the horizon (chapter 13).
  const double sidereal =
      280.46061837 + 360.98564736629 * ut + 0.000387933 * t * t + nutation * std::cos(obliquity);
  const double hour_angle = (sidereal + place.longitude_deg) * kRadians - right_ascension;
  const double latitude = place.latitude_deg * kRadians;
  const double south = std::cos(hour_angle) * std::sin(latitude) * std::cos(sun.declination) -
                       std::sin(sun.declination) * std::cos(latitude);
  const double west = std::sin(hour_angle) * std::cos(sun.declination);
  sun.azimuth = wrapped(std::atan2(west, south) + kPi);
  const double geocentric = std::asin(
      std::clamp(std::sin(latitude) * std::sin(sun.declination) +
                     std::cos(latitude) * std::cos(sun.declination) * std::cos(hour_angle),
                 -1.0, 1.0));
  const double parallax = 8.794 / 3600.0 * kRadians / sun.distance_au;
  sun.elevation = geocentric - parallax * std::cos(geocentric);
  return sun;
}

double refraction(double elevation, double pressure_hpa, double temperature_c) {
  const double h = elevation / kRadians;
  if (!(h > -0.8333)) return 0.0;
  const double arc_minutes = 1.02 / std::tan((h + 10.3 / (h + 5.11)) * kRadians);
  return arc_minutes / 60.0 * kRadians * (pressure_hpa / 1010.0) *
         (283.0 / (273.0 + temperature_c));
}

Vec3d direction_of(double azimuth, double elevation) {
  const double c = std::cos(elevation);
  return {c * std::sin(azimuth), std::sin(elevation), -c * std::cos(azimuth)};
}

Eigen::Affine3d turned_to_north(double north) {
  return Eigen::Affine3d(Eigen::AngleAxisd(-north, Vec3d::UnitY()));
}

double air_mass(double zenith) {
  const double degrees = std::min(zenith / kRadians, 90.0);
  return 1.0 / (std::cos(degrees * kRadians) + 0.50572 * std::pow(96.07995 - degrees, -1.6364));
}

}  // namespace atrium::scene
