#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "material/spectral_value.h"

namespace atrium::material {

/// CIE 1931 2-degree colour-matching functions (ISO/CIE 11664-1), 360-830 nm in 5 nm steps.
[[nodiscard]] const SampledSpectrum& cie_x_bar();
[[nodiscard]] const SampledSpectrum& cie_y_bar();
[[nodiscard]] const SampledSpectrum& cie_z_bar();

/// Relative spectral power of an illuminant: "A", "D65", "E", "F2", "F11". nullptr: unknown.
[[nodiscard]] const SampledSpectrum* find_illuminant(std::string_view name);

/// XYZ (Y = 1 for white) to linear Rec. 709 with its D65 white, and back. IEC 61966-2-1.
[[nodiscard]] const Eigen::Matrix3d& rgb_from_xyz();
[[nodiscard]] const Eigen::Matrix3d& xyz_from_rgb();

/// XYZ of a stimulus: integral of value(lambda) * illuminant(lambda) * cmf on the 5 nm grid,
/// divided by the integral of illuminant * y_bar, so that value = 1 has Y = 1. Spectra on any grid:
/// where one is finer than 5 nm (lines), the integral is exact for linear interpolation of all three.
/// The illuminant must not be black.
[[nodiscard]] Eigen::Vector3d xyz_of_reflectance(const SampledSpectrum& value,
                                                 const SampledSpectrum& illuminant);

/// XYZ of spectral radiance [W/(sr m^2 nm)] on any grid, also of a single sample (constant):
/// 683 lm/W * sum of radiance * cmf * 5 nm, so Y is the luminance [cd/m^2]. The same for the
/// spectral irradiance or flux of a light, with lux or lumen. As above for lines.
[[nodiscard]] Eigen::Vector3d xyz_of_emission(const SampledSpectrum& radiance);

/// The same as linear Rec. 709, luminance as above; negative outside its gamut.
[[nodiscard]] Eigen::Vector3d rgb_of_emission(const SampledSpectrum& radiance);

inline constexpr double kMaxLuminousEfficacy = 683.0;  ///< [lm/W] at 555 nm, CIE
inline constexpr double kWhiteLumensPerWatt = 179.0;   ///< [lm/W] white light, where unavoidable

}  // namespace atrium::material
