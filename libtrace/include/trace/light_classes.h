#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace atrium::trace {

/// Classes of light paths in Heckbert's notation (1990), from the light L to the eye E: D is
/// reflection or transmission by a body, S everything else (mirror, glass, lobe) one or more times;
/// passing a pane straight is neither. The finest partition that hybrid and path tracer both know.
enum class LightClass : std::size_t {
  LE,      ///< lights and environment
  LSE,     ///< ... in mirrors, through glass; highlights
  LDE,     ///< direct light
  LDSE,    ///< ... of what mirrors and glass show
  LSDE,    ///< caustics
  LSDSE,   ///< ... of what mirrors and glass show
  LDDE,    ///< light reflected once before, with or without S in between
  LDDSE,   ///< ...
  LSDDE,   ///< light of caustics reflected once before
  LSDDSE,  ///< ...
  LDDDE,   ///< three or more D, whatever is between them and before
  LDDDSE   ///< ...
};
inline constexpr std::size_t kLightClasses = 12;

/// Names of the image layers, by LightClass.
inline constexpr std::array<std::string_view, kLightClasses> kLightClassNames{
    "LE",   "LSE",   "LDE",   "LDSE",   "LSDE",  "LSDSE",
    "LDDE", "LDDSE", "LSDDE", "LSDDSE", "LDDDE", "LDDDSE"};

}  // namespace atrium::trace
