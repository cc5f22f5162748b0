#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <vtkSmartPointer.h>

#include "fields.h"
#include "range.h"
#include "values.h"

class vtkLookupTable;

namespace atrium::view {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

/// What is not known, and what has no values.
inline constexpr Colour kGrey{128, 128, 128};

/// From low to high: blue over green and yellow to red for light, dark to pale for errors. The same
/// table colours surfaces and legend. Beyond the ends: the end's colour; NaN: kGrey.
/// \param look  Scale or Error.
[[nodiscard]] vtkSmartPointer<vtkLookupTable> make_table(Look look, const Range& range);

/// Of a class; neighbouring numbers differ much, and the first 64 all from each other.
[[nodiscard]] Colour class_colour(std::uint32_t number);

/// Radiosity as a camera shows it: radiance B / pi, tone mapped as PNG pictures are.
/// \param values  three components; unknown ones become kGrey.
[[nodiscard]] std::vector<Colour> tone_mapped(const Values& values, double ev);
/// Reflectances as sRGB.
[[nodiscard]] std::vector<Colour> surface_colours(const Values& values);
/// Classes; unknown ones become kGrey.
[[nodiscard]] std::vector<Colour> class_colours(const Values& values);

/// Exposure value that suits radiosities as it would suit a picture whose pixels they are; 0
/// without light.
[[nodiscard]] double automatic_ev(const std::vector<std::array<float, 3>>& radiosities);

}  // namespace atrium::view
