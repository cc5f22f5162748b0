#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "material/error.h"
#include "plot/plot_module.h"
#include "plot/sheet_layout.h"
#include "scene/modules.h"
#include "scene/output_file.h"

namespace atrium::plot {
namespace {

const PlotModule& module() {
#ifdef ATRIUM_WITH_VTK
  static const PlotModule& loaded = scene::load_module<PlotEntry>("atrium_plot", kPlotInterface);
  return loaded;
#else
  throw RuntimeFailure("plots cannot be drawn: this build is without VTK");
#endif
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("write_plot: " + what);
}

void check(const Color& color, const std::string& name) {
  for (const double value : {color.r, color.g, color.b}) {
    if (!(value >= 0.0 && value <= 1.0)) {
      refuse("color of '" + name + "' is " + std::to_string(value) + " (valid: 0 to 1)");
    }
  }
}

void check(const std::vector<Curve>& curves) {
  for (const Curve& curve : curves) {
    if (curve.x.size() != curve.y.size()) {
      refuse("curve '" + curve.name + "' has " + std::to_string(curve.x.size()) + " x and " +
             std::to_string(curve.y.size()) + " y");
    }
    if (curve.color) check(*curve.color, curve.name);
  }
}

void check(const std::vector<Swatch>& swatches) {
  for (const Swatch& swatch : swatches) check(swatch.color, swatch.name);
}

void check(const std::optional<Range>& range, bool log, const char* axis) {
  if (!range) return;
  // Ends closer than this are one in the single precision that VTK draws with.
  const double size = std::max(std::abs(range->min), std::abs(range->max));
  const bool ok = size <= 1e300 && range->max - range->min >= 1e-5 * size &&
                  range->max - range->min >= 1e-300 && (!log || range->min > 0.0);
  if (!ok) {
    refuse(std::string(axis) + " range is " + std::to_string(range->min) + " to " +
           std::to_string(range->max) +
           " (valid: at most 1e300, max - min >= 1e-5 of the larger, positive if logarithmic)");
  }
}

void check(const Chart& chart) {
  check(chart.curves);
  check(chart.swatches);
  check(chart.x_range, chart.log_x, "x");
  check(chart.y_range, chart.log_y, "y");
}

void check(const PolarChart& chart) {
  check(chart.curves);
  check(chart.swatches);
  if (chart.r_max && !(*chart.r_max >= 1e-300 && *chart.r_max <= 1e300)) {
    refuse("r_max is " + std::to_string(*chart.r_max) + " (valid: 1e-300 to 1e300)");
  }
  for (const Curve& curve : chart.curves) {
    for (const double theta : curve.x) {
      if (std::abs(theta) > 180.0) {
        refuse("curve '" + curve.name + "' has the angle " + std::to_string(theta) +
               " (valid: -180 to 180 degrees)");
      }
    }
    for (const double r : curve.y) {
      if (r < 0.0) refuse("curve '" + curve.name + "' has a negative radius");
    }
  }
}

void check(const SwatchChart& chart) {
  check(chart.swatches);
  if (chart.columns < 1) refuse("columns of swatches must be positive");
}

void check(const SheetChart& sheet) {
  if (sheet.columns.empty() || sheet.tiles.size() != sheet.columns.size() * sheet.rows.size()) {
    refuse("sheet of " + std::to_string(sheet.columns.size()) + " x " +
           std::to_string(sheet.rows.size()) + " has " + std::to_string(sheet.tiles.size()) +
           " tiles");
  }
  const Tile* first = nullptr;
  for (const Tile& tile : sheet.tiles) {
    if (tile.width == 0) continue;
    if (first == nullptr) first = &tile;
    if (tile.width < 1 || tile.height < 1 || tile.width != first->width ||
        tile.height != first->height ||
        tile.rgb.size() !=
            3 * static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height)) {
      refuse("tile of " + std::to_string(tile.width) + " x " + std::to_string(tile.height) +
             " with " + std::to_string(tile.rgb.size()) +
             " bytes (valid: one size for all, 3 bytes of a pixel)");
    }
  }
  if (first == nullptr) refuse("sheet without a tile");
}

void check(const Picture& picture) {
  const auto side_ok = [](int side) { return side >= 100 && side <= 10000; };
  if (!side_ok(picture.width) || !side_ok(picture.height)) {
    refuse("picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
           " (valid: 100 to 10000)");
  }
  if (picture.columns < 1) refuse("columns must be positive");
  if (picture.pixel_ratio < 1 || picture.pixel_ratio > 4) {
    refuse("pixel_ratio is " + std::to_string(picture.pixel_ratio) + " (valid: 1 to 4)");
  }
}

}  // namespace

std::array<int, 2> sheet_size(const SheetChart& sheet) {
  const SheetLayout layout(sheet);
  return {static_cast<int>(std::ceil(layout.left + layout.columns * layout.cell_width())),
          static_cast<int>(std::ceil(layout.above() + layout.rows * layout.cell_height()))};
}

bool plot_available() {
  try {
    (void)module();
    return true;
  } catch (const RuntimeFailure&) {
    return false;
  }
}

bool is_plot_ending(const std::filesystem::path& file) {
  const std::string ending = scene::file_ending(file);
  return ending == ".svg" || ending == ".png";
}

void write_plot(const std::filesystem::path& file, const std::vector<Panel>& panels,
                const Picture& picture) {
  if (!is_plot_ending(file)) {
    throw Error(file.string() + ": unknown plot format (known: .svg .png)");
  }
  if (panels.empty()) refuse("no panels");
  check(picture);
  for (const Panel& panel : panels) std::visit([](const auto& p) { check(p); }, panel);
  scene::OutputFile out(file);
  const Format format = scene::file_ending(file) == ".svg" ? Format::Svg : Format::Png;
  const std::string problem = module().write(panels, picture, format, out.path().string());
  if (!problem.empty()) throw RuntimeFailure(file.string() + ": writing failed: " + problem);
  out.commit();
}

}  // namespace atrium::plot
