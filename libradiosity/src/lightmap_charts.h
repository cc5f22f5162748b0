#pragma once

#include <cstdint>
#include <vector>

#include "scene/surface_field.h"

namespace atrium::radiosity {

/// Places of facets' sides in a square picture. A chart is the rectangle of a facet's grid; corners
/// of the grid lie on centres of texels, so bilinear look-ups never leave the chart, and one more
/// texel all round (kPadding) goes on with its border for viewers that round otherwise. Texels are
/// as large on all charts, but for charts of less than two. A clump has one texel.
class LightmapCharts {
 public:
  static constexpr std::uint32_t kPadding = 1;
  struct Chart {
    std::uint32_t facet = 0, side = 0;
    std::uint32_t x = 0, y = 0;           ///< of the first texel that is not padding
    std::uint32_t width = 1, height = 1;  ///< without padding
  };

  /// \param wanted  by facet * 2 + side.
  /// \throws Error  that names a size that suffices, if not even charts of two by two texels fit.
  LightmapCharts(const scene::SurfaceField& layout, const std::vector<std::uint8_t>& wanted,
                 std::uint32_t size);

  [[nodiscard]] const std::vector<Chart>& charts() const { return charts_; }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] double texel_size() const { return 1.0 / density_; }  ///< [m]
  [[nodiscard]] const Chart& chart(std::uint32_t facet, std::size_t side) const {
    return charts_[chart_of_[2 * std::size_t{facet} + side]];
  }
  /// Where a place of a facet lies, in texels from the picture's corner; centres are at halves.
  [[nodiscard]] Vec2d texel(std::uint32_t facet, std::size_t side, const Vec3f& position) const;

 private:
  void set_sizes(double density);
  [[nodiscard]] bool pack(std::uint32_t size);

  const scene::SurfaceField& layout_;
  std::uint32_t size_;
  double density_ = 0.0;  // [1/m]
  std::vector<Chart> charts_;
  std::vector<std::uint32_t> chart_of_;  // by facet * 2 + side
};

}  // namespace atrium::radiosity
