#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bidirectional.h"
#include "scene/light_sampler.h"

namespace atrium::trace {

/// A part of a pixel, whose corners are (0, 0) and (1, 1).
struct FilmRect {
  Vec2f min, max;

  [[nodiscard]] float area() const { return (max - min).prod(); }
  /// \param u  in [0, 1)^2.
  [[nodiscard]] Vec2f sample(const Vec2f& u) const { return min + u.cwiseProduct(max - min); }
  [[nodiscard]] bool contains(const Vec2f& p) const {
    return (p.array() >= min.array()).all() && (p.array() < max.array()).all();
  }
  [[nodiscard]] bool overlaps(const FilmRect& other) const {
    return (min.array() < other.max.array()).all() && (other.min.array() < max.array()).all();
  }
  void extend(const FilmRect& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
};

/// Where a picture shows lamps that are smaller than its pixels. Camera rays rarely meet them, and
/// a picture that has not met them looks finished. So light that comes straight from a surface (or
/// the sky) is looked for in these parts of pixels by rays of its own, and camera rays that happen
/// to go there do not count it.
class SmallLamps {
 public:
  /// \param surfaces  of the light sampler. Lamps on the border of the picture and pixels that
  /// lamps fill by more than a half are left to camera rays.
  SmallLamps(const scene::Scene& scene, std::span<const scene::EmissiveTriangle> surfaces,
             const Eye& eye);

  /// Parts of a pixel of the film, which do not overlap; mostly none.
  [[nodiscard]] std::span<const FilmRect> of(int x, int y) const {
    if (first_.empty()) return {};
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x);
    return std::span(parts_).subspan(first_[pixel], first_[pixel + 1] - first_[pixel]);
  }

 private:
  int width_;
  std::vector<std::uint32_t> first_;  // by pixel, and the end; empty without lamps
  std::vector<FilmRect> parts_;       // by pixel
};

[[nodiscard]] inline bool is_among(std::span<const FilmRect> parts, const Vec2f& p) {
  return std::any_of(parts.begin(), parts.end(), [&](const FilmRect& r) { return r.contains(p); });
}

}  // namespace atrium::trace
