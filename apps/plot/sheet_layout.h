#pragma once

#include <algorithm>

#include "plot/plot.h"

namespace atrium::plot {

/// Measures of a contact sheet, in units of the picture.
struct SheetLayout {
  static constexpr double kGap = 4.0, kMargin = 10.0, kTitle = 30.0, kColumnName = 20.0;

  int columns, rows;
  double tile_width = 1.0, tile_height = 1.0;
  double left = 4.0;  ///< what the names of rows take

  explicit SheetLayout(const SheetChart& sheet)
      : columns(static_cast<int>(sheet.columns.size())),
        rows(static_cast<int>(sheet.rows.size())),
        title_(sheet.title.empty() ? 0.0 : kTitle) {
    for (const Tile& tile : sheet.tiles) {
      if (tile.width == 0) continue;
      tile_width = tile.width;
      tile_height = tile.height;
    }
    // Wide enough for names in the font of labels, whose letters are about 6.7 wide.
    for (const std::string& name : sheet.rows)
      left = std::max(left, 12.0 + static_cast<double>(7 * name.size()));
  }
  [[nodiscard]] double cell_width(double scale = 1.0) const { return tile_width * scale + kGap; }
  [[nodiscard]] double cell_height(double scale = 1.0) const { return tile_height * scale + kGap; }
  /// What margins, title and names of columns take of the height.
  [[nodiscard]] double above() const { return kMargin + title_ + kColumnName; }

 private:
  double title_;
};

}  // namespace atrium::plot
