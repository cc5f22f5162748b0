#include "lightmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/parallel.h"
#include "triangulate_polygon.h"

namespace atrium::radiosity {

using scene::BakedModel;

namespace {

/// Beyond a triangle light goes on as a plane, but not below 0.
template <int N>
Spectrum<N> not_negative(Spectrum<N> v) {
  for (float& x : v.lane) x = std::max(x, 0.0f);
  return v;
}

/// Unknown texels take the mean of known neighbours, ring by ring.
template <class Texel>
void dilate(std::vector<Texel>& texels, std::uint32_t width, std::uint32_t height) {
  constexpr float kUnknown = 1e30f;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<Texel> next = texels;
    for (std::uint32_t y = 0; y < height; ++y)
      for (std::uint32_t x = 0; x < width; ++x) {
        if (texels[y * width + x].outside < kUnknown) continue;
        Rgb sum;
        int count = 0;
        std::uint8_t alpha = 0;
        for (std::uint32_t j = y - std::min(y, 1U); j <= std::min(y + 1, height - 1); ++j)
          for (std::uint32_t i = x - std::min(x, 1U); i <= std::min(x + 1, width - 1); ++i) {
            const Texel& t = texels[j * width + i];
            if (!(t.outside < kUnknown)) continue;
            sum += t.radiance;
            alpha = std::max(alpha, t.alpha);
            ++count;
          }
        if (count == 0) continue;
        next[y * width + x] = {sum * (1.0f / static_cast<float>(count)), alpha, 0.0f};
        changed = true;
      }
    texels = std::move(next);
  }
}

}  // namespace

template <int N>
Lightmap<N>::Lightmap(const scene::Scene& scene, const material::SpectralBasis& basis,
                      const scene::SurfaceField& field, const SurfaceReader<N>& surfaces,
                      const JoinedField<N>& joined, const LightmapCharts& charts)
    : scene_(scene),
      basis_(basis),
      field_(field),
      surfaces_(surfaces),
      joined_(joined),
      charts_(charts) {}

template <int N>
BakedModel::Atlas Lightmap<N>::fill(const std::vector<std::vector<std::uint32_t>>& polygons) const {
  BakedModel::Atlas atlas;
  atlas.width = atlas.height = static_cast<int>(charts_.size());
  const std::size_t count = std::size_t{charts_.size()} * charts_.size();
  atlas.radiance.resize(count);
  const bool masks = std::any_of(scene_.materials.begin(), scene_.materials.end(),
                                 [](const auto& m) { return m.alpha_cutoff > 0.0f; });
  if (masks) atlas.alpha.assign(count, 255);
  // Charts do not overlap, so they can be filled side by side.
  scene::parallel_for(charts_.charts().size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fill_chart(charts_.charts()[i], polygons[i], atlas);
  });
  return atlas;
}

template <int N>
void Lightmap<N>::fill_chart(const Chart& chart, std::span<const std::uint32_t> polygons,
                             BakedModel::Atlas& atlas) const {
  std::vector<Texel> texels(std::size_t{chart.width} * chart.height);
  if (field_.facets[chart.facet].clump != 0)
    fill_clump(chart, polygons, texels);
  else
    for (const std::uint32_t k : polygons) draw(chart, k, texels);
  dilate(texels, chart.width, chart.height);
  static constexpr std::uint32_t kPad = LightmapCharts::kPadding;
  for (std::uint32_t y = 0; y < chart.height + 2 * kPad; ++y)
    for (std::uint32_t x = 0; x < chart.width + 2 * kPad; ++x) {
      const auto inside = [](std::uint32_t i, std::uint32_t n) {
        return std::clamp(i, kPad, n + kPad - 1) - kPad;
      };
      const Texel& t = texels[inside(y, chart.height) * chart.width + inside(x, chart.width)];
      const std::size_t at = std::size_t{chart.y - kPad + y} * charts_.size() + chart.x - kPad + x;
      atlas.radiance[at] = t.radiance;
      if (!atlas.alpha.empty()) atlas.alpha[at] = t.alpha;
    }
}

/// The mean over the polygons, of about one size.
template <int N>
void Lightmap<N>::fill_clump(const Chart& chart, std::span<const std::uint32_t> polygons,
                             std::vector<Texel>& texels) const {
  Rgb sum;
  for (const std::uint32_t k : polygons)
    sum += evaluate(k, joined_.centre(k).position, joined_.at_polygon(k, 0), chart.side).radiance;
  texels[0] = {sum * (1.0f / static_cast<float>(std::max<std::size_t>(1, polygons.size()))), 255,
               0.0f};
}

template <int N>
void Lightmap<N>::draw(const Chart& chart, std::uint32_t polygon,
                       std::vector<Texel>& texels) const {
  const JoinedMesh& mesh = joined_.mesh();
  std::vector<Corner> corners;
  std::vector<Vec3f> positions;
  std::vector<BothLights<N>> light;
  const Vec2d first(chart.x, chart.y);
  for (std::uint32_t c = mesh.first_corner[polygon]; c < mesh.first_corner[polygon + 1]; ++c) {
    const Vec3f& p = mesh.position[mesh.point[c]];
    joined_.at_point(mesh.point[c], light);
    corners.push_back({charts_.texel(chart.facet, chart.side, p) - first, p, light[0]});
    positions.push_back(p);
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangulate_polygon(positions, triangles);
  for (const auto& t : triangles)
    draw_triangle(chart, polygon, {&corners[t[0]], &corners[t[1]], &corners[t[2]]}, texels);
}

/// Texels inside, and those that bilinear look-ups inside need: up to one and a half beyond.
template <int N>
void Lightmap<N>::draw_triangle(const Chart& chart, std::uint32_t polygon,
                                const std::array<const Corner*, 3>& corners,
                                std::vector<Texel>& texels) const {
  constexpr double kReach = 1.5;
  const Vec2d a = corners[0]->place;
  const Vec2d e1 = corners[1]->place - a;
  const Vec2d e2 = corners[2]->place - a;
  const double det = e1.x() * e2.y() - e1.y() * e2.x();
  if (!(std::abs(det) > 1e-12)) return;
  const auto range = [&](int axis, std::uint32_t count) {
    const auto [low, high] =
        std::minmax({a[axis], corners[1]->place[axis], corners[2]->place[axis]});
    return std::pair(
        static_cast<std::uint32_t>(std::max(0.0, std::floor(low - 0.5 - kReach))),
        static_cast<std::uint32_t>(std::clamp(std::ceil(high - 0.5 + kReach), 0.0, count - 1.0)));
  };
  const auto [x0, x1] = range(0, chart.width);
  const auto [y0, y1] = range(1, chart.height);
  // Heights over the edges: by them barycentric coordinates are distances in texels.
  const double h[3] = {std::abs(det) / (e2 - e1).norm(), std::abs(det) / e2.norm(),
                       std::abs(det) / e1.norm()};
  for (std::uint32_t y = y0; y <= y1; ++y)
    for (std::uint32_t x = x0; x <= x1; ++x) {
      const Vec2d d = Vec2d(x + 0.5, y + 0.5) - a;
      const double u = (d.x() * e2.y() - d.y() * e2.x()) / det;
      const double v = (e1.x() * d.y() - e1.y() * d.x()) / det;
      const double beyond = std::max({0.0, -(1.0 - u - v) * h[0], -u * h[1], -v * h[2]});
      Texel& texel = texels[std::size_t{y} * chart.width + x];
      if (beyond > kReach || static_cast<float>(beyond) >= texel.outside) continue;
      const std::array<double, 3> weight{1.0 - u - v, u, v};
      Vec3f position = Vec3f::Zero();
      BothLights<N> light;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto w = static_cast<float>(weight[k]);
        position += w * corners[k]->position;
        for (const std::size_t side : {0U, 1U}) accumulate(light[side], corners[k]->light[side], w);
      }
      for (SideLight<N>& s : light)
        s = {not_negative(s.direct), not_negative(s.caustic), not_negative(s.indirect),
             not_negative(s.body)};
      texel = evaluate(polygon, position, light, chart.side);
      texel.outside = static_cast<float>(beyond);
    }
}

template <int N>
auto Lightmap<N>::evaluate(std::uint32_t polygon, const Vec3f& position, const BothLights<N>& light,
                           std::size_t side) const -> Texel {
  const scene::SurfacePoint at = joined_.surface_point(polygon, position);
  const BothSurfaces<N> surface{surfaces_.side(at, true), surfaces_.side(at, false)};
  const Spectrum<N> leaving =
      reflected<N>(light, surface, joined_.body_known())[side] + surface[side].exitance;
  return {basis_.to_rgb<N>(leaving * (1.0f / std::numbers::pi_v<float>)), alpha(at), 0.0f};
}

template <int N>
std::uint8_t Lightmap<N>::alpha(const scene::SurfacePoint& at) const {
  const material::Material& m = scene_.materials[at.material.value];
  if (!(m.alpha_cutoff > 0.0f)) return 255;
  float a = m.alpha_factor;
  if (m.alpha_texture.texture.valid())
    a *=
        scene_.textures[m.alpha_texture.texture.value].channel(m.alpha_texture.transform(at.uv), 3);
  return a < m.alpha_cutoff ? 0 : 255;
}

template class Lightmap<1>;
template class Lightmap<3>;
template class Lightmap<4>;
template class Lightmap<8>;

}  // namespace atrium::radiosity
