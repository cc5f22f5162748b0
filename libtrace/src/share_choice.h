#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "share.h"

namespace atrium::trace {

/// How much of each pixel's surroundings is the same surface: 0 nearly all, 1 about half, 2 little.
[[nodiscard]] std::vector<std::uint8_t> surface_kinds(const ShareGuides& guides);

/// The light as sampled, or one of several averages of it: by pixel the one whose squared error,
/// noise and bias of averaging as replicates show them, is least in the pixel's surroundings.
/// Where light has edges finer than its noise, that is its own samples.
///
/// Each half of the replicates is taken from what the other half finds best. What a half itself
/// finds best is so by luck, too, and its own errors would be too small a measure of what was
/// chosen. What is best for an edge is not for the wall beside it, so pixels of the same kind
/// decide together.
class ShareChoice {
 public:
  /// \param kinds  surface_kinds(). \param weight  by pixel: what a difference of illumination is
  /// multiplied by to be an error. All but the guides must outlive this.
  ShareChoice(const ShareGuides& guides, const std::vector<std::uint8_t>& kinds,
              const std::vector<Rgb>& weight, const Illumination& own);

  /// Another average of the same samples.
  void offer(const Illumination& candidate);

  /// The best so far; `variance` is that of the light as sampled.
  [[nodiscard]] const Illumination& best() const { return best_; }
  /// Is it something else than the light as sampled?
  [[nodiscard]] bool taken(std::size_t half, std::size_t pixel) const {
    return taken_[half][pixel] != 0;
  }

 private:
  [[nodiscard]] std::vector<double> error_around(std::size_t half,
                                                 const Illumination& candidate) const;

  int width_, height_;
  const std::vector<std::uint8_t>& kinds_;
  const std::vector<Rgb>& weight_;
  const Illumination& own_;
  Illumination best_;
  std::array<std::vector<double>, 2> least_;  // by the half that is taken
  std::array<std::vector<std::uint8_t>, 2> taken_;
};

}  // namespace atrium::trace
