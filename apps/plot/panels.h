#pragma once

#include "plot/plot.h"

class vtkContextScene;

namespace atrium::plot {

/// Puts the panels into `scene`, which draws `picture`.
void add_panels(const std::vector<Panel>& panels, const Picture& picture, vtkContextScene* scene);

}  // namespace atrium::plot
