#pragma once

#include <vector>

#include "material/frame.h"

/// Closed forms that share no code with the library.
namespace atrium::validation::reference {

using Polygon = std::vector<Vec3d>;

/// The part of a convex polygon where offset + normal . x >= 0.
[[nodiscard]] Polygon clip(const Polygon& polygon, const Vec3d& normal, double offset);

/// Share of the flux of a small Lambertian surface at p that arrives at a convex polygon; what is
/// below the surface's horizon is cut off. Source: Lambert 1760.
[[nodiscard]] double point_factor(const Vec3d& p, const Vec3d& normal, const Polygon& polygon);

/// A surface element above the corner of a rectangle a x b at distance 1, parallel to it, or
/// upright and facing along a. Source: Siegel & Howell, configurations B-3 and B-4.
[[nodiscard]] double corner_parallel(double a, double b);
[[nodiscard]] double corner_upright(double a, double b);

/// Transmittance of a clear pane of index n: Fresnel by polarisation, reflections between the faces
/// added up without interference, T = (1 - R) / (1 + R). \param cosine  of incidence, in [0, 1].
[[nodiscard]] double pane_transmittance(double n, double cosine);

}  // namespace atrium::validation::reference
