#pragma once

#include <vector>

#include "material/frame.h"

namespace atrium::radiosity {

/// Keeps the part of a convex polygon where distance(vertex) >= 0 (Sutherland & Hodgman 1974).
/// \param lerp  (a, b, t): the vertex at a + t (b - a).
template <class Vertex, class Distance, class Lerp>
void clip_polygon(const std::vector<Vertex>& in, std::vector<Vertex>& out, Distance&& distance,
                  Lerp&& lerp) {
  out.clear();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vertex& a = in[i];
    const Vertex& b = in[(i + 1) % in.size()];
    const double da = distance(a);
    const double db = distance(b);
    if (da >= 0.0) out.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) out.push_back(lerp(a, b, da / (da - db)));
  }
  if (out.size() < 3) out.clear();
}

/// Sum of the corner cross products: twice the area, along the normal by winding.
template <class Points>
[[nodiscard]] Vec3d polygon_area_vector(const Points& p) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec3d a = (p[i] - p[0]).template cast<double>();
    const Vec3d b = (p[i + 1] - p[0]).template cast<double>();
    sum += a.cross(b);
  }
  return sum;
}

}  // namespace atrium::radiosity
