#include "splat_film.h"

#include <cmath>

namespace atrium::trace {
namespace {

Rgb scaled(const std::array<double, 3>& sum, double scale) {
  return make_rgb(sum[0] * scale, sum[1] * scale, sum[2] * scale);
}

}  // namespace

SplatFilm::SplatFilm(std::size_t pixels, bool components, bool classes) : picture_(pixels) {
  if (components) terms_.resize(pixels);
  if (classes) {
    classes_.resize(pixels);
    class_luminance_.resize(pixels);
  }
}

void SplatFilm::add(std::span<const Splat> splats) {
  for (const Splat& s : splats) {
    std::size_t layer = s.layer;
    Sum* sum = nullptr;
    if (layer == kPictureLayer) {
      sum = &picture_[s.pixel][s.replicate];
    } else if (--layer; layer < kTerms) {
      sum = &terms_[s.pixel][layer];
    } else {
      layer -= kTerms;
      sum = &classes_[s.pixel][layer];
      class_luminance_[s.pixel][layer][s.replicate] += static_cast<double>(luminance(s.radiance));
    }
    for (std::size_t c = 0; c < 3; ++c)
      (*sum)[c] += static_cast<double>(s.radiance[static_cast<int>(c)]);
  }
}

void SplatFilm::count(const std::array<std::uint64_t, kReplicates>& paths) {
  for (std::size_t r = 0; r < kReplicates; ++r) paths_[r] += paths[r];
}

double SplatFilm::paths() const {
  double n = 0.0;
  for (const std::uint64_t p : paths_) n += static_cast<double>(p);
  return n;
}

Rgb SplatFilm::mean(std::size_t pixel, std::uint16_t layer) const {
  const double n = paths();
  if (!(n > 0.0)) return Rgb::zero();
  if (layer == kPictureLayer) {
    Sum all{};
    for (const Sum& r : picture_[pixel])
      for (std::size_t c = 0; c < 3; ++c) all[c] += r[c];
    return scaled(all, 1.0 / n);
  }
  const std::size_t i = layer - 1U;
  return scaled(i < kTerms ? terms_[pixel][i] : classes_[pixel][i - kTerms], 1.0 / n);
}

// Means of a and b paths differ by s^2 (1/a + 1/b); their joint mean weighs (a + b) / n.
double SplatFilm::half_factor(std::size_t half) const {
  const double a = static_cast<double>(paths_[2 * half]);
  const double b = static_cast<double>(paths_[2 * half + 1]);
  return a > 0.0 && b > 0.0 ? std::sqrt(a * b) / paths() : 0.0;
}

Rgb SplatFilm::deviation(std::size_t pixel, std::size_t half) const {
  const double factor = half_factor(half);
  if (!(factor > 0.0)) return Rgb::zero();
  const std::size_t a = 2 * half, b = a + 1;
  return scaled(picture_[pixel][a], factor / static_cast<double>(paths_[a])) -
         scaled(picture_[pixel][b], factor / static_cast<double>(paths_[b]));
}

float SplatFilm::class_deviation(std::size_t pixel, LightClass c, std::size_t half) const {
  const double factor = half_factor(half);
  if (!(factor > 0.0)) return 0.0f;
  const std::size_t a = 2 * half, b = a + 1;
  const auto& y = class_luminance_[pixel][static_cast<std::size_t>(c)];
  return static_cast<float>(
      factor * (y[a] / static_cast<double>(paths_[a]) - y[b] / static_cast<double>(paths_[b])));
}

}  // namespace atrium::trace
