#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "memory_budget.h"
#include "scene/control.h"
#include "scene/counters.h"
#include "scene/parallel.h"

namespace atrium::radiosity {

/// Progress, cancellation, the limits of time and memory of one solve. `share` of the whole that a
/// pass covers moves the reported fraction from where the pass before ended.
class Work {
 public:
  /// \param time_limit  [s]. \param memory_limit  [bytes]. 0: none.
  Work(const scene::Control& control, double time_limit, std::uint64_t memory_limit = 0)
      : control_(control),
        time_limit_(time_limit),
        start_(std::chrono::steady_clock::now()),
        memory_(memory_limit) {}

  [[nodiscard]] MemoryBudget& memory() { return memory_; }

  [[nodiscard]] bool stopped() {
    if (!stopped_by_.empty()) return true;
    if (control_.stop_requested()) stopped_by_ = "interrupt";
    if (time_limit_ > 0.0 && seconds() > time_limit_) stopped_by_ = "time limit";
    return !stopped_by_.empty();
  }
  [[nodiscard]] const std::string& stopped_by() const { return stopped_by_; }

  void begin(std::string remark, double until) {
    from_ = until_;
    until_ = until;
    remark_ = std::move(remark);
    report(0.0);
  }
  void report(double fraction) const {
    control_.report("radiosity", from_ + (until_ - from_) * fraction, remark_);
  }

  /// body(begin, end, counters) over [0, count) in chunks of `grain`, in waves between which
  /// stopped() is asked. Counters are summed. False if it ended early; then a prefix is done.
  /// Threads wait for each other once a wave, on average for half a chunk each: of kWave chunks, 16
  /// threads lose a few per cent by that.
  /// \param chunks  of a wave; few where a chunk takes seconds.
  static constexpr std::size_t kWave = 256;
  using Body = std::function<void(std::size_t, std::size_t, scene::Counters&)>;
  bool run(std::size_t count, std::size_t grain, scene::Counters& counters, const Body& body,
           std::size_t chunks = kWave) {
    const std::size_t wave = grain * chunks;
    for (std::size_t first = 0; first < count; first += wave) {
      if (stopped()) return false;
      const std::size_t n = std::min(wave, count - first);
      std::vector<scene::Counters> parts((n + grain - 1) / grain);
      scene::parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
        body(first + begin, first + end, parts[begin / grain]);
      });
      for (const scene::Counters& c : parts) counters += c;
      report(static_cast<double>(first + n) / static_cast<double>(count));
    }
    return true;
  }

 private:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  const scene::Control& control_;
  double time_limit_;
  std::chrono::steady_clock::time_point start_;
  MemoryBudget memory_;
  std::string stopped_by_, remark_;
  double from_ = 0.0, until_ = 0.0;
};

}  // namespace atrium::radiosity
