#include "plot/panels.h"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "plot/axis_range.h"
#include "plot/curve_pieces.h"
#include "plot/drawing.h"

namespace atrium::plot {
namespace {

constexpr double kSwatchRow = 52.0, kMargin = 10.0;

/// Okabe & Ito 2008 without the yellow, which is too light for lines on white.
Color palette(std::size_t i) {
  static constexpr std::array<Color, 7> kColors{{{0.000, 0.447, 0.698},
                                                 {0.835, 0.369, 0.000},
                                                 {0.000, 0.620, 0.451},
                                                 {0.800, 0.475, 0.655},
                                                 {0.000, 0.000, 0.000},
                                                 {0.337, 0.706, 0.914},
                                                 {0.902, 0.624, 0.000}}};
  return kColors[i % kColors.size()];
}

/// The swatch fills `box` but for a margin and a line for the name.
void draw_swatch(vtkContext2D* painter, const Swatch& swatch, const Box& box) {
  const double name_height = 18.0, gap = 4.0;
  painter->GetBrush()->SetColorF(swatch.color.r, swatch.color.g, swatch.color.b);
  painter->GetBrush()->SetOpacityF(1.0);
  // A white swatch has to be seen on white, too.
  painter->GetPen()->SetColorF(0.6, 0.6, 0.6);
  painter->GetPen()->SetOpacityF(1.0);
  painter->GetPen()->SetWidth(0.5F);
  painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
  const auto f = [](double v) { return static_cast<float>(v); };
  painter->DrawRect(f(box.x0 + gap), f(box.y0 + name_height), f(box.x1 - box.x0 - 2 * gap),
                    f(box.y1 - box.y0 - name_height - gap));
  draw_text(painter, 0.5 * (box.x0 + box.x1), box.y0 + 0.5 * name_height, swatch.name, kLabelSize);
}

void add_swatches(const std::vector<Swatch>& swatches, int columns, const Box& box,
                  vtkContextScene* scene) {
  const int count = static_cast<int>(swatches.size());
  const int rows = (count + columns - 1) / columns;
  const double width = (box.x1 - box.x0) / columns, height = (box.y1 - box.y0) / rows;
  for (int i = 0; i < count; ++i) {
    const int row = i / columns, column = i % columns;
    const double x = box.x0 + width * column, y = box.y1 - height * (row + 1);
    add_drawing(scene, [swatch = swatches[static_cast<std::size_t>(i)],
                        cell = Box{x, y, x + width, y + height}](vtkContext2D* painter) {
      draw_swatch(painter, swatch, cell);
    });
  }
}

/// Takes a strip off the bottom of `box` for a row of swatches.
void add_swatch_row(const std::vector<Swatch>& swatches, Box& box, vtkContextScene* scene) {
  if (swatches.empty()) return;
  const Box row{box.x0 + kMargin, box.y0, box.x1 - kMargin, box.y0 + kSwatchRow};
  // A single swatch across the whole picture would be the loudest thing in it.
  add_swatches(swatches, std::max(6, static_cast<int>(swatches.size())), row, scene);
  box.y0 += kSwatchRow;
}

vtkSmartPointer<vtkTable> make_table(const std::vector<Point>& points) {
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName("y");
  for (const Point& p : points) {
    x->InsertNextValue(p.x);
    y->InsertNextValue(p.y);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void add_curve(const Curve& curve, const Color& color,
               const std::vector<std::vector<Point>>& pieces, vtkChartXY* chart) {
  // A curve of which nothing can be drawn still has its entry in the legend.
  for (std::size_t i = 0; i < std::max<std::size_t>(pieces.size(), 1); ++i) {
    vtkPlot* plot = chart->AddPlot(vtkChart::LINE);
    plot->SetInputData(make_table(pieces.empty() ? std::vector<Point>{} : pieces[i]), 0, 1);
    plot->GetPen()->SetColorF(color.r, color.g, color.b);
    plot->GetPen()->SetWidth(1.8F);
    plot->GetPen()->SetLineType(curve.dashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
    plot->SetLabel(curve.name);
    plot->SetLegendVisibility(i == 0 && !curve.name.empty());
  }
}

void add_curves(const std::vector<Curve>& curves, bool log_x, bool log_y, const Box& range,
                vtkChartXY* chart) {
  std::size_t next_color = 0;
  for (const Curve& curve : curves) {
    const Color color = curve.color ? *curve.color : palette(next_color++);
    add_curve(curve, color, curve_pieces(curve, log_x, log_y, range), chart);
  }
}

void set_legend(vtkChartXY* chart, LegendPlace place, const std::vector<Curve>& curves) {
  const bool named = std::any_of(curves.begin(), curves.end(),
                                 [](const Curve& curve) { return !curve.name.empty(); });
  chart->SetShowLegend(named && place != LegendPlace::None);
  vtkChartLegend* legend = chart->GetLegend();
  const bool left = place == LegendPlace::TopLeft || place == LegendPlace::BottomLeft;
  const bool bottom = place == LegendPlace::BottomLeft || place == LegendPlace::BottomRight;
  legend->SetHorizontalAlignment(left ? vtkChartLegend::LEFT : vtkChartLegend::RIGHT);
  legend->SetVerticalAlignment(bottom ? vtkChartLegend::BOTTOM : vtkChartLegend::TOP);
  legend->SetLabelSize(kLabelSize);
  set_text(legend->GetLabelProperties(), kLabelSize);
  legend->GetBrush()->SetColorF(1.0, 1.0, 1.0);
  legend->GetBrush()->SetOpacityF(0.85);
  legend->GetPen()->SetColorF(0.8, 0.8, 0.8);
}

/// Range and ticks in axis coordinates: VTK then never has to deal with logarithms.
void set_axis(vtkAxis* axis, const std::string& title, const Range& range, bool log, int count) {
  const auto coordinate = [log](double v) { return log ? std::log10(v) : v; };
  axis->SetTitle(title);
  set_text(axis->GetTitleProperties(), kAxisTitleSize);
  set_text(axis->GetLabelProperties(), kLabelSize);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(coordinate(range.min), coordinate(range.max));
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (const Tick& tick : make_ticks(range, log, count)) {
    positions->InsertNextValue(coordinate(tick.value));
    labels->InsertNextValue(tick.label);
  }
  axis->SetCustomTickPositions(positions, labels);
  axis->GetGridPen()->SetColorF(0.88, 0.88, 0.88);
  axis->GetGridPen()->SetWidth(0.7F);
  axis->GetPen()->SetColorF(0.3, 0.3, 0.3);
}

vtkSmartPointer<vtkChartXY> make_chart(int layout, const Box& box) {
  auto chart = vtkSmartPointer<vtkChartXY>::New();
  chart->SetLayoutStrategy(layout);
  chart->SetSize(vtkRectf(static_cast<float>(box.x0), static_cast<float>(box.y0),
                          static_cast<float>(box.x1 - box.x0),
                          static_cast<float>(box.y1 - box.y0)));
  chart->SetAutoAxes(false);
  chart->SetHiddenAxisBorder(static_cast<int>(kMargin) + 4);
  return chart;
}

void add_panel(const Chart& chart, Box box, vtkContextScene* scene) {
  add_title(chart.title, box, scene);
  add_swatch_row(chart.swatches, box, scene);
  const auto xy = make_chart(vtkChart::FILL_RECT, box);
  const Range x = x_extent(chart), y = y_extent(chart);
  const int x_count = std::clamp(static_cast<int>((box.x1 - box.x0) / 80.0), 2, 10);
  const int y_count = std::clamp(static_cast<int>((box.y1 - box.y0) / 45.0), 2, 10);
  set_axis(xy->GetAxis(vtkAxis::BOTTOM), chart.x_title, x, chart.log_x, x_count);
  set_axis(xy->GetAxis(vtkAxis::LEFT), chart.y_title, y, chart.log_y, y_count);
  const auto ends = [](const Range& r, bool log) {
    return log ? Range{std::log10(r.min), std::log10(r.max)} : r;
  };
  const Range ax = ends(x, chart.log_x), ay = ends(y, chart.log_y);
  add_curves(chart.curves, chart.log_x, chart.log_y, {ax.min, ay.min, ax.max, ay.max}, xy);
  set_legend(xy, chart.legend, chart.curves);
  scene->AddItem(xy);
}

Point on_disc(double theta, double r) {
  const double angle = theta * std::numbers::pi / 180.0;
  return {r * std::sin(angle), r * std::cos(angle)};
}

/// The grid of a polar chart: circles of constant radius, rays of constant angle.
struct Disc {
  Point center;
  double radius = 1.0;  // of the outermost circle, in units of the picture
  double r_max = 1.0;   // its value
  double last = 90.0;   // the grid spans the angles -last to last [deg]
  std::string r_title;
};

void draw_line(vtkContext2D* painter, const Disc& disc, const std::vector<Point>& points) {
  std::vector<float> xy;
  for (const Point& p : points) {
    xy.push_back(static_cast<float>(disc.center.x + p.x));
    xy.push_back(static_cast<float>(disc.center.y + p.y));
  }
  painter->DrawPoly(xy.data(), static_cast<int>(points.size()));
}

void draw_circles(vtkContext2D* painter, const Disc& disc) {
  for (const Tick& tick : make_ticks({0.0, disc.r_max}, false, 4)) {
    const double radius = tick.value / disc.r_max * disc.radius;
    std::vector<Point> arc;
    for (double theta = -disc.last; theta <= disc.last; theta += 2.0) {
      arc.push_back(on_disc(theta, radius));
    }
    if (tick.value > 0.0) draw_line(painter, disc, arc);
  }
}

void draw_disc(vtkContext2D* painter, const Disc& disc) {
  painter->GetPen()->SetColorF(0.85, 0.85, 0.85);
  painter->GetPen()->SetOpacityF(1.0);
  painter->GetPen()->SetWidth(0.7F);
  painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
  draw_circles(painter, disc);
  for (int theta = -static_cast<int>(disc.last); theta <= static_cast<int>(disc.last);
       theta += 30) {
    if (theta == -180) continue;  // 180 again
    draw_line(painter, disc, {{0.0, 0.0}, on_disc(theta, disc.radius)});
    const Point at = on_disc(theta, disc.radius + 16.0);
    draw_text(painter, disc.center.x + at.x, disc.center.y + at.y, std::to_string(theta) + "°",
              kLabelSize);
  }
  // The surface.
  painter->GetPen()->SetColorF(0.3, 0.3, 0.3);
  painter->GetPen()->SetWidth(1.0F);
  draw_line(painter, disc, {{-disc.radius, 0.0}, {disc.radius, 0.0}});
}

/// Radii beneath the surface line (half disc), or on it. Over the curves, so that they can be read.
void draw_radii(vtkContext2D* painter, const Disc& disc) {
  for (const Tick& tick : make_ticks({0.0, disc.r_max}, false, 4)) {
    if (!(tick.value > 0.0)) continue;
    draw_text(painter, disc.center.x + tick.value / disc.r_max * disc.radius, disc.center.y - 11.0,
              tick.label, kLabelSize);
  }
  const double y = disc.last > 90.0 ? disc.center.y - disc.radius - 36.0 : disc.center.y - 30.0;
  draw_text(painter, disc.center.x, y, disc.r_title, kAxisTitleSize);
}

Disc make_disc(const PolarChart& chart, const Box& box) {
  Disc disc;
  disc.r_title = chart.r_title;
  double r_max = 0.0;
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!drawable(curve.x[i], false) || !drawable(curve.y[i], false)) continue;
      r_max = std::max(r_max, curve.y[i]);
      if (std::abs(curve.x[i]) > 90.0 + 1e-9) disc.last = 180.0;
    }
  }
  if (r_max < 1e-300) r_max = 1.0;
  const double step = round_step(r_max / 4.0);
  disc.r_max = chart.r_max.value_or(std::max(r_max, step * std::ceil(r_max / step - 1e-9)));
  // Room for the angles around and what is written below.
  const double around = 28.0, below = disc.last > 90.0 ? 48.0 : 42.0;
  const double height = box.y1 - box.y0 - around - below;
  disc.radius = std::max(10.0, std::min(0.5 * (box.x1 - box.x0) - around - kMargin,
                                        disc.last > 90.0 ? 0.5 * height : height));
  const double up = disc.last > 90.0 ? disc.radius : 0.0;
  const double spare = height - (disc.radius + up);
  disc.center = {0.5 * (box.x0 + box.x1), box.y0 + below + up + 0.5 * std::max(spare, 0.0)};
  return disc;
}

void add_panel(const PolarChart& chart, Box box, vtkContextScene* scene) {
  add_title(chart.title, box, scene);
  add_swatch_row(chart.swatches, box, scene);
  const Disc disc = make_disc(chart, box);
  add_drawing(scene, [disc](vtkContext2D* painter) { draw_disc(painter, disc); });
  // Axes along the edges of the panel, so that the legend is in its corner, with the ranges that
  // make the disc's scale theirs.
  const Box frame{box.x0 + kMargin, box.y0, box.x1 - kMargin, box.y1};
  const double scale = disc.r_max / disc.radius;
  const Box range{(frame.x0 - disc.center.x) * scale, (frame.y0 - disc.center.y) * scale,
                  (frame.x1 - disc.center.x) * scale, (frame.y1 - disc.center.y) * scale};
  const auto xy = make_chart(vtkChart::AXES_TO_RECT, frame);
  for (const int side : {vtkAxis::BOTTOM, vtkAxis::LEFT}) {
    vtkAxis* axis = xy->GetAxis(side);
    const bool x = side == vtkAxis::BOTTOM;
    set_axis(axis, "", {x ? range.x0 : range.y0, x ? range.x1 : range.y1}, false, 4);
    axis->SetVisible(false);
    axis->SetGridVisible(false);
  }
  std::vector<Curve> curves = chart.curves;
  for (Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const bool within = curve.y[i] <= disc.r_max;
      const double nan = std::numeric_limits<double>::quiet_NaN();
      const Point p = within ? on_disc(curve.x[i], curve.y[i]) : Point{nan, nan};
      curve.x[i] = p.x;
      curve.y[i] = p.y;
    }
  }
  add_curves(curves, false, false, range, xy);
  set_legend(xy, chart.legend, chart.curves);
  scene->AddItem(xy);
  add_drawing(scene, [disc](vtkContext2D* painter) { draw_radii(painter, disc); });
}

void add_panel(const SwatchChart& chart, Box box, vtkContextScene* scene) {
  add_title(chart.title, box, scene);
  if (chart.swatches.empty()) return;
  const Box inner{box.x0 + kMargin, box.y0 + kMargin, box.x1 - kMargin, box.y1 - kMargin};
  add_swatches(chart.swatches, chart.columns, inner, scene);
}

}  // namespace

void add_panels(const std::vector<Panel>& panels, const Picture& picture, vtkContextScene* scene) {
  const int columns = std::min(picture.columns, static_cast<int>(panels.size()));
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const double width = double{1} * picture.width / columns;
  const double height = double{1} * picture.height / rows;
  for (int i = 0; i < static_cast<int>(panels.size()); ++i) {
    const int row = i / columns, column = i % columns;
    const double x = width * column, y = picture.height - height * (row + 1);
    const Box box{x, y + 0.5 * kMargin, x + width, y + height - 0.5 * kMargin};
    std::visit([&](const auto& panel) { add_panel(panel, box, scene); },
               panels[static_cast<std::size_t>(i)]);
  }
}

}  // namespace atrium::plot
