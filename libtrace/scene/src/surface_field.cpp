#include "scene/surface_field.h"

#include <algorithm>
#include <cmath>

namespace atrium::scene {
namespace {

struct GridPlace {
  const SurfaceField::Facet* facet = nullptr;
  float x = 0.0f, y = 0.0f;  // in cells
};

GridPlace place(const SurfaceField& field, const Scene& scene, ObjectId object,
                std::uint32_t triangle, const Vec3f& position) {
  const std::uint32_t f = field.facet_at(scene, object, triangle, position);
  if (f == SurfaceField::kNone) return {};
  const SurfaceField::Facet& facet = field.facets[f];
  const Vec3f d = position - facet.origin;
  return {&facet, d.dot(facet.axis_u), d.dot(facet.axis_v)};
}

int cell_coordinate(float x, std::uint32_t n) {
  return static_cast<int>(std::clamp(std::floor(x), 0.0f, static_cast<float>(n) - 1.0f));
}

std::uint32_t cell(const SurfaceField& field, const SurfaceField::Facet& facet, int ix, int iy) {
  if (ix < 0 || iy < 0 || ix >= static_cast<int>(facet.nx) || iy >= static_cast<int>(facet.ny))
    return SurfaceField::kNone;
  return field.cell_element[facet.first_cell + static_cast<std::uint32_t>(iy) * facet.nx +
                            static_cast<std::uint32_t>(ix)];
}

// The occupied cell nearest to a place: rounding can put a point into an empty neighbour.
std::uint32_t nearest_element(const SurfaceField& field, const GridPlace& p) {
  const int cx = cell_coordinate(p.x, p.facet->nx);
  const int cy = cell_coordinate(p.y, p.facet->ny);
  const std::uint32_t here = cell(field, *p.facet, cx, cy);
  if (here != SurfaceField::kNone) return here;
  std::uint32_t best = SurfaceField::kNone;
  float best_distance = 1e30f;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint32_t e = cell(field, *p.facet, cx + dx, cy + dy);
      if (e == SurfaceField::kNone) continue;
      const float ex = static_cast<float>(cx + dx) + 0.5f - p.x;
      const float ey = static_cast<float>(cy + dy) + 0.5f - p.y;
      const float d = ex * ex + ey * ey;
      if (d < best_distance) {
        best_distance = d;
        best = e;
      }
    }
  return best;
}

}  // namespace

std::uint32_t SurfaceField::facet_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                     const Vec3f& position) const {
  const std::uint64_t index = scene.objects[object.value].first_triangle + triangle;
  if (index >= triangle_facet.size()) return kNone;
  std::uint32_t at = triangle_facet[index];
  while (is_cut(at)) {
    const Cut& cut = cuts[at & ~kCut];
    at = cut.child[(position - cut.point).dot(cut.normal) >= 0.0f ? 0 : 1];
  }
  return at;
}

std::uint32_t SurfaceField::element_at(const Scene& scene, ObjectId object, std::uint32_t triangle,
                                       const Vec3f& position) const {
  const GridPlace p = place(*this, scene, object, triangle, position);
  return p.facet != nullptr ? nearest_element(*this, p) : kNone;
}

float SurfaceField::cell_size(const Scene& scene, ObjectId object, std::uint32_t triangle) const {
  const std::uint64_t index = scene.objects[object.value].first_triangle + triangle;
  if (index >= triangle_facet.size()) return 0.0f;
  std::uint32_t at = triangle_facet[index];
  while (is_cut(at)) at = cuts[at & ~kCut].child[0];
  return at != kNone ? 1.0f / facets[at].axis_u.norm() : 0.0f;
}

SurfaceField::Stencil SurfaceField::stencil(const Scene& scene, ObjectId object,
                                            std::uint32_t triangle, const Vec3f& position,
                                            Side side) const {
  Stencil s;
  const GridPlace p = place(*this, scene, object, triangle, position);
  if (p.facet == nullptr) return s;
  const auto usable = [&](std::uint32_t e) {
    return e != kNone &&
           valid[static_cast<std::size_t>(e) * 2 + static_cast<std::size_t>(side)] != 0;
  };
  const float x = p.x - 0.5f;
  const float y = p.y - 0.5f;
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const float wx = x - fx;
  const float wy = y - fy;
  float sum = 0.0f;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const std::uint32_t e =
          cell(*this, *p.facet, static_cast<int>(fx) + i, static_cast<int>(fy) + j);
      if (!usable(e)) continue;
      const float w = (i != 0 ? wx : 1.0f - wx) * (j != 0 ? wy : 1.0f - wy);
      if (!(w > 0.0f)) continue;
      s.element[s.count] = e;
      s.weight[s.count++] = w;
      sum += w;
    }
  if (sum > 0.0f) {
    for (int i = 0; i < s.count; ++i) s.weight[i] /= sum;
    return s;
  }
  s.count = 0;
  if (const std::uint32_t e = nearest_element(*this, p); usable(e)) {
    s.element[0] = e;
    s.weight[0] = 1.0f;
    s.count = 1;
  }
  return s;
}

}  // namespace atrium::scene
