#pragma once

#include <span>

#include <embree3/rtcore.h>

#include "scene/ray_query.h"

namespace atrium::bench {

/// Embree without anything of ours: the geometries, instances and masks that scene::RayQuery has.
/// Rays are not checked. All return the number of hits.
class BareEmbree {
 public:
  explicit BareEmbree(const scene::Scene& scene);
  ~BareEmbree();
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  [[nodiscard]] std::size_t single(std::span<const scene::Ray> rays) const;
  /// Eight at a time, within groups of `group` rays sorted by octant of the direction.
  [[nodiscard]] std::size_t packets(std::span<const scene::Ray> rays, std::size_t group) const;
  /// rtcIntersect1M, `group` rays at a time.
  [[nodiscard]] std::size_t stream(std::span<const scene::Ray> rays, std::size_t group) const;
  /// rtcOccluded1.
  [[nodiscard]] std::size_t occluded(std::span<const scene::Ray> rays,
                                     std::uint32_t mask = scene::kEverything) const;

 private:
  RTCGeometry geometry(const scene::Mesh& mesh) const;

  RTCDevice device_;
  RTCScene top_;
  std::vector<RTCScene> shared_;  ///< by mesh, null unless instanced
};

}  // namespace atrium::bench
