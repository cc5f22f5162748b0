#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "options.h"

// Texts of the command line as values. All throw Error, one line with the text and what is valid.
namespace atrium::app {

/// X0,Y0,X1,Y1 as shares.
[[nodiscard]] std::array<double, 4> parse_crop(const std::string& text);
/// Corner and edges as X,Y,Z each, then the cells as NxM. \param words  the four words of --grid.
[[nodiscard]] SensorGrid parse_grid(const std::vector<std::string>& words);
/// Metres of a length with a unit, "0.2um"; without one it is in metres.
[[nodiscard]] double parse_length(const char* option, const std::string& text);
/// "550", "450,550,650" or FIRST:LAST:STEP in nm.
[[nodiscard]] std::vector<double> parse_wavelengths(const std::string& text);

/// A word as a shell would need it to be typed.
[[nodiscard]] std::string shell_word(const std::string& word);

}  // namespace atrium::app
