#pragma once

#include <vector>

#include "material/frame.h"

namespace atrium::scene {

/// Place of a direction in a latitude-longitude image: u = 0.5 + atan2(x, -z) / (2 pi), v =
/// acos(y) / pi, both in [0, 1].
[[nodiscard]] Vec2f latlong_uv(const Vec3f& w);

/// Directions by a table of radiance over latitude and longitude; uniform in solid angle within a
/// cell, so that the density is that of the table exactly. A small share goes everywhere: no
/// direction has the density 0.
class SkySampler {
 public:
  SkySampler() = default;
  /// \param radiance  height x width cell means, rows from v = 0, >= 0; all 0: uniform.
  SkySampler(int width, int height, const std::vector<double>& radiance);

  struct Direction {
    Vec3f w;
    float pdf;  ///< [1/sr]
  };
  [[nodiscard]] Direction sample(const Vec2f& u) const;
  [[nodiscard]] float pdf(const Vec3f& w) const;
  [[nodiscard]] bool empty() const { return rows_.empty(); }

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> rows_;         // cumulative over rows, height + 1
  std::vector<float> columns_;      // cumulative within each row, height x (width + 1)
  std::vector<float> solid_angle_;  // of a cell, by row
  [[nodiscard]] float pdf_of_cell(int x, int y) const;
};

}  // namespace atrium::scene
