#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace atrium::app {

/// Wall and CPU time of the parts of a run. One phase is open at a time; entering the next closes
/// it, entering the same name again adds to it.
class PhaseClock {
 public:
  struct Phase {
    std::string name;
    double wall = 0.0;  ///< [s]
    double cpu = 0.0;   ///< [s], user and system, all threads of the process
  };
  PhaseClock();

  void enter(std::string_view name);
  void leave();
  /// Closed phases, in the order they were first entered.
  [[nodiscard]] const std::vector<Phase>& phases() const { return phases_; }
  /// Since construction [s].
  [[nodiscard]] double elapsed() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_, entered_;
  double entered_cpu_ = 0.0;
  std::string current_;
  std::vector<Phase> phases_;
};

/// Time from construction on.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] double wall() const;  ///< [s]
  [[nodiscard]] double cpu() const;   ///< [s], as Phase::cpu

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_start_;
};

/// Largest resident memory of the process so far [MB, 1e6 bytes].
[[nodiscard]] double peak_memory_mb();

}  // namespace atrium::app
