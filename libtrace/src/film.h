#pragma once

#include <cstdint>
#include <vector>

#include "material/spectral_basis.h"
#include "picture_samples.h"
#include "pixel_sample.h"
#include "scene/counters.h"
#include "scene/image.h"
#include "share.h"

namespace atrium::trace {

/// Running means of all layers; every pixel belongs to one task at a time.
class Film {
 public:
  /// \param shares  keeps what sharing between pixels needs.
  Film(int width, int height, bool components, bool shares);

  /// \param replicate  below kReplicates: which of the independent sets the sample is of.
  template <int N>
  void add(int x, int y, std::size_t replicate, const PixelSample<N>& sample,
           const material::SpectralBasis& basis, scene::Counters& counters);

  /// Shares the samples of the first surfaces' body light between pixels, anew from all samples
  /// there are, and says what picture that is.
  PictureSamples develop();
  /// All layers, as last developed. \param error  for stderr.*.
  [[nodiscard]] scene::Image image(const std::vector<Rgb>& error) const;
  /// Smallest and mean number of samples of a pixel, of those that count.
  void count_samples(int& least, double& mean) const;

 private:
  struct Pixel {
    std::array<double, 3> mean{};
    std::array<Rgb, kReplicates> replicate;
    std::array<std::uint32_t, kReplicates> replicate_count{};
    Rgb albedo, irradiance;
    Vec3f normal = Vec3f::Zero();
    float depth = 0.0f;
    std::uint32_t count = 0;
    std::uint32_t hits = 0;
  };
  static constexpr std::size_t kParts = 2;  // direct, indirect
  /// Light from a surface's body by part and replicate, and what it needs to be shared.
  struct Body {
    std::array<std::array<Rgb, kReplicates>, kParts> radiance;
    std::array<double, kParts> m2{};  // of luminance
    std::array<Rgb, kParts> mean;
    Rgb albedo;
    Vec3f position = Vec3f::Zero();
  };
  /// What sharing changed, by pixel.
  struct Change {
    std::array<Rgb, kReplicates> replicate;
    std::array<Rgb, kParts> part;  // in the mean
  };

  template <int N>
  static void add_body(Body& body, const Pixel& pixel, std::size_t replicate,
                       const PixelSample<N>& sample, const material::SpectralBasis& basis);
  [[nodiscard]] bool usable(std::size_t pixel) const;
  [[nodiscard]] ShareGuides guides() const;
  [[nodiscard]] float light_unit() const;
  [[nodiscard]] Illumination illumination(std::size_t part, float unit) const;
  [[nodiscard]] std::vector<Rgb> share_weights(float unit) const;
  void share();
  void take_shared(std::size_t pixel, std::size_t part, const Illumination& light, float unit);
  [[nodiscard]] Rgb term(std::size_t pixel, std::size_t term) const;
  void put_samples(std::size_t pixel, PictureSamples& samples) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Body> bodies_;                    // empty if nothing is shared
  std::vector<Change> changes_;                 // as last developed; empty as bodies_
  std::vector<std::array<Rgb, kTerms>> terms_;  // empty without components
};

}  // namespace atrium::trace
