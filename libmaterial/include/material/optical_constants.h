#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "material/spectral_value.h"

namespace atrium::material {

/// Complex refractive index N = n + i k of a real material, k = n kappa, by vacuum wavelength.
struct OpticalConstants {
  std::string name;
  std::string source;  ///< author, year
  SampledSpectrum n;
  SampledSpectrum k;
};

/// Named materials of the compiled tables: metals (Au, Ag, Cu, Al, Fe, Cr, W, Ti), glasses and
/// liquids (BK7, soda-lime-glass, fused-silica, water, PMMA, diamond). Also by English name
/// ("gold", "silver", ...). Case-insensitive. nullptr: unknown.
/// Source: refractiveindex.info (M. N. Polyanskiy, Sci. Data 11, 94 (2024)), CC0.
[[nodiscard]] const OpticalConstants* find_optical_constants(std::string_view name);
[[nodiscard]] std::vector<std::string> optical_constants_names();
/// Other names of the tables, first, with the name of the table: ("gold", "Au").
[[nodiscard]] std::vector<std::pair<std::string, std::string>> optical_constants_aliases();

/// Lambert extinction K = 4 pi k / lambda [1/m] of the material's bulk, on the grid of k.
[[nodiscard]] SampledSpectrum extinction_of(const OpticalConstants& constants);

}  // namespace atrium::material
