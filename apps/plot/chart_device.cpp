#include "plot/chart_device.h"

#include <vtkBrush.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#if __has_include(<vtkUnicodeString.h>)
#include <vtkUnicodeString.h>
#endif

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::plot {

vtkStandardNewMacro(ChartDevice);

std::vector<Point> ChartDevice::transformed(const float* points, int n) const {
  std::vector<Point> out(static_cast<std::size_t>(std::max(n, 0)));
  vtkMatrix3x3* const m = matrix_;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double x = static_cast<double>(points[2 * i]);
    const double y = static_cast<double>(points[2 * i + 1]);
    out[i] = {m->GetElement(0, 0) * x + m->GetElement(0, 1) * y + m->GetElement(0, 2),
              m->GetElement(1, 0) * x + m->GetElement(1, 1) * y + m->GetElement(1, 2)};
  }
  return out;
}

std::optional<Stroke> ChartDevice::stroke() const {
  const int type = this->Pen->GetLineType();
  if (type == vtkPen::NO_PEN || this->Pen->GetOpacity() == 0) return {};
  Stroke stroke;
  this->Pen->GetColor(stroke.color.data());
  stroke.color[3] = this->Pen->GetOpacity();
  stroke.width = static_cast<double>(this->Pen->GetWidth());
  if (type == vtkPen::DASH_LINE) stroke.dashes = {5, 4.5};
  if (type == vtkPen::DOT_LINE || type == vtkPen::DENSE_DOT_LINE) stroke.dashes = {0.5, 3.5};
  if (type == vtkPen::DASH_DOT_LINE) stroke.dashes = {5, 4, 0.5, 4};
  if (type == vtkPen::DASH_DOT_DOT_LINE) stroke.dashes = {5, 4, 0.5, 4, 0.5, 4};
  return stroke;
}

Rgba ChartDevice::fill() const {
  Rgba color{};
  this->Brush->GetColor(color.data());
  color[3] = this->Brush->GetOpacity();
  return color;
}

void ChartDevice::DrawPoly(float* points, int n, unsigned char*, int) {
  const auto pen = stroke();
  if (canvas_ == nullptr || !pen || n < 2) return;
  canvas_->polyline(transformed(points, n), *pen);
}

void ChartDevice::DrawLines(float* points, int n, unsigned char*, int) {
  const auto pen = stroke();
  if (canvas_ == nullptr || !pen) return;
  const std::vector<Point> ends = transformed(points, n);
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    canvas_->polyline(std::span(ends).subspan(i, 2), *pen);
  }
}

void ChartDevice::DrawPoints(float* points, int n, unsigned char*, int) {
  const auto pen = stroke();
  if (canvas_ == nullptr || !pen) return;
  const double half = 0.5 * pen->width;
  for (const Point& p : transformed(points, n)) {
    const Point corners[] = {{p.x - half, p.y - half},
                             {p.x + half, p.y - half},
                             {p.x + half, p.y + half},
                             {p.x - half, p.y + half}};
    canvas_->polygon(corners, pen->color);
  }
}

void ChartDevice::draw_polygon(std::span<const Point> points) {
  const Rgba color = fill();
  if (canvas_ != nullptr && color[3] != 0 && points.size() >= 3) canvas_->polygon(points, color);
}

void ChartDevice::DrawQuad(float* points, int n) {
  const std::vector<Point> corners = transformed(points, n);
  for (std::size_t i = 0; i + 3 < corners.size(); i += 4) {
    draw_polygon(std::span(corners).subspan(i, 4));
  }
}

void ChartDevice::DrawQuadStrip(float* points, int n) {
  const std::vector<Point> p = transformed(points, n);
  for (std::size_t i = 0; i + 3 < p.size(); i += 2) {
    const Point corners[] = {p[i], p[i + 1], p[i + 3], p[i + 2]};
    draw_polygon(corners);
  }
}

void ChartDevice::DrawPolygon(float* points, int n) { draw_polygon(transformed(points, n)); }

void ChartDevice::DrawColoredPolygon(float* points, int n, unsigned char* colors, int components) {
  if (colors == nullptr || components < 3) return DrawPolygon(points, n);
  const auto opacity = static_cast<unsigned char>(components > 3 ? colors[3] : 255);
  if (canvas_ != nullptr && n >= 3) {
    canvas_->polygon(transformed(points, n), {colors[0], colors[1], colors[2], opacity});
  }
}

namespace {

/// Points along an ellipse, every two degrees, interleaved as VTK has them.
void append_arc(std::vector<float>& points, float x, float y, float rx, float ry, float start,
                float stop) {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(stop - start) / 2.0F)));
  for (int i = 0; i <= steps; ++i) {
    const float degrees =
        start + (stop - start) * static_cast<float>(i) / static_cast<float>(steps);
    const float angle = degrees * std::numbers::pi_v<float> / 180.0F;
    points.push_back(x + rx * std::cos(angle));
    points.push_back(y + ry * std::sin(angle));
  }
}

}  // namespace

void ChartDevice::DrawEllipseWedge(float x, float y, float outer_x, float outer_y, float inner_x,
                                   float inner_y, float start, float stop) {
  std::vector<float> points;
  append_arc(points, x, y, outer_x, outer_y, start, stop);
  append_arc(points, x, y, inner_x, inner_y, stop, start);
  DrawPolygon(points.data(), static_cast<int>(points.size() / 2));
}

void ChartDevice::DrawEllipticArc(float x, float y, float radius_x, float radius_y, float start,
                                  float stop) {
  std::vector<float> points;
  append_arc(points, x, y, radius_x, radius_y, start, stop);
  const int n = static_cast<int>(points.size() / 2);
  DrawPolygon(points.data(), n);
  DrawPoly(points.data(), n, nullptr, 0);
}

void ChartDevice::DrawString(float* point, const vtkStdString& text) {
  if (canvas_ == nullptr || text.empty()) return;
  canvas_->text(transformed(point, 1).front(), text, this->TextProp);
}

void ChartDevice::DrawMathTextString(float* point, const vtkStdString& text) {
  DrawString(point, text);
}

void ChartDevice::ComputeStringBounds(const vtkStdString& text, float bounds[4]) {
  // With its rotation, although VTK's description says without: vtkAxis relies on it.
  int box[4] = {0, -1, 0, -1};
  vtkTextRenderer::GetInstance()->GetBoundingBox(this->TextProp, text, box, 72,
                                                 vtkTextRenderer::FreeType);
  // In the units of the painter, which may be scaled.
  const double sx = std::abs(matrix_->GetElement(0, 0));
  const double sy = std::abs(matrix_->GetElement(1, 1));
  const bool drawn = !text.empty() && box[1] >= box[0] && box[3] >= box[2] && sx > 0 && sy > 0;
  bounds[0] = bounds[1] = 0.0F;
  bounds[2] = drawn ? static_cast<float>((box[1] - box[0]) / sx) : 0.0F;
  bounds[3] = drawn ? static_cast<float>((box[3] - box[2]) / sy) : 0.0F;
}

void ChartDevice::ComputeJustifiedStringBounds(const char* text, float bounds[4]) {
  int box[4] = {0, 0, 0, 0};
  vtkTextRenderer::GetInstance()->GetBoundingBox(this->TextProp, vtkStdString(text), box, 72,
                                                 vtkTextRenderer::FreeType);
  bounds[0] = static_cast<float>(box[0]);
  bounds[1] = static_cast<float>(box[2]);
  bounds[2] = static_cast<float>(box[1] - box[0] + 1);
  bounds[3] = static_cast<float>(box[3] - box[2] + 1);
}

#if __has_include(<vtkUnicodeString.h>)
void ChartDevice::DrawString(float* point, const vtkUnicodeString& text) {
  DrawString(point, vtkStdString(text.utf8_str()));
}
void ChartDevice::ComputeStringBounds(const vtkUnicodeString& text, float bounds[4]) {
  ComputeStringBounds(vtkStdString(text.utf8_str()), bounds);
}
#endif

void ChartDevice::SetMatrix(vtkMatrix3x3* m) { matrix_->DeepCopy(m); }
void ChartDevice::GetMatrix(vtkMatrix3x3* m) { m->DeepCopy(matrix_); }

void ChartDevice::MultiplyMatrix(vtkMatrix3x3* m) {
  vtkNew<vtkMatrix3x3> product;
  vtkMatrix3x3::Multiply3x3(matrix_, m, product);
  matrix_->DeepCopy(product);
}

void ChartDevice::PushMatrix() {
  saved_.push(vtkSmartPointer<vtkMatrix3x3>::New());
  saved_.top()->DeepCopy(matrix_);
}

void ChartDevice::PopMatrix() {
  if (saved_.empty()) return;
  matrix_->DeepCopy(saved_.top());
  saved_.pop();
}

void ChartDevice::SetClipping(int* rectangle) {
  clip_box_ = {double{1} * rectangle[0], double{1} * rectangle[1],
               double{1} * rectangle[0] + rectangle[2], double{1} * rectangle[1] + rectangle[3]};
  apply_clipping();
}

void ChartDevice::EnableClipping(bool enable) {
  clipping_ = enable;
  apply_clipping();
}

void ChartDevice::apply_clipping() {
  if (canvas_ == nullptr) return;
  canvas_->set_clip(clipping_ ? std::optional(clip_box_) : std::nullopt);
}

}  // namespace atrium::plot
