#pragma once

#include <vector>

#include "plot/canvas.h"
#include "plot/plot.h"

namespace atrium::plot {

/// What of a curve is drawn: its points in axis coordinates (the decadic logarithm on logarithmic
/// axes), broken where a point cannot be drawn and cut well outside `range`, given likewise. A
/// point without neighbours is a piece of two equal points.
[[nodiscard]] std::vector<std::vector<Point>> curve_pieces(const Curve& curve, bool log_x,
                                                           bool log_y, const Box& range);

}  // namespace atrium::plot
