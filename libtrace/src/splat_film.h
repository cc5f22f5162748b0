#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "picture_samples.h"
#include "splat.h"

namespace atrium::trace {

/// Sums of what paths from lights show, in double precision and in the order of the calls.
class SplatFilm {
 public:
  SplatFilm(std::size_t pixels, bool components, bool classes);

  void add(std::span<const Splat> splats);
  /// So many paths more, whether they showed anything or not.
  void count(const std::array<std::uint64_t, kReplicates>& paths);

  /// Radiance [pixel], of the picture or a layer, by all paths.
  [[nodiscard]] Rgb mean(std::size_t pixel, std::uint16_t layer) const;
  /// Deviation of a half, as PictureSamples::deviation; of a class its luminance.
  [[nodiscard]] Rgb deviation(std::size_t pixel, std::size_t half) const;
  [[nodiscard]] float class_deviation(std::size_t pixel, LightClass c, std::size_t half) const;

  /// As Film::archive().
  template <class Archive>
  bool archive(Archive& a) {
    const std::size_t n = picture_.size(), terms = terms_.size(), classes = classes_.size();
    a(paths_);
    a(picture_);
    a(terms_);
    a(classes_);
    a(class_luminance_);
    return picture_.size() == n && terms_.size() == terms && classes_.size() == classes &&
           class_luminance_.size() == classes;
  }

 private:
  using Sum = std::array<double, 3>;
  [[nodiscard]] double paths() const;
  [[nodiscard]] double half_factor(std::size_t half) const;

  std::array<std::uint64_t, kReplicates> paths_{};
  std::vector<std::array<Sum, kReplicates>> picture_;
  std::vector<std::array<Sum, kTerms>> terms_;           // empty without components
  std::vector<std::array<Sum, kLightClasses>> classes_;  // empty without classes
  std::vector<std::array<std::array<double, kReplicates>, kLightClasses>> class_luminance_;
};

}  // namespace atrium::trace
