#include "triangulate_polygon.h"

#include <algorithm>
#include <numeric>

#include "polygon.h"

namespace atrium::radiosity {
namespace {

float twice_area(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return (b - a).cross(c - a).norm();
}

/// Twice the area over the square of the longest edge: 0.87 for equal sides, 0 without area.
float quality(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const float longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0.0f ? twice_area(a, b, c) / longest : 0.0f;
}

}  // namespace

void triangulate_polygon(std::span<const Vec3f> corners,
                         std::vector<std::array<std::uint32_t, 3>>& triangles) {
  constexpr float kFlat = 1e-5f;
  std::vector<std::uint32_t> left(corners.size());
  std::iota(left.begin(), left.end(), 0U);
  auto area = static_cast<float>(polygon_area_vector(corners).norm());  // of what is left, twice
  const float least = kFlat * area;
  const auto corner = [&](std::size_t i) -> const Vec3f& { return corners[left[i % left.size()]]; };
  while (left.size() >= 3) {
    std::size_t best = 0;
    float best_quality = left.size() == 3 ? 0.0f : kFlat;
    for (std::size_t i = 0; i < left.size(); ++i) {  // the ear at corner i + 1
      const float q = quality(corner(i), corner(i + 1), corner(i + 2));
      // What stays must have area, or a corner in the middle of an edge would be passed over.
      if (q > best_quality &&
          (left.size() == 3 ||
           area - twice_area(corner(i), corner(i + 1), corner(i + 2)) > least)) {
        best = i + 1;
        best_quality = q;
      }
    }
    if (best == 0) return;
    const std::size_t n = left.size();
    triangles.push_back({left[best - 1], left[best % n], left[(best + 1) % n]});
    area -= twice_area(corner(best - 1), corner(best), corner(best + 1));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best % n));
  }
}

}  // namespace atrium::radiosity
