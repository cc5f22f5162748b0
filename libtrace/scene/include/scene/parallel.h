#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace atrium::scene {

/// Limits the threads that parallel_for() uses while it lives. 0: one per core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls body(begin, end) for disjoint chunks of [0, count) of at most `grain` items, in parallel.
/// Chunk borders depend on count and grain only, never on threads: chunk i is
/// [i * grain, min(count, (i + 1) * grain)). Sets flush-to-zero in every worker.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace atrium::scene
