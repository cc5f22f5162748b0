#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh.h"
#include "triangles.h"

namespace atrium::view {

/// A half space that stays: what has normal . p <= distance.
struct Clip {
  Vec3d normal;     ///< unit
  double distance;  ///< [m]
  friend bool operator==(const Clip&, const Clip&) = default;
};

/// Which polygon a ray meets first, among those that are shown.
class Picker {
 public:
  Picker(const Mesh& mesh, const Triangles& triangles);
  ~Picker();
  Picker(const Picker&) = delete;
  Picker& operator=(const Picker&) = delete;

  struct Hit {
    std::size_t polygon;
    Vec3d position;
    bool front;                            ///< its front faces where the ray comes from
    std::array<std::uint32_t, 3> corners;  ///< of the triangle
    std::array<double, 3> weights;         ///< of the corners there, sum 1
  };
  /// \param direction  unit. \param clips  what they take away is not met.
  /// \param cull  faces that are turned away are not met either.
  [[nodiscard]] std::optional<Hit> pick(const Vec3d& origin, const Vec3d& direction,
                                        const std::vector<Clip>& clips, bool cull) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::view
