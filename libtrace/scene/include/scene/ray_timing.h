#pragma once

#include <array>
#include <cstdint>

#include "scene/counters.h"

namespace atrium::scene {

/// How long Embree takes: a few rays of each kind are timed on the wall clock, less what reading
/// the clock takes; rays that took so long that the thread must have waited for a core do not
/// count.
struct RayTiming {
  struct Kind {
    std::uint64_t rays = 0;  ///< that were timed
    double seconds = 0.0;    ///< that they took in Embree
  };
  std::array<Kind, static_cast<std::size_t>(Counter::Count_)> kind{};

  /// Estimated seconds within Embree, all threads together, of the rays that were counted.
  [[nodiscard]] double seconds(const Counters& counters) const;
};

RayTiming& operator+=(RayTiming& sum, const RayTiming& more);
/// What was timed after an earlier moment.
[[nodiscard]] RayTiming operator-(const RayTiming& now, const RayTiming& earlier);

}  // namespace atrium::scene
