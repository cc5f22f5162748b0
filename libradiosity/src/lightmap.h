#pragma once

#include <span>

#include "joined_field.h"
#include "lightmap_charts.h"
#include "scene/baked_model.h"

namespace atrium::radiosity {

/// Fills the atlas of a baked model: at every texel what the surface there sends out, textures
/// included. Light is linear in the triangles of the joined polygons, as with vertex colours.
template <int N>
class Lightmap {
 public:
  Lightmap(const scene::Scene& scene, const material::SpectralBasis& basis,
           const scene::SurfaceField& field, const SurfaceReader<N>& surfaces,
           const JoinedField<N>& joined, const LightmapCharts& charts);

  /// \param polygons  of each chart, in their order.
  [[nodiscard]] scene::BakedModel::Atlas fill(
      const std::vector<std::vector<std::uint32_t>>& polygons) const;

 private:
  struct Texel {
    Rgb radiance;
    std::uint8_t alpha = 255;
    float outside = 1e30f;  ///< how far beyond its triangle [texels]; 0: inside
  };
  using Chart = LightmapCharts::Chart;
  void fill_chart(const Chart& chart, std::span<const std::uint32_t> polygons,
                  scene::BakedModel::Atlas& atlas) const;
  void fill_clump(const Chart& chart, std::span<const std::uint32_t> polygons,
                  std::vector<Texel>& texels) const;
  void draw(const Chart& chart, std::uint32_t polygon, std::vector<Texel>& texels) const;
  struct Corner {
    Vec2d place;  ///< in texels, from the chart's first
    Vec3f position;
    BothLights<N> light;
  };
  void draw_triangle(const Chart& chart, std::uint32_t polygon,
                     const std::array<const Corner*, 3>& corners, std::vector<Texel>& texels) const;
  [[nodiscard]] Texel evaluate(std::uint32_t polygon, const Vec3f& position,
                               const BothLights<N>& light, std::size_t side) const;
  [[nodiscard]] std::uint8_t alpha(const scene::SurfacePoint& at) const;

  const scene::Scene& scene_;
  const material::SpectralBasis& basis_;
  const scene::SurfaceField& field_;
  const SurfaceReader<N>& surfaces_;
  const JoinedField<N>& joined_;
  const LightmapCharts& charts_;
};

}  // namespace atrium::radiosity
