#pragma once

#include <optional>
#include <vector>

#include "material/frame.h"
#include "scene/scene.h"

namespace atrium::scene {

/// Directions towards a latitude-longitude image, by luminance times solid angle.
/// Image direction: u = 0.5 + atan2(x, -z) / (2 pi), v = acos(y) / pi in the environment's frame.
class SkySampler {
 public:
  SkySampler() = default;
  explicit SkySampler(const material::Texture& image);

  struct Direction {
    Vec3f w;
    float pdf;  // [1/sr]
  };
  [[nodiscard]] Direction sample(const Vec2f& u) const;
  [[nodiscard]] float pdf(const Vec3f& w) const;
  [[nodiscard]] static Vec2f uv_of(const Vec3f& w);
  [[nodiscard]] bool empty() const { return rows_.empty(); }

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> rows_;     // cumulative over rows, height + 1
  std::vector<float> columns_;  // cumulative within each row, height x (width + 1)
  // Density [1/sr] within a texel where the sine of the polar angle is sin_theta.
  [[nodiscard]] float pdf_of_row(int x, int y, float sin_theta) const;
};

}  // namespace atrium::scene
