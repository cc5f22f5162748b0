#pragma once

#include "plot/canvas.h"
#include "plot/plot.h"

class vtkContextScene;

namespace atrium::plot {

/// Puts the panels into `scene`, which draws `picture`.
void add_panels(const std::vector<Panel>& panels, const Picture& picture, vtkContextScene* scene);

/// Of the rest, one panel within `box`.
void add_panel(const SheetChart& sheet, Box box, vtkContextScene* scene);

}  // namespace atrium::plot
