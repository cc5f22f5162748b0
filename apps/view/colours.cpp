#include "colours.h"

#include <vtkColorTransferFunction.h>
#include <vtkLookupTable.h>
#include <vtkMath.h>
#include <vtkNew.h>

#include <cmath>
#include <numbers>
#include <span>

#include "trace/tone_map.h"

namespace atrium::view {
namespace {

struct Stop {
  double at, r, g, b;
};
constexpr Stop kLight[] = {{0.00, 0.07, 0.05, 0.33}, {0.14, 0.12, 0.26, 0.78},
                           {0.30, 0.10, 0.62, 0.86}, {0.46, 0.22, 0.74, 0.40},
                           {0.62, 0.78, 0.86, 0.22}, {0.74, 0.99, 0.80, 0.18},
                           {0.88, 0.95, 0.42, 0.11}, {1.00, 0.68, 0.07, 0.10}};
constexpr Stop kErrors[] = {{0.00, 0.06, 0.05, 0.11},
                            {0.35, 0.35, 0.12, 0.43},
                            {0.65, 0.78, 0.30, 0.38},
                            {0.85, 0.96, 0.63, 0.35},
                            {1.00, 0.99, 0.95, 0.75}};

constexpr int kColours = 256;

Colour to_colour(const double rgb[3]) {
  const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255.0 * v)); };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
}

scene::Image image_of(std::span<const float> rgb, double scale) {
  scene::Image image;
  image.width = static_cast<int>(rgb.size() / 3);
  image.height = 1;
  image.channels = {"R", "G", "B"};
  image.pixels.reserve(rgb.size());
  for (const float v : rgb) image.pixels.push_back(static_cast<float>(scale) * v);
  return image;
}

std::vector<Colour> display(const Values& values, double scale, const trace::ToneMapOptions& how) {
  std::vector<Colour> colours(values.size(), kGrey);
  if (values.components != 3 || values.numbers.empty()) return colours;
  const scene::Image shown = trace::tone_map(image_of(values.numbers, scale), how);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (!std::isfinite(values.numbers[3 * i])) continue;
    const double rgb[3] = {static_cast<double>(shown.pixels[3 * i]),
                           static_cast<double>(shown.pixels[3 * i + 1]),
                           static_cast<double>(shown.pixels[3 * i + 2])};
    colours[i] = to_colour(rgb);
  }
  return colours;
}

}  // namespace

vtkSmartPointer<vtkLookupTable> make_table(Look look, const Range& range) {
  vtkNew<vtkColorTransferFunction> curve;
  curve->SetColorSpaceToLab();
  const std::span<const Stop> stops = look == Look::Error ? std::span<const Stop>(kErrors) : kLight;
  for (const Stop& s : stops) curve->AddRGBPoint(s.at, s.r, s.g, s.b);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(kColours);
  for (int i = 0; i < kColours; ++i) {
    double rgb[3];
    curve->GetColor(static_cast<double>(i) / (kColours - 1), rgb);
    table->SetTableValue(i, rgb[0], rgb[1], rgb[2]);
  }
  if (range.logarithmic) table->SetScaleToLog10();
  table->SetTableRange(range.low, range.high);
  table->SetNanColor(kGrey[0] / 255.0, kGrey[1] / 255.0, kGrey[2] / 255.0, 1.0);
  return table;
}

Colour class_colour(std::uint32_t number) {
  // Hues by the golden ratio, in three rings of brightness.
  const double turn = 0.61803398875 * number + 0.58;
  const double hue = turn - std::floor(turn);
  const std::uint32_t ring = number % 3;
  double rgb[3];
  vtkMath::HSVToRGB(hue, ring == 1 ? 0.35 : 0.65, ring == 2 ? 0.60 : 0.90, &rgb[0], &rgb[1],
                    &rgb[2]);
  return to_colour(rgb);
}

std::vector<Colour> tone_mapped(const Values& values, double ev) {
  trace::ToneMapOptions how;
  how.ev = ev;
  return display(values, 1.0 / std::numbers::pi, how);
}

std::vector<Colour> surface_colours(const Values& values) {
  // The exposure at which 1 stays 1: only the display's encoding is left.
  trace::ToneMapOptions how;
  how.curve = trace::ToneMapOptions::Curve::Srgb;
  how.ev = -std::log2(1.2);
  return display(values, 1.0, how);
}

std::vector<Colour> class_colours(const Values& values) {
  std::vector<Colour> colours(values.size(), kGrey);
  if (values.components != 1) return colours;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const float v = values.numbers[i];
    if (v >= 0.0f && v < 4e9f) colours[i] = class_colour(static_cast<std::uint32_t>(v));
  }
  return colours;
}

double automatic_ev(const std::vector<std::array<float, 3>>& radiosities) {
  if (radiosities.empty()) return 0.0;
  return trace::automatic_ev(
      image_of({radiosities.front().data(), 3 * radiosities.size()}, 1.0 / std::numbers::pi));
}

}  // namespace atrium::view
