#include "lightmap_charts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "material/error.h"

namespace atrium::radiosity {

using scene::SurfaceField;

namespace {

constexpr std::uint32_t kLeast = 2;        // texels along a chart
constexpr std::uint32_t kLargest = 16384;  // that viewers load

/// Edges of a facet's rectangle [m].
Vec2d extent(const SurfaceField::Facet& f) {
  return {f.nx / static_cast<double>(f.axis_u.norm()), f.ny / static_cast<double>(f.axis_v.norm())};
}

}  // namespace

LightmapCharts::LightmapCharts(const SurfaceField& layout, const std::vector<std::uint8_t>& wanted,
                               std::uint32_t size)
    : layout_(layout), size_(size), chart_of_(2 * layout.facets.size(), SurfaceField::kNone) {
  double area = 0.0;
  for (std::uint32_t i = 0; i < chart_of_.size(); ++i) {
    if (wanted[i] == 0) continue;
    chart_of_[i] = static_cast<std::uint32_t>(charts_.size());
    charts_.push_back({i / 2, i % 2});
    if (layout.facets[i / 2].clump == 0) area += extent(layout.facets[i / 2]).prod();
  }
  if (charts_.empty()) return;
  constexpr double kStep = 0.97;
  const double texels = static_cast<double>(size_) * size_;
  // Where every chart has its least size nothing gets smaller any more.
  const double coarsest = 1e-3 / std::sqrt(area + 1e-30);
  for (density_ = std::sqrt(texels / (area + 1e-30)); density_ > coarsest; density_ *= kStep) {
    set_sizes(density_);
    if (pack(size_)) return;
  }
  std::uint32_t enough = size_;
  while (enough < kLargest && !pack(enough)) enough *= 2;
  throw Error("--lightmap " + std::to_string(size_) + ": has no room for " +
              std::to_string(charts_.size()) + " charts" +
              (pack(enough) ? ", " + std::to_string(enough) + " has" : std::string()));
}

void LightmapCharts::set_sizes(double density) {
  for (Chart& c : charts_) {
    const SurfaceField::Facet& f = layout_.facets[c.facet];
    if (f.clump != 0) continue;
    const Vec2d e = extent(f) * density;
    const auto texels = [](double length) {
      // Between the centres of the first and the last one.
      return std::max(kLeast, static_cast<std::uint32_t>(std::min(std::ceil(length) + 1.0, 1e6)));
    };
    c.width = texels(e.x());
    c.height = texels(e.y());
  }
}

/// Shelves: charts by falling height, from left to right, one shelf under the other.
bool LightmapCharts::pack(std::uint32_t size) {
  std::vector<std::uint32_t> order(charts_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return charts_[a].height > charts_[b].height;
  });
  std::uint32_t x = 0, y = 0, shelf = 0;
  for (const std::uint32_t i : order) {
    Chart& c = charts_[i];
    const std::uint32_t width = c.width + 2 * kPadding;
    const std::uint32_t height = c.height + 2 * kPadding;
    if (width > size) return false;
    if (x + width > size) {
      y += shelf;
      x = shelf = 0;
    }
    if (y + height > size) return false;
    c.x = x + kPadding;
    c.y = y + kPadding;
    x += width;
    shelf = std::max(shelf, height);
  }
  return true;
}

Vec2d LightmapCharts::texel(std::uint32_t facet, std::size_t side, const Vec3f& position) const {
  const Chart& c = chart(facet, side);
  const SurfaceField::Facet& f = layout_.facets[facet];
  const Vec3d d = position.cast<double>() - f.origin.cast<double>();
  const auto along = [&](const Vec3f& axis, std::uint32_t cells, std::uint32_t first,
                         std::uint32_t texels) {
    const double share = std::clamp(d.dot(axis.cast<double>()) / cells, 0.0, 1.0);
    return first + 0.5 + share * (texels - 1);
  };
  return {along(f.axis_u, f.nx, c.x, c.width), along(f.axis_v, f.ny, c.y, c.height)};
}

}  // namespace atrium::radiosity
