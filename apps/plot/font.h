#pragma once

class vtkTextProperty;

namespace atrium::plot {

/// DejaVu Sans if the system has it where distributions put it, else the font inside VTK, which may
/// lack Greek letters. In an SVG the viewer chooses; DejaVu is wide, so that what was laid out with
/// it has room for other fonts.
void set_font(vtkTextProperty* style, bool bold);

}  // namespace atrium::plot
