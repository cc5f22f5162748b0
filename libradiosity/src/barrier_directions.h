#pragma once

#include <cstdint>
#include <vector>

#include "barriers.h"

namespace atrium::radiosity {

/// Finds which of many barriers of one facet may lie on a line, by their directions in the facet's
/// plane.
class BarrierDirections {
 public:
  /// \param axis, normal  unit, of the facet. \param tolerance  [m]: how far beside a line the ends
  /// of a barrier that lies on it may be.
  BarrierDirections(const std::vector<Barrier>& barriers, const Vec3d& axis, const Vec3d& normal,
                    double tolerance);

  /// Appends the numbers of all barriers that have this direction, or may have it, and of some
  /// others; no number twice.
  void along(const Vec3d& direction, std::vector<std::uint32_t>& numbers) const;

 private:
  struct Directed {
    double angle;  // [rad], in [0, pi)
    std::uint32_t number;
  };
  [[nodiscard]] double angle_of(const Vec3d& direction) const;

  Vec3d axis_u_, axis_v_;
  std::vector<Directed> long_;        // by angle
  std::vector<std::uint32_t> short_;  // their ends say little about their direction
};

}  // namespace atrium::radiosity
