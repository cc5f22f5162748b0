#pragma once

#include <span>

#include "material/frame.h"

namespace atrium::radiosity {

/// Share of the flux leaving a small Lambertian surface at p that arrives at a planar convex
/// polygon if nothing is in between. Exact; both faces of the polygon count alike. The part of the
/// polygon below the receiver's horizon is cut off. 0 for fewer than 3 corners or p in the
/// polygon's plane. \param normal  unit. Source: Lambert 1760; docs/radiosity.md, Eq. 1.
[[nodiscard]] double point_to_polygon(const Vec3d& p, const Vec3d& normal,
                                      std::span<const Vec3d> polygon);

/// A_a F(a, b) [m^2] of two planar convex polygons without occlusion; symmetric in a and b. Their
/// normals follow from the winding and only what lies in front of both planes exchanges light.
/// Relative error below 1e-6 also for polygons with a common edge.
/// Source: contour form of Stokes' theorem (Sparrow 1963); docs/radiosity.md, Eq. 2.
[[nodiscard]] double polygon_exchange_area(std::span<const Vec3d> a, std::span<const Vec3d> b);

/// F between two equal parallel rectangles a x b that face each other at distance c; all > 0.
/// Source: docs/radiosity.md, Eq. 3.
[[nodiscard]] double parallel_rectangles(double a, double b, double c);

/// F from rectangle w x l to rectangle h x l, at a right angle with the common edge l; all > 0.
/// Source: docs/radiosity.md, Eq. 4.
[[nodiscard]] double perpendicular_rectangles(double w, double h, double l);

}  // namespace atrium::radiosity
