#include "scene/parallel.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

namespace atrium::scene {

struct ThreadLimit::Impl {
  tbb::global_control control;
  explicit Impl(std::size_t threads)
      : control(tbb::global_control::max_allowed_parallelism, threads) {}
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) impl_ = std::make_unique<Impl>(static_cast<std::size_t>(threads));
}
ThreadLimit::~ThreadLimit() = default;

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  tbb::parallel_for(
      std::size_t{0}, chunks,
      [&](std::size_t i) {
        // Denormals cost a hundred cycles each and carry no light; Embree asks for both flags.
        const unsigned saved = _mm_getcsr();
        _mm_setcsr(saved | 0x8040U);
        body(i * grain, std::min(count, (i + 1) * grain));
        _mm_setcsr(saved);
      },
      tbb::simple_partitioner{});
}

}  // namespace atrium::scene
