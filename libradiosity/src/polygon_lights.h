#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/shading.h"

namespace atrium::radiosity {

/// Irradiance or a part of it, by lane, in double precision.
template <int N>
using Lanes = Eigen::Array<double, N, 1>;

/// The surface lights of constant radiance as convex polygons, whose unoccluded irradiance is known
/// in closed form. Coplanar triangles of one object are joined as long as they stay convex.
template <int N>
class PolygonLights {
 public:
  struct Polygon {
    std::vector<Vec3d> corners;  ///< scene coordinates; front by winding
    Vec3d normal;                ///< unit
    bool two_sided = false;
    Lanes<N> radiance;
  };

  /// \param limit  with more polygons than this none are kept and nothing is covered.
  explicit PolygonLights(const scene::Shading<N>& shading, std::size_t limit = 256);

  [[nodiscard]] const std::vector<Polygon>& polygons() const { return polygons_; }
  /// Is emissive triangle i (LightSampler::surfaces()) part of a polygon? Textured ones are not.
  [[nodiscard]] bool covers(std::size_t i) const { return covered_[i] != 0; }
  [[nodiscard]] bool covers_all() const { return covers_all_; }

  /// Share of a small Lambertian receiver's view that the polygon fills; 0 behind its emitting
  /// side. \param p  scene coordinates. \param normal  unit. Source: docs/radiosity.md, Eq. 1.
  [[nodiscard]] static double factor(const Polygon& polygon, const Vec3d& p, const Vec3d& normal);
  /// Of all polygons, nothing in between: sum of pi L F.
  [[nodiscard]] Lanes<N> irradiance(const Vec3d& p, const Vec3d& normal) const;

 private:
  std::vector<Polygon> polygons_;
  std::vector<std::uint8_t> covered_;
  bool covers_all_ = false;
};

/// Samples the part of a polygon above a receiver's horizon: the triangles of its fan by their
/// exact factors, directions uniform in solid angle within a triangle.
class PolygonSampler {
 public:
  PolygonSampler(const std::vector<Vec3d>& corners, const Vec3d& polygon_normal, const Vec3d& p,
                 const Vec3d& normal);
  struct Sample {
    Vec3d direction;  ///< unit, towards the polygon
    double distance = 0.0;
    double weight = 0.0;  ///< cosine at the receiver over density: its mean is pi times the factor
  };
  /// nullopt: nothing of the polygon is above the horizon. \param u  in [0, 1).
  [[nodiscard]] std::optional<Sample> sample(float u_choice, const Vec2f& u) const;

 private:
  Vec3d p_, normal_, polygon_normal_;
  std::vector<Vec3d> corners_;
  std::vector<double> factor_until_;  // by fan triangle
};

}  // namespace atrium::radiosity
