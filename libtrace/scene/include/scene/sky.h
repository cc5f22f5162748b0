#pragma once

#include <variant>

#include "material/frame.h"

namespace atrium::scene {

/// Relative luminance of a sky as the product of a gradation from zenith to horizon and an
/// indicatrix around the sun (angle chi):
///   [1 + a exp(b / cos Z)] [1 + c (exp(d chi) - exp(d pi/2) s) + e cos^2 chi],
/// s = 1 in the CIE's formula, 0 in that of Perez. b is at most 0.
struct GradationSky {
  double a = 0.0, b = -1.0;
  double c = 0.0, d = -1.0, e = 0.0;
  bool shifted = true;  ///< s
};

/// Traditional overcast sky: (1 + 2 cos Z) / 3. Source: Moon & Spencer 1942; ISO 15469, type 16.
struct OvercastSky {};

using SkyPattern = std::variant<GradationSky, OvercastSky>;

/// Luminance in a direction above the horizon up to a factor, >= 0: a fit that turns negative reads
/// 0. \param cos_zenith  > 0. \param cos_sun  of the angle to the sun.
[[nodiscard]] double relative_luminance(const SkyPattern& pattern, double cos_zenith,
                                        double cos_sun);
/// Does it depend on where the sun is?
[[nodiscard]] bool needs_sun(const SkyPattern& pattern);

/// CIE standard general sky 1 to 15, and 16: the traditional overcast sky.
/// \throws std::invalid_argument  for other types. Source: ISO 15469:2004 / CIE S 011/E:2003.
[[nodiscard]] SkyPattern cie_sky(int type);

/// How clear and how bright a sky is. Source: Perez, Seals & Michalsky 1993, Eqs. 1 and 2.
struct PerezState {
  double clearness = 1.0;   ///< epsilon, >= 1
  double brightness = 0.1;  ///< Delta, > 0
  double sun_zenith = 0.0;  ///< [rad], below pi/2
};
/// \param direct_normal, diffuse_horizontal  irradiances [W/m^2], >= 0 and > 0.
/// \param sun_distance_au  of the day.
[[nodiscard]] PerezState perez_state(double direct_normal, double diffuse_horizontal,
                                     double sun_zenith, double sun_distance_au);

/// All-weather sky. Outside of the data that it was fitted to the gradation's b can exceed 0, which
/// would let the horizon grow without bound: it counts as 0 then.
/// Source: Perez, Seals & Michalsky 1993, Table 1 with Eqs. 6 to 8; for clearness within 1.065 and
/// 2.8 the brightness counts as at least 0.2 (erratum, Solar Energy 51(5) p. 423).
[[nodiscard]] GradationSky perez_sky(const PerezState& state);

/// Luminous efficacies [lm/W], >= 0, of the sky's and of the sun's irradiance.
/// \param dew_point_c  at the ground, stands for the water in the air.
/// Source: Perez, Ineichen, Seals, Michalsky & Stewart 1990, Table 4 with Eqs. 3, 7 and 8.
[[nodiscard]] double perez_diffuse_efficacy(const PerezState& state, double dew_point_c);
[[nodiscard]] double perez_direct_efficacy(const PerezState& state, double dew_point_c);

/// A sky over ground, of horizontal irradiance 1 from above: SkyDome::at times an irradiance is a
/// radiance. Its frame has y up, x to the east and z to the south.
class SkyDome {
 public:
  /// \param sun  unit, towards the sun. \param ground_reflectance  in [0, 1]: below the horizon
  /// lies a diffuse plane. \param sun_share  irradiance that the ground has from the sun itself,
  /// relative to that from the sky, >= 0.
  SkyDome(const SkyPattern& pattern, const Vec3d& sun, double ground_reflectance,
          double sun_share = 0.0);

  /// [1/sr]. \param w  unit.
  [[nodiscard]] double at(const Vec3d& w) const;
  [[nodiscard]] double zenith() const { return at(Vec3d::UnitY()); }
  /// Mean over all directions, ground included [1/sr].
  [[nodiscard]] double mean() const { return mean_; }

  [[nodiscard]] const SkyPattern& pattern() const { return pattern_; }
  [[nodiscard]] const Vec3d& sun() const { return sun_; }
  [[nodiscard]] double ground() const { return ground_; }  ///< below the horizon [1/sr]

 private:
  SkyPattern pattern_;
  Vec3d sun_;
  double scale_ = 1.0;
  double ground_ = 0.0;
  double mean_ = 0.0;
};

/// Integrals of a pattern over the upper hemisphere, by Gauss-Legendre quadrature with panels that
/// meet at the sun; relative error below 1e-5 (1e-3 where a fit turns negative).
struct SkyIntegrals {
  double horizontal;  ///< of luminance times cos Z
  double hemisphere;  ///< of luminance
};
[[nodiscard]] SkyIntegrals integrate(const SkyPattern& pattern, double sun_zenith);

}  // namespace atrium::scene
