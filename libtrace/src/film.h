#pragma once

#include <cstdint>
#include <vector>

#include "material/spectral_basis.h"
#include "pixel_sample.h"
#include "scene/counters.h"
#include "scene/image.h"
#include "share.h"

namespace atrium::trace {

/// Running means of all layers; every pixel belongs to one task at a time.
class Film {
 public:
  /// \param shares  keeps what share() needs.
  Film(int width, int height, bool components, bool shares);

  template <int N>
  void add(int x, int y, const PixelSample<N>& sample, const material::SpectralBasis& basis,
           scene::Counters& counters);

  /// Shares the samples of the first surfaces' body light between pixels; once, at the end.
  void share();
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
  /// Light from a surface's body by part (direct, indirect) and half of the samples (even, odd),
  /// and what it needs to be shared.
  struct Body {
    std::array<std::array<Rgb, 2>, 2> radiance;  // [part][half]
    std::array<float, 2> m2{};                   // of luminance, both halves, by part
    std::array<Rgb, 2> mean;                     // by part
    std::array<std::uint32_t, 2> count{};        // by half
    Rgb albedo;
    Vec3f position = Vec3f::Zero();
  };
  static void add_body(Body& body, const std::array<Rgb, 2>& radiance, const Rgb& albedo,
                       const Vec3f& position, std::uint32_t sample);

  void put_shared(std::size_t pixel, const std::array<Illumination, 2>& parts,
                  const std::array<float, 2>& before);

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Body> bodies_;                    // empty if nothing is shared
  std::vector<std::array<Rgb, kTerms>> terms_;  // empty without components
};

}  // namespace atrium::trace
