// The other back end of scene/parallel.h (ATRIUM_PARALLEL=threads): plain threads, which the thread
// sanitizer understands; it does not see what TBB does between its own. Starts them anew every
// time.
#include "scene/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <xmmintrin.h>

namespace atrium::scene {
namespace {

std::atomic<int> most_threads{0};  // 0: one per core
thread_local bool is_worker = false;

std::size_t thread_count() {
  const int limit = most_threads.load();
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return limit > 0 ? static_cast<std::size_t>(limit) : cores;
}

}  // namespace

struct ThreadLimit::Impl {
  int before = 0;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads <= 0) return;
  impl_ = std::make_unique<Impl>();
  impl_->before = most_threads.load();
  // The lowest of nested limits holds, as in TBB.
  most_threads = impl_->before > 0 ? std::min(impl_->before, threads) : threads;
}
ThreadLimit::~ThreadLimit() {
  if (impl_) most_threads = impl_->before;
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    const unsigned saved = _mm_getcsr();
    _mm_setcsr(saved | 0x8040U);  // as parallel_tbb.cpp does
    try {
      for (std::size_t i = next++; i < chunks; i = next++)
        body(i * grain, std::min(count, (i + 1) * grain));
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = chunks;
    }
    _mm_setcsr(saved);
  };
  std::vector<std::jthread> threads;
  // Loops within loops run on the thread that meets them.
  const std::size_t more = is_worker ? 0 : std::min(thread_count(), chunks) - 1;
  for (std::size_t i = 0; i < more; ++i)
    threads.emplace_back([&] {
      is_worker = true;
      work();
    });
  const bool was_worker = std::exchange(is_worker, true);
  work();
  is_worker = was_worker;
  threads.clear();  // waits for them
  if (failure) std::rethrow_exception(failure);
}

}  // namespace atrium::scene
