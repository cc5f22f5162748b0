#pragma once

#include <functional>
#include <string>

#include "plot/canvas.h"

class vtkContext2D;
class vtkContextScene;

namespace atrium::plot {

inline constexpr int kTitleSize = 14, kAxisTitleSize = 12, kLabelSize = 11;

/// An item of the scene that `paint` draws, in units of the picture.
void add_drawing(vtkContextScene* scene, std::function<void(vtkContext2D*)> paint);
void set_text(vtkTextProperty* style, int size, bool bold = false);
/// Centred about (x, y).
void draw_text(vtkContext2D* painter, double x, double y, const std::string& text, int size,
               bool bold = false);
/// Takes a strip off the top of `box` for the title.
void add_title(const std::string& title, Box& box, vtkContextScene* scene);

}  // namespace atrium::plot
