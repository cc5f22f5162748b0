#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "plot/canvas.h"

namespace atrium::plot {
namespace {

/// Two digits are a hundredth of a pixel; no exponents, no trailing zeros, no locale.
std::string number(double value) {
  const long hundredths = std::lround(value * 100.0);
  const long rest = std::labs(hundredths) % 100;
  std::string text = hundredths < 0 ? "-" : "";
  text += std::to_string(std::labs(hundredths) / 100);
  if (rest != 0) {
    text += rest < 10 ? ".0" : ".";
    text += std::to_string(rest % 10 == 0 ? rest / 10 : rest);
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      // Other control characters are not allowed in XML at all.
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

/// name="#rrggbb" and, if it is not opaque, name-opacity.
std::string paint(const char* name, const Rgba& color) {
  char hex[8];
  std::snprintf(hex, sizeof hex, "#%02x%02x%02x", color[0], color[1], color[2]);
  std::string out = std::string(" ") + name + "=\"" + hex + "\"";
  if (color[3] < 255) {
    out += std::string(" ") + name + "-opacity=\"" + number(color[3] / 255.0) + "\"";
  }
  return out;
}

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(int width, int height) : width_(width), height_(height) {}

  void set_clip(const std::optional<Box>& box) override {
    clip_ = {};
    if (!box) return;
    const std::string rectangle =
        "<rect x=\"" + number(box->x0) + "\" y=\"" + number(height_ - box->y1) + "\" width=\"" +
        number(box->x1 - box->x0) + "\" height=\"" + number(box->y1 - box->y0) + "\"/>";
    // A chart clips several times to the same rectangle.
    std::size_t index = 0;
    while (index < clips_.size() && clips_[index] != rectangle) ++index;
    if (index == clips_.size()) clips_.push_back(rectangle);
    clip_ = " clip-path=\"url(#clip" + std::to_string(index) + ")\"";
  }

  void polyline(std::span<const Point> points, const Stroke& stroke) override {
    body_ << "<polyline points=\"" << list(points) << "\" fill=\"none\""
          << paint("stroke", stroke.color) << " stroke-width=\"" << number(stroke.width) << "\"";
    if (!stroke.dashes.empty()) {
      body_ << " stroke-dasharray=\"";
      for (std::size_t i = 0; i < stroke.dashes.size(); ++i) {
        body_ << (i == 0 ? "" : " ") << number(stroke.dashes[i]);
      }
      body_ << "\"";
    }
    body_ << " stroke-linejoin=\"round\" stroke-linecap=\"round\"" << clip_ << "/>\n";
  }

  void polygon(std::span<const Point> points, const Rgba& fill) override {
    body_ << "<polygon points=\"" << list(points) << "\"" << paint("fill", fill)
          << " fill-rule=\"evenodd\"" << clip_ << "/>\n";
  }

  void text(const Point& anchor, const std::string& text, vtkTextProperty* style) override {
    const double angle = style->GetOrientation();
    double rgb[3];
    style->GetColor(rgb);
    const auto channel = [](double v) { return static_cast<unsigned char>(std::lround(v * 255)); };
    const char* const anchors[] = {"start", "middle", "end"};
    body_ << "<text transform=\"translate(" << number(anchor.x) << ' ' << number(height_ - anchor.y)
          << ")";
    if (angle != 0.0) body_ << " rotate(" << number(-angle) << ")";
    body_ << "\" y=\"" << number(-baseline(text, style)) << "\" font-size=\""
          << style->GetFontSize() << "\" text-anchor=\"" << anchors[style->GetJustification()]
          << "\"" << paint("fill", {channel(rgb[0]), channel(rgb[1]), channel(rgb[2]), 255});
    if (style->GetBold() != 0) body_ << " font-weight=\"bold\"";
    if (style->GetItalic() != 0) body_ << " font-style=\"italic\"";
    body_ << clip_ << ">" << escaped(text) << "</text>\n";
  }

  std::string write(const std::string& file) override {
    std::ofstream out(file, std::ios::binary);
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width_ << "\" height=\""
        << height_ << "\" viewBox=\"0 0 " << width_ << ' ' << height_
        << "\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\">\n<defs>\n";
    for (std::size_t i = 0; i < clips_.size(); ++i) {
      out << "<clipPath id=\"clip" << i << "\">" << clips_[i] << "</clipPath>\n";
    }
    out << "</defs>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        << body_.str() << "</svg>\n";
    out.close();
    return out ? "" : "the file cannot be written";
  }

 private:
  std::string list(std::span<const Point> points) const {
    std::string out;
    for (const Point& p : points) {
      if (!out.empty()) out += ' ';
      out += number(p.x) + "," + number(height_ - p.y);
    }
    return out;
  }

  /// Height of the base line above the anchor, along the rotated text's own up.
  static double baseline(const std::string& text, vtkTextProperty* style) {
    vtkTextRenderer::Metrics metrics;
    vtkNew<vtkTextProperty> level;
    level->ShallowCopy(style);
    level->SetOrientation(0.0);
    vtkTextRenderer::GetInstance()->GetMetrics(level, vtkStdString(text), metrics, 72,
                                               vtkTextRenderer::FreeType);
    return metrics.BottomLeft[1] - metrics.Descent[1];
  }

  int width_, height_;
  std::vector<std::string> clips_;
  std::string clip_;  // attribute of what is drawn now
  std::ostringstream body_;
};

}  // namespace

std::unique_ptr<Canvas> make_svg_canvas(int width, int height) {
  return std::make_unique<SvgCanvas>(width, height);
}

}  // namespace atrium::plot
