#pragma once

#include <vtkContextDevice2D.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <span>
#include <stack>
#include <vector>

#include "plot/canvas.h"

namespace atrium::plot {

/// Through this VTK's charts draw onto a Canvas: transforms become coordinates, pens and brushes
/// become values. VTK's own device for SVG scales pens and dashes by the axes of a plot, its other
/// ones need OpenGL. Markers and images, which the charts here have none of, are not drawn.
class ChartDevice final : public vtkContextDevice2D {
 public:
  static ChartDevice* New();
  vtkTypeMacro(ChartDevice, vtkContextDevice2D);
  ChartDevice(const ChartDevice&) = delete;
  void operator=(const ChartDevice&) = delete;

  /// nullptr: measure text, draw nothing.
  void set_canvas(Canvas* canvas) { canvas_ = canvas; }

  void DrawPoly(float* points, int n, unsigned char* colors, int components) override;
  void DrawLines(float* points, int n, unsigned char* colors, int components) override;
  void DrawPoints(float* points, int n, unsigned char* colors, int components) override;
  void DrawPointSprites(vtkImageData*, float*, int, unsigned char*, int) override {}
  void DrawMarkers(int, bool, float*, int, unsigned char*, int) override {}
  void DrawQuad(float* points, int n) override;
  void DrawQuadStrip(float* points, int n) override;
  void DrawPolygon(float* points, int n) override;
  void DrawColoredPolygon(float* points, int n, unsigned char* colors, int components) override;
  void DrawEllipseWedge(float x, float y, float outer_x, float outer_y, float inner_x,
                        float inner_y, float start, float stop) override;
  void DrawEllipticArc(float x, float y, float radius_x, float radius_y, float start,
                       float stop) override;

  void DrawString(float* point, const vtkStdString& text) override;
  void DrawMathTextString(float* point, const vtkStdString& text) override;
  void ComputeStringBounds(const vtkStdString& text, float bounds[4]) override;
  void ComputeJustifiedStringBounds(const char* text, float bounds[4]) override;
#if __has_include(<vtkUnicodeString.h>)
  void DrawString(float* point, const vtkUnicodeString& text) override;
  void ComputeStringBounds(const vtkUnicodeString& text, float bounds[4]) override;
#endif
  void DrawImage(float*, float, vtkImageData*) override {}
  void DrawImage(const vtkRectf&, vtkImageData*) override {}

  void SetColor4(unsigned char*) override {}  // pen and brush say it
  void SetTexture(vtkImageData*, int) override {}
  void SetPointSize(float) override {}
  void SetLineWidth(float) override {}
  void SetLineType(int) override {}

  void SetMatrix(vtkMatrix3x3* m) override;
  void GetMatrix(vtkMatrix3x3* m) override;
  void MultiplyMatrix(vtkMatrix3x3* m) override;
  void PushMatrix() override;
  void PopMatrix() override;
  void SetClipping(int* rectangle) override;
  void EnableClipping(bool enable) override;

 private:
  ChartDevice() = default;
  ~ChartDevice() override = default;

  [[nodiscard]] std::vector<Point> transformed(const float* points, int n) const;
  [[nodiscard]] std::optional<Stroke> stroke() const;  ///< of the pen; none: not drawn
  [[nodiscard]] Rgba fill() const;                     ///< of the brush
  void draw_polygon(std::span<const Point> points);
  void apply_clipping();

  Canvas* canvas_ = nullptr;
  vtkNew<vtkMatrix3x3> matrix_;
  std::stack<vtkSmartPointer<vtkMatrix3x3>> saved_;
  Box clip_box_;
  bool clipping_ = false;
};

}  // namespace atrium::plot
