#pragma once

#include <string_view>

#include "material/optical_constants.h"

namespace atrium::material_query {

/// The table of a material by name.  \throws Error  with near names, if it is unknown.
[[nodiscard]] const material::OpticalConstants& named_material(std::string_view name);

/// \throws Error  if the table does not cover the vacuum wavelength [nm]; nothing is extrapolated.
void check_wavelength(const material::OpticalConstants& constants, double nm);

}  // namespace atrium::material_query
