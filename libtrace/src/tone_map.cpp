#include "trace/tone_map.h"

#include <cmath>
#include <stdexcept>

#include "rgb_planes.h"

namespace atrium::trace {

namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kSaturation = 1.2;  // L_max = 1.2 * 2^EV at ISO 100 (ISO 12232, saturation speed)

double encode_srgb(double v) {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

}  // namespace

double filmic_curve(double x) {
  // Scaled so that the curve leaves middle grey where it is.
  const double s = 0.72317 * x;
  return std::min(1.0, s * (2.51 * s + 0.03) / (s * (2.43 * s + 0.59) + 0.14));
}

double automatic_ev(const scene::Image& image) {
  const RgbPlanes rgb(image);
  std::vector<double> lit;
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const double y = rgb.luminance(i);
    if (y > 0.0 && std::isfinite(y)) lit.push_back(std::log2(y));
  }
  if (lit.empty()) return 0.0;
  std::sort(lit.begin(), lit.end());
  const std::size_t first = lit.size() / 5;
  const std::size_t last = std::max(first + 1, lit.size() * 19 / 20);
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += lit[i];
  const double log_mean = sum / static_cast<double>(last - first);
  return log_mean - std::log2(kMiddleGrey * kSaturation);
}

double white_at(double ev) { return kSaturation * std::exp2(ev); }

scene::Image tone_map(const scene::Image& image, const ToneMapOptions& options) {
  const RgbPlanes rgb(image);
  const double ev = options.ev ? *options.ev : automatic_ev(image);
  const double scale = 1.0 / white_at(ev);
  scene::Image result;
  result.width = image.width;
  result.height = image.height;
  result.channels = {"R", "G", "B"};
  result.metadata = image.metadata;
  result.pixels.resize(rgb.size() * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double v = scale * rgb.value(i, c);
      double display = 0.0;
      if (v > 0.0 && std::isfinite(v)) {
        display =
            options.curve == ToneMapOptions::Curve::Filmic ? filmic_curve(v) : std::min(1.0, v);
      }
      result.pixels[i * 3 + static_cast<std::size_t>(c)] = static_cast<float>(encode_srgb(display));
    }
  }
  return result;
}

}  // namespace atrium::trace
