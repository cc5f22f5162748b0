#include "environment_light.h"

#include <cmath>
#include <numbers>

#include "directions.h"
#include "scene/parallel.h"

namespace atrium::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
/// Cells of the table that directions to a SkyDome are drawn from. The horizon is a row's edge.
constexpr int kDomeWidth = 256, kDomeHeight = 128;

Rgb pixel(const Image& image, int x, int y) {
  return Rgb::generate([&](int channel) { return image.at(x, y, channel); });
}

/// Bilinear between pixel centres; longitude closes, latitude ends at the poles.
Rgb image_at(const Image& image, const Vec2f& uv) {
  const float x = uv.x() * static_cast<float>(image.width) - 0.5f;
  const float y = std::clamp(uv.y() * static_cast<float>(image.height) - 0.5f, 0.0f,
                             static_cast<float>(image.height - 1));
  const auto x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(y);
  const int y1 = std::min(y0 + 1, image.height - 1);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const int left = (x0 + image.width) % image.width, right = (left + 1) % image.width;
  const Rgb top = pixel(image, left, y0) * (1.0f - fx) + pixel(image, right, y0) * fx;
  const Rgb bottom = pixel(image, left, y1) * (1.0f - fx) + pixel(image, right, y1) * fx;
  return top * (1.0f - fy) + bottom * fy;
}

/// Mean of the bilinear luminance over each pixel: (1, 6, 1) / 8 of the neighbours each way, so
/// that no direction with light has the density 0.
std::vector<double> cell_means(const Image& image) {
  const int w = image.width, h = image.height;
  std::vector<double> means(image.pixel_count());
  parallel_for(static_cast<std::size_t>(h), 16, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < w; ++x) {
        double sum = 0.0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            sum += static_cast<double>(
                       luminance(pixel(image, (x + dx + w) % w, std::clamp(y + dy, 0, h - 1)))) *
                   (dx == 0 ? 0.75 : 0.125) * (dy == 0 ? 0.75 : 0.125);
        means[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) +
              static_cast<std::size_t>(x)] = sum;
      }
    }
  });
  return means;
}

std::vector<double> cell_means(const SkyDome& dome) {
  std::vector<double> means;
  means.reserve(static_cast<std::size_t>(kDomeWidth) * kDomeHeight);
  for (int y = 0; y < kDomeHeight; ++y) {
    for (int x = 0; x < kDomeWidth; ++x) {
      double sum = 0.0;
      for (const double fy : {0.25, 0.75}) {
        for (const double fx : {0.25, 0.75}) {
          const double theta = std::numbers::pi * (y + fy) / kDomeHeight;
          const double phi = 2.0 * std::numbers::pi * ((x + fx) / kDomeWidth - 0.5);
          sum += 0.25 * dome.at({std::sin(theta) * std::sin(phi), std::cos(theta),
                                 -std::sin(theta) * std::cos(phi)});
        }
      }
      means.push_back(sum);
    }
  }
  return means;
}

Rgb mean_of(const Image& image) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double weight = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double s = std::sin(std::numbers::pi * (y + 0.5) / image.height);
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += s * static_cast<double>(image.at(x, y, c));
    weight += s * image.width;
  }
  return Rgb::generate([&](int c) { return static_cast<float>(sum[c] / weight); });
}

}  // namespace

template <int N>
EnvironmentLight<N>::EnvironmentLight(const Scene& scene, const material::SpectralBasis& basis)
    : basis_(basis) {
  if (!scene.environment) return;
  const Environment& e = *scene.environment;
  radiance_ = basis.template resolve<N>(e.radiance);
  present_ = radiance_.max() > 0.0f;
  if (!present_) return;
  to_local_ = e.to_scene.linear().cast<float>().transpose();
  image_ = std::get_if<Image>(&e.pattern);
  dome_ = std::get_if<SkyDome>(&e.pattern);
  if (image_ != nullptr) sampler_ = SkySampler(image_->width, image_->height, cell_means(*image_));
  if (dome_ != nullptr) sampler_ = SkySampler(kDomeWidth, kDomeHeight, cell_means(*dome_));
}

template <int N>
Spectrum<N> EnvironmentLight<N>::radiance(const Vec3f& w) const {
  if (image_ != nullptr)
    return radiance_ * basis_.template from_rgb<N>(image_at(*image_, latlong_uv(to_local_ * w)));
  if (dome_ != nullptr)
    return radiance_ * static_cast<float>(dome_->at((to_local_ * w).template cast<double>()));
  return radiance_;
}

template <int N>
Spectrum<N> EnvironmentLight<N>::mean() const {
  if (image_ != nullptr) return radiance_ * basis_.template from_rgb<N>(mean_of(*image_));
  if (dome_ != nullptr) return radiance_ * static_cast<float>(dome_->mean());
  return radiance_;
}

template <int N>
Vec3f EnvironmentLight<N>::sample(const Vec3f& normal, const Vec2f& u) const {
  if (!sampler_.empty()) return to_local_.transpose() * sampler_.sample(u).w;
  return normal.isZero() ? uniform_sphere(u) : Frame(normal).to_world(sample_cosine_hemisphere(u));
}

template <int N>
float EnvironmentLight<N>::pdf(const Vec3f& normal, const Vec3f& w) const {
  if (!sampler_.empty()) return sampler_.pdf(to_local_ * w);
  return normal.isZero() ? 1.0f / (4.0f * kPi) : std::max(0.0f, normal.dot(w)) / kPi;
}

template class EnvironmentLight<1>;
template class EnvironmentLight<3>;
template class EnvironmentLight<4>;
template class EnvironmentLight<8>;

}  // namespace atrium::scene
