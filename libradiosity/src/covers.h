#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "barriers.h"
#include "scene/ray_query.h"

namespace atrium::radiosity {

/// Which surfaces lie in one plane on top of each other, as far as rounding can tell. Rays meet any
/// of them, so only one may count the light that arrives: the one of the lowest object number.
class Covers {
 public:
  explicit Covers(const scene::Scene& scene);
  ~Covers();

  struct Cover {
    scene::ObjectId object;
    std::uint32_t triangle = 0;
    bool turned = false;  ///< its front is the covered surface's back
  };
  /// The surface of the lowest object below the point's own that lies on the point.
  [[nodiscard]] std::optional<Cover> of(const scene::SurfacePoint& point) const;
  /// Where the surfaces that lie on a triangle end on it: cut along these, every part of it is
  /// covered as a whole or not at all.
  [[nodiscard]] std::vector<Barrier> outlines_on(scene::ObjectId object,
                                                 std::uint32_t triangle) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::radiosity
