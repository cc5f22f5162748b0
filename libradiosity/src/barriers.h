#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace atrium::radiosity {

/// A segment in a triangle's plane along which another surface stands on the triangle or pierces
/// it.
struct Barrier {
  Vec3d a, b;
  bool wall = true;        ///< false: nothing stands there, but elements end
  scene::ObjectId object;  ///< that ends here; not valid: none
};

/// The part of a barrier within a triangle in whose plane it lies, if it is more than a point.
[[nodiscard]] std::optional<Barrier> within_triangle(const std::array<Vec3f, 3>& triangle,
                                                     const Barrier& barrier);

/// Finds where the surfaces of a scene that let no light pass straight meet its triangles or all
/// but touch them.
class BarrierFinder {
 public:
  explicit BarrierFinder(const scene::Scene& scene);
  ~BarrierFinder();

  /// \param reach  [m]: what ends within this height above or below the triangle stands on it.
  /// Nearly parallel surfaces (within 11 degrees) are none. Segments end at the triangle's border.
  [[nodiscard]] std::vector<Barrier> on(scene::ObjectId object, std::uint32_t triangle,
                                        double reach) const;
  /// Outlines, in the triangle's plane, of what lies parallel above its front and no more than
  /// `reach` [m] away: light that reaches the surface beside them does not reach it below.
  /// \param length  [m]: objects all of whose edges are shorter are left out.
  [[nodiscard]] std::vector<Barrier> outlines_above(scene::ObjectId object, std::uint32_t triangle,
                                                    double reach, double length) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::radiosity
