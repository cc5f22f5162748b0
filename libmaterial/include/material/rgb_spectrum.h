#pragma once

#include "material/spectral_value.h"
#include "material/spectrum.h"

namespace atrium::material {

/// A plausible reflectance spectrum of a linear Rec. 709 colour, at any wavelength: the
/// RGB-weighted sum of three fixed spectra, the smoothest ones in [0, 1] that sum to 1 and have the
/// colours of the primaries under D65 (least sum of squared steps; as SpectralBasis::bands does for
/// its bands).
///
/// Hence white is 1 and grey constant, exactly; values lie between the smallest and largest
/// channel, so within [0, 1] for a reflectance; and the colour of the spectrum relative to D65 (5
/// nm sums) is `rgb` to 1e-13. Linear in rgb: also for extinctions and other positive quantities.
/// Source: the idea of spectral primaries, I. Mallett, C. Yuksel, EGSR 2019.
/// \param nm  vacuum wavelength; linear between 5 nm nodes, constant beyond 360-830 nm.
[[nodiscard]] double rgb_reflectance_at(const Rgb& rgb, double nm);

/// The same as samples on the 5 nm grid.
[[nodiscard]] SampledSpectrum rgb_reflectance(const Rgb& rgb);

/// Light of an RGB colour, D65 times the above: spectral radiance [W/(sr m^2 nm)] of a radiance
/// `rgb` in nits, so that SpectralBasis::resolve_emission gives `rgb` back. Any non-negative
/// numbers. D65 is that of the tables: rgb_of_emission differs by its white, 1e-4.
[[nodiscard]] SampledSpectrum rgb_emission(const Rgb& rgb);

}  // namespace atrium::material
