#include "sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "directions.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
/// Share of directions that are uniform over the sphere: next to a sun in an image, light elsewhere
/// has shares below the rounding of the table.
constexpr float kUniform = 0.02f;

// Index of the interval of a cumulative table that holds u, and the place within it.
std::pair<int, float> invert(const float* cdf, int n, float u) {
  const float* it = std::upper_bound(cdf, cdf + n + 1, u);
  int i = std::clamp(static_cast<int>(it - cdf) - 1, 0, n - 1);
  while (i > 0 && !(cdf[i + 1] > cdf[i])) --i;  // rounding may point at an empty interval
  const float width = cdf[i + 1] - cdf[i];
  return {i, width > 0.0f ? std::min((u - cdf[i]) / width, 1.0f) : 0.5f};
}

// Cumulative shares; equal ones if there is nothing.
void accumulate(const double* value, int n, float* cdf) {
  double total = 0.0;
  for (int i = 0; i < n; ++i) total += value[i];
  double sum = 0.0;
  cdf[0] = 0.0f;
  for (int i = 0; i < n; ++i) {
    sum += total > 0.0 ? value[i] / total : 1.0 / n;
    cdf[i + 1] = static_cast<float>(sum);
  }
  cdf[n] = 1.0f;
}

}  // namespace

Vec2f latlong_uv(const Vec3f& w) {
  // By atan2, which keeps its precision next to the poles.
  return {0.5f + std::atan2(w.x(), -w.z()) / static_cast<float>(2.0 * kPi),
          std::atan2(std::hypot(w.x(), w.z()), w.y()) / static_cast<float>(kPi)};
}

SkySampler::SkySampler(int width, int height, const std::vector<double>& radiance)
    : width_(width), height_(height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  rows_.resize(h + 1);
  columns_.resize(h * (w + 1));
  solid_angle_.resize(h);
  std::vector<double> row_sum(h, 0.0);
  for (std::size_t y = 0; y < h; ++y) {
    // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2)
    const double middle = kPi * (static_cast<double>(y) + 0.5) / height;
    const double angle = 2.0 * std::sin(middle) * std::sin(0.5 * kPi / height) * 2.0 * kPi / width;
    solid_angle_[y] = static_cast<float>(angle);
    const double* row = radiance.data() + y * w;
    for (std::size_t x = 0; x < w; ++x) row_sum[y] += row[x];
    row_sum[y] *= angle;
    accumulate(row, width, &columns_[y * (w + 1)]);
  }
  if (std::all_of(row_sum.begin(), row_sum.end(), [](double s) { return !(s > 0.0); }))
    std::copy(solid_angle_.begin(), solid_angle_.end(), row_sum.begin());
  accumulate(row_sum.data(), height, rows_.data());
}

float SkySampler::pdf_of_cell(int x, int y) const {
  const auto row = static_cast<std::size_t>(y);
  const float* c = &columns_[row * static_cast<std::size_t>(width_ + 1)];
  const float p = (rows_[row + 1] - rows_[row]) * (c[x + 1] - c[x]) / solid_angle_[row];
  return (1.0f - kUniform) * p + kUniform / static_cast<float>(4.0 * kPi);
}

SkySampler::Direction SkySampler::sample(const Vec2f& u) const {
  if (u.y() < kUniform) {
    const Vec3f w = uniform_sphere({u.x(), std::min(u.y() / kUniform, 0x1.fffffep-1f)});
    return {w, pdf(w)};
  }
  const float v = std::min((u.y() - kUniform) / (1.0f - kUniform), 0x1.fffffep-1f);
  const auto [y, fy] = invert(rows_.data(), height_, v);
  const float* c = &columns_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1)];
  const auto [x, fx] = invert(c, width_, u.x());
  const double phi = (static_cast<double>(fx) + x) / width_ * 2.0 * kPi - kPi;
  const double top = std::cos(kPi * y / height_), bottom = std::cos(kPi * (y + 1.0) / height_);
  const double cosine = top + static_cast<double>(fy) * (bottom - top);
  const double s = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  const Vec3d w(s * std::sin(phi), cosine, -s * std::cos(phi));
  return {w.cast<float>(), pdf_of_cell(x, y)};
}

float SkySampler::pdf(const Vec3f& w) const {
  const Vec2f uv = latlong_uv(w);
  const int x = std::clamp(static_cast<int>(uv.x() * static_cast<float>(width_)), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(uv.y() * static_cast<float>(height_)), 0, height_ - 1);
  return pdf_of_cell(x, y);
}

}  // namespace atrium::scene
