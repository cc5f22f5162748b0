#include "plot/curve_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plot/axis_range.h"

namespace atrium::plot {
namespace {

/// The part [first, second] of the way from a to b that is in the box, if first <= second (Liang &
/// Barsky 1984).
std::pair<double, double> inside(const Point& a, const Point& b, const Box& box) {
  std::pair<double, double> part{0.0, 1.0};
  const auto cut = [&part](double from, double to, double low, double high) {
    if (from == to) {
      if (from < low || from > high) part = {1.0, 0.0};
      return;
    }
    const double t0 = (low - from) / (to - from), t1 = (high - from) / (to - from);
    part.first = std::max(part.first, std::min(t0, t1));
    part.second = std::min(part.second, std::max(t0, t1));
  };
  cut(a.x, b.x, box.x0, box.x1);
  cut(a.y, b.y, box.y0, box.y1);
  return part;
}

Point between(const Point& a, const Point& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

/// Points that follow each other without a gap, cut to the box.
void append_run(const std::vector<Point>& run, const Box& box,
                std::vector<std::vector<Point>>& pieces) {
  if (run.empty()) return;
  if (run.size() == 1) {
    const auto [t0, t1] = inside(run[0], run[0], box);
    if (t0 <= t1) pieces.push_back({run[0], run[0]});
    return;
  }
  bool open = false;
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    const auto [t0, t1] = inside(run[i], run[i + 1], box);
    if (!(t0 <= t1)) {
      open = false;
      continue;
    }
    if (!open || t0 > 0.0) pieces.push_back({between(run[i], run[i + 1], t0)});
    pieces.back().push_back(t1 < 1.0 ? between(run[i], run[i + 1], t1) : run[i + 1]);
    open = t1 >= 1.0;
  }
}

}  // namespace

std::vector<std::vector<Point>> curve_pieces(const Curve& curve, bool log_x, bool log_y,
                                             const Box& range) {
  // One range of room on each side: cuts are out of sight, numbers stay small.
  const double w = range.x1 - range.x0, h = range.y1 - range.y0;
  const Box box{range.x0 - w, range.y0 - h, range.x1 + w, range.y1 + h};
  std::vector<std::vector<Point>> pieces;
  std::vector<Point> run;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (drawable(curve.x[i], log_x) && drawable(curve.y[i], log_y)) {
      run.push_back({log_x ? std::log10(curve.x[i]) : curve.x[i],
                     log_y ? std::log10(curve.y[i]) : curve.y[i]});
    } else {
      append_run(run, box, pieces);
      run.clear();
    }
  }
  append_run(run, box, pieces);
  return pieces;
}

}  // namespace atrium::plot
