#pragma once

#include <array>
#include <string>

namespace atrium::app {

/// File of a frame: its number, from 1, in place of %d or %0Nd, else before the ending: walk.png is
/// walk-0001.png.
[[nodiscard]] std::string frame_name(const std::string& output, int frame);

/// \throws Error  for a name with more than one number or with another conversion than %d.
void check_frame_pattern(const std::string& output);

/// A-B, A, A- or -B, frames from 1: first and last; the last is `frames` where it is left out.
/// \throws Error  that names the range and what is valid.
[[nodiscard]] std::array<int, 2> parse_frame_range(const std::string& text, int frames);

}  // namespace atrium::app
