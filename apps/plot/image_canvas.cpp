// A software rasteriser for what charts are made of: VTK draws them through OpenGL only, which
// needs a display.
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <algorithm>
#include <cmath>

#include "plot/canvas.h"

namespace atrium::plot {
namespace {

double distance(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// The pieces that a dash pattern leaves of a line.
std::vector<std::vector<Point>> dashed(std::span<const Point> points,
                                       const std::vector<double>& dashes) {
  std::vector<std::vector<Point>> pieces{{points.front()}};
  std::size_t phase = 0;
  double left = dashes[0];
  for (std::size_t i = 1; i < points.size(); ++i) {
    Point at = points[i - 1];
    double rest = std::hypot(points[i].x - at.x, points[i].y - at.y);
    while (rest > left) {
      at = {at.x + (points[i].x - at.x) * left / rest, at.y + (points[i].y - at.y) * left / rest};
      rest -= left;
      if (phase % 2 == 0) pieces.back().push_back(at);
      phase = (phase + 1) % dashes.size();
      left = dashes[phase];
      if (phase % 2 == 0) pieces.push_back({at});
    }
    left -= rest;
    if (phase % 2 == 0) pieces.back().push_back(points[i]);
  }
  return pieces;
}

class ImageCanvas final : public Canvas {
 public:
  ImageCanvas(int width, int height, int ratio)
      : ratio_(ratio),
        width_(width * ratio),
        height_(height * ratio),
        pixels_(size() * 3, 255.0F),
        coverage_(size(), 0.0F) {
    set_clip({});
  }

  void set_clip(const std::optional<Box>& box) override {
    clip_ = {0, 0, width_, height_};
    if (!box) return;
    const auto pixel = [this](double v, int limit) {
      return static_cast<int>(std::lround(std::clamp(v * ratio_, 0.0, double{1} * limit)));
    };
    clip_ = {pixel(box->x0, width_), pixel(box->y0, height_), pixel(box->x1, width_),
             pixel(box->y1, height_)};
  }

  void polyline(std::span<const Point> points, const Stroke& stroke) override {
    if (points.empty()) return;
    const std::vector<Point> scaled = to_pixels(points);
    const double radius = 0.5 * std::max(stroke.width * ratio_, 1.0);
    Window drawn;
    if (stroke.dashes.empty()) {
      cover(scaled, radius, drawn);
    } else {
      std::vector<double> dashes = stroke.dashes;
      for (double& dash : dashes) dash *= ratio_;
      for (const auto& piece : dashed(scaled, dashes)) cover(piece, radius, drawn);
    }
    blend(drawn, stroke.color);
  }

  void polygon(std::span<const Point> points, const Rgba& fill) override {
    if (points.size() < 3) return;
    const std::vector<Point> corners = to_pixels(points);
    Window drawn;
    for (const Point& p : corners) drawn.add(p, 0.0);
    drawn.limit(clip_);
    for (int y = drawn.y0; y < drawn.y1; ++y) {
      for (int sub = 0; sub < kSubLines; ++sub) {
        cover_line(corners, y, y + (sub + 0.5) / kSubLines, drawn);
      }
    }
    blend(drawn, fill);
  }

  void text(const Point& anchor, const std::string& text, vtkTextProperty* style) override {
    vtkNew<vtkTextProperty> scaled;
    scaled->ShallowCopy(style);
    scaled->SetFontSize(style->GetFontSize() * ratio_);
    vtkNew<vtkImageData> letters;  // its extent is about the anchor
    int size[2];
    vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
    renderer->SetScaleToPowerOfTwo(false);
    if (!renderer->RenderString(scaled, vtkStdString(text), letters, size, 72,
                                vtkTextRenderer::FreeType))
      return;
    int extent[6];
    letters->GetExtent(extent);
    const int x0 = static_cast<int>(std::lround(anchor.x * ratio_));
    const int y0 = static_cast<int>(std::lround(anchor.y * ratio_));
    for (int y = std::max(extent[2], clip_.y0 - y0); y <= std::min(extent[3], clip_.y1 - 1 - y0);
         ++y) {
      for (int x = std::max(extent[0], clip_.x0 - x0); x <= std::min(extent[1], clip_.x1 - 1 - x0);
           ++x) {
        const auto* rgba = static_cast<unsigned char*>(letters->GetScalarPointer(x, y, 0));
        mix(x0 + x, y0 + y, rgba, static_cast<float>(rgba[3]) / 255.0F);
      }
    }
  }

  std::string write(const std::string& file) override {
    vtkNew<vtkImageData> image;
    image->SetDimensions(width_, height_, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    std::transform(pixels_.begin(), pixels_.end(),
                   static_cast<unsigned char*>(image->GetScalarPointer()),
                   [](float v) { return static_cast<unsigned char>(std::lround(v)); });
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetInputData(image);
    writer->Write();
    if (writer->GetErrorCode() == vtkErrorCode::NoError) return {};
    return vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode());
  }

 private:
  static constexpr int kSubLines = 8;

  /// Pixels [x0, x1) x [y0, y1).
  struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    void add(const Point& p, double margin) {
      // Far outside is as good as outside, and an int holds it.
      const auto pixel = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
      add({pixel(std::floor(p.x - margin)), pixel(std::floor(p.y - margin)),
           pixel(std::ceil(p.x + margin)) + 1, pixel(std::ceil(p.y + margin)) + 1});
    }
    void add(const Window& other) {
      if (other.empty()) return;
      if (empty()) {
        *this = other;
        return;
      }
      x0 = std::min(x0, other.x0), y0 = std::min(y0, other.y0);
      x1 = std::max(x1, other.x1), y1 = std::max(y1, other.y1);
    }
    void limit(const Window& to) {
      x0 = std::max(x0, to.x0), y0 = std::max(y0, to.y0);
      x1 = std::min(x1, to.x1), y1 = std::min(y1, to.y1);
    }
  };

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::vector<Point> to_pixels(std::span<const Point> points) const {
    std::vector<Point> out(points.begin(), points.end());
    for (Point& p : out) p = {p.x * ratio_, p.y * ratio_};
    return out;
  }

  /// The largest coverage by any segment: joints are round and nothing is painted twice.
  void cover(const std::vector<Point>& line, double radius, Window& drawn) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      Window window;
      window.add(line[i], radius);
      window.add(line[i + 1], radius);
      window.limit(clip_);
      drawn.add(window);
      for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
          const double d = distance({x + 0.5, y + 0.5}, line[i], line[i + 1]);
          const auto covered = static_cast<float>(std::clamp(radius + 0.5 - d, 0.0, 1.0));
          coverage_[index(x, y)] = std::max(coverage_[index(x, y)], covered);
        }
      }
    }
  }

  /// Adds what the polygon covers of the pixels along one of kSubLines lines of row y.
  void cover_line(const std::vector<Point>& corners, int y, double line_y, const Window& window) {
    std::vector<double> crossings;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point& a = corners[i];
      const Point& b = corners[(i + 1) % corners.size()];
      if ((a.y <= line_y) == (b.y <= line_y)) continue;
      crossings.push_back(a.x + (line_y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      for (int x = window.x0; x < window.x1; ++x) {
        const double covered =
            std::min(x + 1.0, crossings[i + 1]) - std::max(double{1} * x, crossings[i]);
        if (covered > 0.0) coverage_[index(x, y)] += static_cast<float>(covered / kSubLines);
      }
    }
  }

  void blend(const Window& window, const Rgba& color) {
    const float opacity = static_cast<float>(color[3]) / 255.0F;
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        float& covered = coverage_[index(x, y)];
        if (covered > 0.0F) mix(x, y, color.data(), std::min(covered, 1.0F) * opacity);
        covered = 0.0F;
      }
    }
  }

  void mix(int x, int y, const unsigned char* rgb, float share) {
    float* pixel = &pixels_[3 * index(x, y)];
    for (int c = 0; c < 3; ++c) pixel[c] += share * (static_cast<float>(rgb[c]) - pixel[c]);
  }

  int ratio_, width_, height_;
  std::vector<float> pixels_;    // rows from below, RGB
  std::vector<float> coverage_;  // of the primitive being drawn, else 0
  Window clip_;
};

}  // namespace

std::unique_ptr<Canvas> make_image_canvas(int width, int height, int pixel_ratio) {
  return std::make_unique<ImageCanvas>(width, height, pixel_ratio);
}

}  // namespace atrium::plot
