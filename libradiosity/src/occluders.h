#pragma once

#include <array>
#include <vector>

#include "patches.h"

namespace atrium::radiosity {

/// Tells pairs of patches that nothing can stand between from those that rays have to decide.
class Occluders {
 public:
  explicit Occluders(const scene::Scene& scene);

  /// False only if every triangle is behind one of the patches, in its plane, or outside the box
  /// round both. A surface that merely touches the box is outside.
  [[nodiscard]] bool may_block(const Patch& a, const Patch& b) const;

 private:
  struct Triangle {
    std::array<Vec3d, 3> corners;
    scene::Bounds box;
  };
  struct Object {
    scene::Bounds box;
    std::vector<Triangle> triangles;
  };
  std::vector<Object> objects_;
};

}  // namespace atrium::radiosity
