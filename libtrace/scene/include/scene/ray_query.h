#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "scene/counters.h"
#include "scene/ray_timing.h"
#include "scene/scene.h"

namespace atrium::scene {

/// A ray in scene coordinates; direction unit. Finite and within +-1e18, tmin >= 0, else the ray is
/// refused: answered as a miss (unoccluded) and counted as RaysRefused.
struct Ray {
  Vec3f origin;
  Vec3f direction;
  float tmin = 0.0f;
  float tmax = std::numeric_limits<float>::infinity();
};

struct Hit {
  float t = 0.0f;
  float u = 0.0f, v = 0.0f;  ///< barycentric of corners 1 and 2
  ObjectId object;
  std::uint32_t triangle = 0;  ///< within the object's mesh
  Vec3f ng = Vec3f::Zero();    ///< geometric normal by the winding, scene coordinates, any length

  [[nodiscard]] bool found() const { return t < std::numeric_limits<float>::infinity(); }
  [[nodiscard]] static Hit none() {
    return {std::numeric_limits<float>::infinity(), 0, 0, {}, 0, Vec3f::Zero()};
  }
};

/// Classes of geometry that a ray may be told to ignore.
enum RayMask : std::uint32_t {
  kOpaque = 1,  ///< stops every ray (smooth and rough solids included)
  kPane = 2,    ///< thin panes: passed straight with their transmittance
  kAlpha = 4,   ///< may be cut out by a texture
  kEverything = 7
};

struct RayQueryOptions {
  /// Embree device configuration; tests that compare stored numbers pin "isa=avx2".
  std::string device_config;
};

/// Ray queries against a frozen scene (Embree, robust mode). Thread-safe.
class RayQuery {
 public:
  explicit RayQuery(const Scene& scene, const RayQueryOptions& options = {});
  ~RayQuery();
  RayQuery(RayQuery&&) noexcept;
  RayQuery& operator=(RayQuery&&) noexcept;

  /// Closest hit within [tmin, tmax]. `kind` says which counter the ray belongs to.
  [[nodiscard]] std::optional<Hit> closest(const Ray& ray, Counters& counters, Counter kind,
                                           std::uint32_t mask = kEverything) const;
  /// The same for many rays at once; Hit::none() where there is none.
  void closest(std::span<const Ray> rays, std::span<Hit> hits, Counters& counters, Counter kind,
               std::uint32_t mask = kEverything) const;
  /// Is anything of `mask` within [tmin, tmax]?
  [[nodiscard]] bool occluded(const Ray& ray, Counters& counters, Counter kind,
                              std::uint32_t mask = kOpaque) const;

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] bool has(std::uint32_t mask) const;  ///< is there geometry of one of these classes?
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Of all rays so far.
  [[nodiscard]] RayTiming timing() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A point on a surface with what shading needs.
struct SurfacePoint {
  Vec3f position;              ///< on the triangle, recomputed from barycentrics
  float error = 0.0f;          ///< bound on the rounding of position [m]
  Vec3f ng;                    ///< geometric normal by winding
  Vec3f ns;                    ///< shading normal, same side as ng (interpolated; no normal map)
  Vec3f dpdu = Vec3f::Zero();  ///< tangent of the uv map, zero without one
  Vec2f uv = Vec2f::Zero();
  Vec3f color = Vec3f::Ones();
  ObjectId object;
  MaterialId material;
  std::uint32_t triangle = 0;
  float u = 0.0f, v = 0.0f;
};
[[nodiscard]] SurfacePoint surface_point(const Scene& scene, ObjectId object,
                                         std::uint32_t triangle, float u, float v);
[[nodiscard]] inline SurfacePoint surface_point(const Scene& scene, const Hit& hit) {
  return surface_point(scene, hit.object, hit.triangle, hit.u, hit.v);
}

/// Origin of a ray that leaves the point towards `direction`, moved off the surface along ng by
/// more than the rounding error, to the side the direction points to.
[[nodiscard]] Vec3f offset_origin(const SurfacePoint& point, const Vec3f& direction);
/// The same for a ray on the side of the unit normal ng.
[[nodiscard]] inline Vec3f offset_origin(const Vec3f& position, float error, const Vec3f& ng) {
  return position + (error + 1e-30f) * ng;
}

}  // namespace atrium::scene
