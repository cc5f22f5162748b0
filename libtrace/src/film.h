#pragma once

#include <cstdint>
#include <vector>

#include "material/spectral_basis.h"
#include "pixel_sample.h"
#include "scene/counters.h"
#include "scene/image.h"

namespace atrium::trace {

/// Running means of all layers; every pixel belongs to one task at a time.
class Film {
 public:
  Film(int width, int height, bool components);

  template <int N>
  void add(int x, int y, const PixelSample<N>& sample, const material::SpectralBasis& basis,
           scene::Counters& counters);

  [[nodiscard]] scene::Image image() const;
  /// RMS of the standard error of Y over the RMS-free mean of Y.
  [[nodiscard]] double error_estimate() const;

 private:
  struct Pixel {
    std::array<double, 3> mean{};
    std::array<double, 3> m2{};  // sum of squared deviations (Welford)
    Rgb albedo, irradiance;
    Vec3f normal = Vec3f::Zero();
    float depth = 0.0f;
    std::uint32_t count = 0;
    std::uint32_t hits = 0;
  };
  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<std::array<Rgb, kTerms>> terms_;  // empty without components
};

}  // namespace atrium::trace
