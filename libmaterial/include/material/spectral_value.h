#pragma once

#include <string>
#include <variant>
#include <vector>

#include "material/spectrum.h"

namespace atrium::material {

/// A spectrum given by samples; linear between them, constant beyond the ends.
/// Invariant (checked by make_sampled_spectrum): wavelengths strictly increase, same length,
/// finite.
struct SampledSpectrum {
  std::vector<double> wavelength_nm;
  std::vector<double> value;

  /// Value at a vacuum wavelength [nm].
  [[nodiscard]] double at(double nm) const;
};

/// \throws std::invalid_argument if the invariant of SampledSpectrum does not hold.
[[nodiscard]] SampledSpectrum make_sampled_spectrum(std::vector<double> wavelength_nm,
                                                    std::vector<double> value);

/// A spectral quantity as a user gives it: one number for every wavelength, linear Rec. 709 RGB,
/// or samples. A SpectralBasis turns it into the lanes that a scene is computed with.
using SpectralValue = std::variant<double, Rgb, SampledSpectrum>;

[[nodiscard]] bool is_achromatic(const SpectralValue& value);  ///< equal in every lane of any basis
[[nodiscard]] bool is_sampled(const SpectralValue& value);     ///< needs wavelengths to be exact
[[nodiscard]] double max_value(const SpectralValue& value);
[[nodiscard]] double min_value(const SpectralValue& value);

}  // namespace atrium::material
