#include <vtkContext2D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRect.h>

#include <algorithm>

#include "plot/drawing.h"
#include "plot/panels.h"
#include "plot/sheet_layout.h"

namespace atrium::plot {
namespace {

void draw_tile(vtkContext2D* painter, const Tile& tile, const Box& box) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(tile.width, tile.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::copy(tile.rgb.begin(), tile.rgb.end(),
            static_cast<unsigned char*>(image->GetScalarPointer()));
  const auto f = [](double v) { return static_cast<float>(v); };
  painter->DrawImage(vtkRectf(f(box.x0), f(box.y0), f(box.x1 - box.x0), f(box.y1 - box.y0)), image);
}

}  // namespace

void add_panel(const SheetChart& sheet, Box box, vtkContextScene* scene) {
  add_title(sheet.title, box, scene);
  const SheetLayout layout(sheet);
  box.y1 -= SheetLayout::kColumnName;
  const double gap = SheetLayout::kGap;
  const double scale = std::max(
      1e-3, std::min((box.x1 - box.x0 - layout.left - layout.columns * gap) /
                         (layout.columns * layout.tile_width),
                     (box.y1 - box.y0 - layout.rows * gap) / (layout.rows * layout.tile_height)));
  const double width = layout.cell_width(scale), height = layout.cell_height(scale);
  const double x0 = box.x0 + layout.left;
  add_drawing(scene, [=](vtkContext2D* painter) {
    for (int i = 0; i < layout.columns; ++i)
      draw_text(painter, x0 + (i + 0.5) * width - 0.5 * gap,
                box.y1 + 0.5 * SheetLayout::kColumnName, sheet.columns[static_cast<std::size_t>(i)],
                kLabelSize);
    for (int i = 0; i < layout.rows; ++i)
      draw_text(painter, box.x0 + 0.5 * layout.left, box.y1 - (i + 0.5) * height + 0.5 * gap,
                sheet.rows[static_cast<std::size_t>(i)], kLabelSize);
    for (int i = 0; i < layout.columns * layout.rows; ++i) {
      const Tile& tile = sheet.tiles[static_cast<std::size_t>(i)];
      if (tile.width == 0) continue;
      const int row = i / layout.columns, column = i % layout.columns;
      const double x = x0 + width * column, y = box.y1 - height * row;
      draw_tile(painter, tile, {x, y - height + gap, x + width - gap, y});
    }
  });
}

}  // namespace atrium::plot
