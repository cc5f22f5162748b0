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
/// divided by the integral of illuminant * y_bar, so that value = 1 has Y = 1.
[[nodiscard]] Eigen::Vector3d xyz_of_reflectance(const SampledSpectrum& value,
                                                 const SampledSpectrum& illuminant);

inline constexpr double kMaxLuminousEfficacy = 683.0;  ///< [lm/W] at 555 nm, CIE
inline constexpr double kWhiteLumensPerWatt = 179.0;   ///< [lm/W] white light, where unavoidable

}  // namespace atrium::material
