#pragma once

#include <optional>
#include <vector>

#include "options.h"
#include "range.h"
#include "selection.h"

namespace atrium::view {

/// What is shown and how: changed by the command line, keys and sliders.
struct PictureState {
  std::size_t field = 0;  ///< into Picture::fields()
  ShownSide side = ShownSide::Seen;
  std::optional<Range> range;  ///< absent: suits the values
  bool logarithmic = false;
  std::optional<double> ev;  ///< absent: suits the view
  ContourChoice contours;
  std::vector<Clip> clips;
  bool flat = false, edges = false, cull = false, no_ceilings = false, legend = true;
  std::vector<Selection> hidden;
  Selection selection;  ///< outlined unless it is everything

  friend bool operator==(const PictureState&, const PictureState&) = default;
};

}  // namespace atrium::view
