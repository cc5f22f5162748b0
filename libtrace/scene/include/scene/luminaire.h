#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/light.h"

namespace atrium::scene {

/// A luminaire as its photometric file describes it.
struct Luminaire {
  IntensityProfile profile;  ///< type C; absolute [cd]
  std::string format;        ///< "LM-63-2002", "LM-63-1986", "EULUMDAT", ...
  std::string name;          ///< may be empty
  char type = 'C';           ///< photometric type of the file's table: A, B or C
  std::string symmetry;      ///< in words
  /// Flux of its lamps [lm]; none in absolute photometry.
  std::optional<double> lamp_flux;
  /// Flux of the luminaire [lm] as the file states it, not by its table; none if it does not.
  std::optional<double> stated_flux;
  /// Luminous opening [m]: width, length, height. Length 0: round, width is the diameter.
  Vec3d opening = Vec3d::Zero();
};

/// By the file's ending: .ies (IES LM-63, 1986 to 2019) or .ldt (EULUMDAT).
/// \throws Error "FILE[:line]: what is wrong".
[[nodiscard]] Luminaire read_luminaire(const std::filesystem::path& file);
[[nodiscard]] bool is_luminaire_ending(const std::filesystem::path& file);

// One reader per format; read_luminaire() chooses.
/// The second number of the ballast line is a factor up to LM-63-2002; since 2019 it is the file
/// generation type, which scales nothing.
[[nodiscard]] Luminaire read_ies(const std::filesystem::path& file);
/// Source: Stockmar 1990, Licht '90, pp. 641-644. Several sets of lamps are alternatives: the first
/// one burns. A negative number of lamps: absolute photometry, the flux is the luminaire's. The
/// tilt during measurement is that of the table itself and turns nothing.
[[nodiscard]] Luminaire read_eulumdat(const std::filesystem::path& file);

/// Angle [deg] around the brightest direction of the plane phi, phi + 180 within which the
/// intensity stays at or above a share of that: 0.5 beam angle, 0.1 field angle. 360 at most; 0 in
/// the dark.
[[nodiscard]] double opening_angle(const IntensityProfile& profile, double phi_deg, double share);

}  // namespace atrium::scene
