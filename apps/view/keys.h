#pragma once

#include <span>
#include <string>

namespace atrium::view {

/// What a key does.
enum class Action {
  Help,
  NextField,
  PreviousField,
  NextSide,
  Logarithmic,
  AutomaticRange,
  RangeUp,
  RangeDown,
  MoreExposure,
  LessExposure,
  Contours,
  MoreContours,
  FewerContours,
  Flat,
  Edges,
  Cull,
  Ceilings,
  Clip,
  ClipUp,
  ClipDown,
  SelectObject,
  SelectFacet,
  SelectNothing,
  Statistics,
  Sliders,
  NextCamera,
  ResetCamera,
  Walk,
  Legend,
  Screenshot,
  Quit
};

struct Key {
  Action action;
  const char* symbol;  ///< X keysym
  const char* shown;   ///< for people
  const char* text;
};

/// All keys, in the order in which they are listed. Arrows walk and are not among them.
[[nodiscard]] std::span<const Key> keys();
/// nullptr: does nothing.
[[nodiscard]] const Key* find_key(const std::string& symbol);
/// One line per key and for the mouse.
[[nodiscard]] std::string key_help();

}  // namespace atrium::view
