#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "class_film.h"
#include "material/spectral_basis.h"
#include "picture_samples.h"
#include "pixel_sample.h"
#include "scene/counters.h"
#include "scene/image.h"
#include "share.h"
#include "splat_film.h"

namespace atrium::trace {

class ShareChoice;

/// Running means of all layers; every pixel belongs to one task at a time.
class Film {
 public:
  /// What there is to keep.
  struct Contents {
    bool components = false;
    bool classes = false;
    bool shares = false;  ///< what sharing between pixels needs
    bool splats = false;  ///< of paths from lights
    bool checks = false;  ///< what samples say that check the field
  };
  Film(int width, int height, const Contents& contents);

  /// \param replicate  below kReplicates: which of the independent sets the sample is of.
  template <int N>
  void add(int x, int y, std::size_t replicate, const PixelSample<N>& sample,
           const material::SpectralBasis& basis, scene::Counters& counters);

  /// What paths from lights show, in the order of the calls. \param paths  that were traced, by
  /// replicate.
  void add_splats(const std::vector<Splat>& splats,
                  const std::array<std::uint64_t, kReplicates>& paths);

  /// Shares the samples of the first surfaces' body light between pixels, anew from all samples
  /// there are, and says what picture that is.
  PictureSamples develop();
  /// All layers, as last developed. \param error  for stderr.*.
  [[nodiscard]] scene::Image image(const std::vector<Rgb>& error) const;
  /// All state of a film that shares nothing, for scene::ArchiveWriter and ArchiveReader.
  /// \return does it fit this film?
  template <class Archive>
  bool archive(Archive& a) {
    static_assert(sizeof(Pixel) == 136, "archived as it is: no padding");
    const std::size_t n = pixels_.size(), with_terms = terms_.size();
    a(pixels_);
    a(terms_);
    bool fits = pixels_.size() == n && terms_.size() == with_terms;
    if (classes_) fits &= classes_->archive(a);
    if (splats_) fits &= splats_->archive(a);
    return fits;
  }

  /// Smallest and mean number of samples of a pixel, of those that count.
  void count_samples(int& least, double& mean) const;

 private:
  struct Pixel {
    std::array<double, 3> mean{};
    std::array<Rgb, kReplicates> replicate;
    std::array<std::uint32_t, kReplicates> replicate_count{};
    Rgb albedo, irradiance;
    std::array<float, 3> normal{};
    float depth = 0.0f;
    std::uint32_t count = 0;
    std::uint32_t hits = 0;
  };
  static constexpr std::size_t kParts = 2, kIndirect = 1;  // the other is direct
  /// Light from a surface's body by part and replicate, and what it needs to be shared.
  struct Body {
    std::array<std::array<Rgb, kReplicates>, kParts> radiance;
    std::array<double, kParts> m2{};  // of luminance
    std::array<Rgb, kParts> mean;
    Rgb albedo;
    Rgb field;  // what the field says of the indirect part
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
  [[nodiscard]] Illumination illumination(const ShareGuides& where, std::size_t part,
                                          float unit) const;
  [[nodiscard]] std::vector<Rgb> share_weights(float unit) const;
  [[nodiscard]] std::vector<Rgb> field_illumination(const ShareGuides& where, float unit) const;
  void offer_by_field(const ShareGuides& where, const std::vector<Rgb>& field,
                      const Illumination& own, ShareChoice& choice) const;
  void share();
  void take_shared(std::size_t pixel, std::size_t part, std::size_t half, const Illumination& light,
                   float unit);
  [[nodiscard]] Rgb mean(std::size_t pixel) const;
  [[nodiscard]] Rgb term(std::size_t pixel, std::size_t term) const;
  [[nodiscard]] float replicate_factor(std::size_t pixel, std::size_t half) const;
  [[nodiscard]] Rgb class_mean(std::size_t pixel, LightClass c) const;
  [[nodiscard]] float class_error(std::size_t pixel, LightClass c) const;
  [[nodiscard]] std::vector<std::string> layer_names() const;
  void put_samples(std::size_t pixel, PictureSamples& samples) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Body> bodies_;                          // empty if nothing is shared
  std::vector<Change> changes_;                       // as last developed; empty as bodies_
  std::vector<std::array<Rgb, kTerms>> terms_;        // empty without components
  std::vector<std::array<Rgb, kReplicates>> missed_;  // by the field; empty without checks
  std::optional<ClassFilm> classes_;
  std::optional<SplatFilm> splats_;
};

}  // namespace atrium::trace
