#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

class vtkTextProperty;

namespace atrium::plot {

/// In units of the picture, y up, origin in the lower left corner.
struct Point {
  double x = 0.0, y = 0.0;
};

struct Box {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

using Rgba = std::array<unsigned char, 4>;  ///< encoded sRGB and opacity

struct Stroke {
  Rgba color{};
  double width = 1.0;
  std::vector<double> dashes = {};  ///< lengths drawn and left out by turns; empty: solid
};

/// The few primitives that a chart comes down to once all transforms are applied.
class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void set_clip(const std::optional<Box>& box) = 0;
  virtual void polyline(std::span<const Point> points, const Stroke& stroke) = 0;
  /// Filled, even-odd.
  virtual void polygon(std::span<const Point> points, const Rgba& fill) = 0;
  /// `style` says size, justification about `anchor`, rotation and colour.
  virtual void text(const Point& anchor, const std::string& text, vtkTextProperty* style) = 0;
  /// "" or what went wrong.
  virtual std::string write(const std::string& file) = 0;
};

std::unique_ptr<Canvas> make_svg_canvas(int width, int height);
std::unique_ptr<Canvas> make_image_canvas(int width, int height, int pixel_ratio);

}  // namespace atrium::plot
