#pragma once

namespace atrium::bench {

/// What a computation took from this process: time between construction and the call, memory at
/// its peak meanwhile.
class Effort {
 public:
  Effort();
  [[nodiscard]] double cpu_seconds() const;  ///< user and system, all threads
  [[nodiscard]] double wall_seconds() const;
  /// [MB] of the whole process, scene and ray queries included. Where the system does not allow
  /// the mark to be reset: since the process started.
  [[nodiscard]] double peak_memory_mb() const;

 private:
  double cpu_, wall_;
};

}  // namespace atrium::bench
