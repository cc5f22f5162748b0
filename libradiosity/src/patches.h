#pragma once

#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// One side of an element (or of an emissive triangle) as planar polygons in double precision,
/// wound so that their normals point to that side.
struct Patch {
  std::vector<std::vector<Vec3d>> polygons;
  Vec3d centre = Vec3d::Zero();
  double radius = 0.0;
  double area = 0.0;
  // Where points are drawn: the element, or the triangle of an object if that is valid.
  std::uint32_t element = 0;
  scene::ObjectId object;
  std::uint32_t triangle = 0;
  bool back = false;
};

/// One polygon where the element's pieces make up a plane convex region, else all pieces.
[[nodiscard]] Patch element_patch(const Elements& elements, SideIndex side);
[[nodiscard]] Patch triangle_patch(const scene::Scene& scene, scene::ObjectId object,
                                   std::uint32_t triangle, bool back);

/// A point of a patch, uniform by area.
[[nodiscard]] scene::SurfacePoint sample_patch(const scene::Scene& scene,
                                               const ElementPoints& points, const Patch& patch,
                                               const Vec2f& u);

/// A F [m^2] without occlusion: exact by contours for close pairs, else a degree-5 rule on one
/// patch of the exact point-to-polygon factor.
[[nodiscard]] double unoccluded_exchange_area(const Patch& a, const Patch& b, bool always_contours);

}  // namespace atrium::radiosity
