#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace atrium::scene {

/// The closed opaque bodies of a scene (connected, every edge shared by an even number of
/// triangles, at T-junctions part by part) and which of them a point is in. Light never gets from
/// one set of bodies into another, so this says where no light can come from. Decided by crossings
/// of rays with each body alone: neither winding nor normals matter, and bodies may overlap.
/// Thread-safe.
class ClosedBodies {
 public:
  explicit ClosedBodies(const Scene& scene);
  ~ClosedBodies();
  ClosedBodies(ClosedBodies&&) noexcept;
  ClosedBodies& operator=(ClosedBodies&&) noexcept;

  struct Body {
    ObjectId object;
    std::uint32_t triangles = 0;
    double volume = 0.0;  ///< [m^3] by winding: negative if inwards, 0 if its triangles disagree
  };
  [[nodiscard]] const std::vector<Body>& bodies() const;
  /// Bodies whose bounding boxes meet a box, ascending.
  [[nodiscard]] std::vector<std::uint32_t> near(const Eigen::AlignedBox3f& box) const;
  /// Those of `candidates` that contain a point: two of three rays have to agree.
  [[nodiscard]] std::vector<std::uint32_t> containing(
      const Vec3f& point, const std::vector<std::uint32_t>& candidates) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::scene
