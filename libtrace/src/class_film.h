#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "picture_samples.h"
#include "pixel_sample.h"

namespace atrium::trace {

/// Running means of camera samples by class of light paths, with their replicates' luminance.
class ClassFilm {
 public:
  explicit ClassFilm(std::size_t pixels) : pixels_(pixels) {}

  /// \param count, replicate_count  samples of the pixel and of the replicate, with this one.
  void add(std::size_t pixel, std::size_t replicate, const std::array<Rgb, kLightClasses>& radiance,
           float count, float replicate_count) {
    Pixel& p = pixels_[pixel];
    for (std::size_t c = 0; c < kLightClasses; ++c) {
      p.mean[c] += (radiance[c] - p.mean[c]) / count;
      float& y = p.luminance[c][replicate];
      y += (luminance(radiance[c]) - y) / replicate_count;
    }
  }
  [[nodiscard]] const Rgb& mean(std::size_t pixel, LightClass c) const {
    return pixels_[pixel].mean[static_cast<std::size_t>(c)];
  }
  /// Of the two replicates of a half.
  [[nodiscard]] float difference(std::size_t pixel, LightClass c, std::size_t half) const {
    const auto& y = pixels_[pixel].luminance[static_cast<std::size_t>(c)];
    return y[2 * half] - y[2 * half + 1];
  }
  /// As Film::archive().
  template <class Archive>
  bool archive(Archive& a) {
    const std::size_t n = pixels_.size();
    a(pixels_);
    return pixels_.size() == n;
  }

 private:
  struct Pixel {
    std::array<Rgb, kLightClasses> mean;
    std::array<std::array<float, kReplicates>, kLightClasses> luminance{};
  };
  std::vector<Pixel> pixels_;
};

}  // namespace atrium::trace
