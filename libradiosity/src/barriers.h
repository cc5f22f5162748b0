#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace atrium::radiosity {

/// A segment in a triangle's plane along which another surface stands on the triangle or pierces
/// it.
struct Barrier {
  Vec3d a, b;
};

/// Finds where the surfaces of a scene that let no light pass straight meet its triangles.
class BarrierFinder {
 public:
  explicit BarrierFinder(const scene::Scene& scene);
  ~BarrierFinder();

  /// \param reach  [m]: what ends within this height above or below the triangle stands on it.
  /// Nearly parallel surfaces (within 11 degrees) are none. Segments end at the triangle's border.
  [[nodiscard]] std::vector<Barrier> on(scene::ObjectId object, std::uint32_t triangle,
                                        double reach) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::radiosity
