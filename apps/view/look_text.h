#pragma once

#include <array>
#include <string>

#include "options.h"

// Texts of the command line as values. All throw Error, one line with the text and what is valid.
namespace atrium::view {

/// LOW,HIGH.
[[nodiscard]] std::array<double, 2> parse_range(const std::string& text, bool logarithmic);
/// A count, or levels A,B,C (two or more; a single one with a comma behind it).
[[nodiscard]] ContourChoice parse_contours(const std::string& text);
/// "y<2.4", "x>1": what stays; or "nx,ny,nz<d".
[[nodiscard]] Clip parse_clip(const std::string& text);

}  // namespace atrium::view
