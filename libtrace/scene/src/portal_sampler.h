#pragma once

#include <optional>
#include <vector>

#include "scene/portal.h"

namespace atrium::scene {

/// Directions from a point through the openings around it, uniform over the solid angles of their
/// triangles.
class PortalSampler {
 public:
  PortalSampler() = default;
  explicit PortalSampler(std::vector<Portal> portals) : portals_(std::move(portals)) {}

  [[nodiscard]] bool empty() const { return portals_.empty(); }
  /// Solid angle of the openings that a point sees, overlaps counted twice [sr]; 0 where none is.
  /// \param normal  of the receiver: openings behind it do not count. Zero: all do.
  [[nodiscard]] double solid_angle(const Vec3f& p, const Vec3f& normal) const;
  /// A direction through one of them. \param total  solid_angle(p, normal), > 0.
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& p, const Vec3f& normal, double total,
                                            const Vec2f& u) const;
  /// Density of sample() [1/sr].
  [[nodiscard]] float pdf(const Vec3f& p, const Vec3f& normal, double total, const Vec3f& w) const;
  /// Does the point lie in a room with openings, and the ray miss all of them?
  [[nodiscard]] bool shut(const Vec3f& p, const Vec3f& w) const;

 private:
  std::vector<Portal> portals_;
};

}  // namespace atrium::scene
