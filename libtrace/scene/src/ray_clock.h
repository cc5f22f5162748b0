#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "scene/ray_timing.h"

namespace atrium::scene {

/// Times every 64th call of a kind (RayTiming). Thread-safe.
class RayClock {
 public:
  RayClock() {
    std::int64_t least = 1000000;
    for (int i = 0; i < 64; ++i) least = std::min(least, since(Clock::now()));
    reading_ = least;
  }

  /// \param number  of the call: which are timed depends on nothing else.
  template <class F>
  void time(std::uint64_t number, Counter kind, std::uint64_t rays, F&& trace) const {
    constexpr std::uint64_t kEvery = 64;
    if (number % kEvery != 0) {
      trace();
      return;
    }
    const Clock::time_point start = Clock::now();
    trace();
    const std::int64_t taken = std::max<std::int64_t>(0, since(start) - reading_);
    constexpr std::int64_t kWaited = 50000;  // of one ray [ns]
    if (taken > kWaited * static_cast<std::int64_t>(rays)) return;
    const auto k = static_cast<std::size_t>(kind);
    rays_[k].fetch_add(rays, std::memory_order_relaxed);
    nanoseconds_[k].fetch_add(static_cast<std::uint64_t>(taken), std::memory_order_relaxed);
  }

  [[nodiscard]] RayTiming timing() const {
    RayTiming t;
    for (std::size_t k = 0; k < t.kind.size(); ++k)
      t.kind[k] = {rays_[k].load(std::memory_order_relaxed),
                   1e-9 * static_cast<double>(nanoseconds_[k].load(std::memory_order_relaxed))};
    return t;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static std::int64_t since(Clock::time_point start) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
  }
  static constexpr std::size_t kKinds = static_cast<std::size_t>(Counter::Count_);
  std::int64_t reading_ = 0;  // what reading the clock takes [ns]
  mutable std::array<std::atomic<std::uint64_t>, kKinds> rays_{}, nanoseconds_{};
};

}  // namespace atrium::scene
