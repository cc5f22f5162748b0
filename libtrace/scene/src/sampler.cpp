#include "scene/sampler.h"

namespace atrium::scene {

// Integers only, so every instruction set gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("avx512f", "avx2", "default"), optimize("O3")))
#endif
void Sampler::fill(std::uint64_t seed, std::uint32_t stream, std::uint32_t first_index,
                   std::size_t count, std::array<float*, 4> u) {
  const Sampler sampler(seed, stream, 0);
  for (std::uint32_t pair = 0; pair < 2; ++pair) {
    const Keys k = keys(sampler.key_, pair);
    float* const x = u[2 * std::size_t{pair}];
    float* const y = u[2 * std::size_t{pair} + 1];
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t index = first_index + static_cast<std::uint32_t>(n);
      draw(k, index, x[n], y[n]);
    }
  }
}

}  // namespace atrium::scene
