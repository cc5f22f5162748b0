#include "sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::scene {
namespace {
constexpr float kPi = std::numbers::pi_v<float>;

// Index of the interval of a cumulative table that holds u, and the place within it.
std::pair<int, float> invert(const float* cdf, int n, float u) {
  const float* it = std::upper_bound(cdf, cdf + n + 1, u);
  const int i = std::clamp(static_cast<int>(it - cdf) - 1, 0, n - 1);
  const float width = cdf[i + 1] - cdf[i];
  return {i, width > 0.0f ? (u - cdf[i]) / width : 0.5f};
}
}  // namespace

SkySampler::SkySampler(const material::Texture& image)
    : width_(image.width), height_(image.height) {
  const auto w = static_cast<std::size_t>(width_);
  const auto h = static_cast<std::size_t>(height_);
  rows_.assign(h + 1, 0.0f);
  columns_.assign(h * (w + 1), 0.0f);
  std::vector<double> row_sum(h, 0.0);
  double total = 0.0;
  for (std::size_t y = 0; y < h; ++y) {
    const double sin_theta =
        std::sin(std::numbers::pi * (static_cast<double>(y) + 0.5) / static_cast<double>(h));
    std::vector<double> c(w + 1, 0.0);
    for (std::size_t x = 0; x < w; ++x) {
      const Vec2f uv((static_cast<float>(x) + 0.5f) / static_cast<float>(w),
                     (static_cast<float>(y) + 0.5f) / static_cast<float>(h));
      // A floor keeps every direction possible where the image is black between bright texels.
      c[x + 1] = c[x] + (static_cast<double>(luminance(image.rgb(uv))) + 1e-4) * sin_theta;
    }
    row_sum[y] = c[w];
    total += c[w];
    for (std::size_t x = 0; x <= w; ++x)
      columns_[y * (w + 1) + x] = static_cast<float>(
          c[w] > 0.0 ? c[x] / c[w] : static_cast<double>(x) / static_cast<double>(w));
  }
  double sum = 0.0;
  for (std::size_t y = 0; y < h; ++y) {
    sum += row_sum[y];
    rows_[y + 1] = static_cast<float>(sum / total);
  }
}

float SkySampler::pdf_of_row(int x, int y, float sin_theta) const {
  const float* c = &columns_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1)];
  const float p = (rows_[static_cast<std::size_t>(y) + 1] - rows_[static_cast<std::size_t>(y)]) *
                  (c[x + 1] - c[x]);
  return p * static_cast<float>(width_) * static_cast<float>(height_) /
         (2.0f * kPi * kPi * std::max(sin_theta, 1e-6f));
}

SkySampler::Direction SkySampler::sample(const Vec2f& u) const {
  const auto [y, fy] = invert(rows_.data(), height_, u.y());
  const float* c = &columns_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1)];
  const auto [x, fx] = invert(c, width_, u.x());
  const float phi = ((static_cast<float>(x) + fx) / static_cast<float>(width_) - 0.5f) * 2.0f * kPi;
  const float theta = (static_cast<float>(y) + fy) / static_cast<float>(height_) * kPi;
  const float s = std::sin(theta);
  return {Vec3f(s * std::sin(phi), std::cos(theta), -s * std::cos(phi)), pdf_of_row(x, y, s)};
}

float SkySampler::pdf(const Vec3f& w) const {
  const Vec2f uv = uv_of(w);
  const int x = std::clamp(static_cast<int>(uv.x() * static_cast<float>(width_)), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(uv.y() * static_cast<float>(height_)), 0, height_ - 1);
  const float s = std::sqrt(std::max(0.0f, 1.0f - w.y() * w.y()));
  return pdf_of_row(x, y, s);
}

Vec2f SkySampler::uv_of(const Vec3f& w) {
  return {0.5f + std::atan2(w.x(), -w.z()) / (2.0f * kPi),
          std::acos(std::clamp(w.y(), -1.0f, 1.0f)) / kPi};
}

}  // namespace atrium::scene
