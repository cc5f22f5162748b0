#pragma once

#include <cstdint>

#include "material/frame.h"

namespace atrium::scene {

/// 32-bit integer hash with full avalanche (C. Wellons, lowbias32).
[[nodiscard]] constexpr std::uint32_t hash32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}
[[nodiscard]] constexpr std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
  return hash32(a ^ (b * 0x9e3779b9U + 0x7f4a7c15U + (a << 6) + (a >> 2)));
}

/// Low-discrepancy numbers addressed by (seed, stream, sample, dimension): no state is shared, so
/// results depend on nothing but the address. Each pair of dimensions is a (0,2)-sequence (Sobol),
/// Owen-scrambled and shuffled on its own (Burley 2020, JCGT 9(4)).
class Sampler {
 public:
  /// \param stream  pixel, element, photon batch...; \param index  sample number within the stream.
  Sampler(std::uint64_t seed, std::uint32_t stream, std::uint32_t index)
      : key_(hash_combine(hash_combine(static_cast<std::uint32_t>(seed),
                                       static_cast<std::uint32_t>(seed >> 32)), stream)),
        index_(index) {}

  [[nodiscard]] Vec2f next_2d() {
    const std::uint32_t key = hash_combine(key_, dimension_++);
    const std::uint32_t i = owen(index_, key);
    const std::uint32_t a = owen(reverse(i), hash32(key ^ 0x68bc21ebU));
    const std::uint32_t b = owen(sobol1(i), hash32(key ^ 0x02e5be93U));
    return {to_unit(a), to_unit(b)};
  }
  [[nodiscard]] float next_1d() { return next_2d().x(); }

 private:
  static constexpr float to_unit(std::uint32_t v) {
    return static_cast<float>(v >> 8) * 0x1p-24f;
  }
  static constexpr std::uint32_t reverse(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    return __builtin_bswap32(x);
  }
  /// Second Sobol dimension: the Pascal matrix applied to the digits of i, reversed.
  static constexpr std::uint32_t sobol1(std::uint32_t i) {
    std::uint32_t r = 0;
    for (std::uint32_t v = 1U << 31; i != 0; i >>= 1, v ^= v >> 1)
      if ((i & 1U) != 0) r ^= v;
    return r;
  }
  /// Hash-based nested uniform scramble (Laine & Karras 2011) of the bits from the most significant.
  static constexpr std::uint32_t owen(std::uint32_t x, std::uint32_t seed) {
    x = reverse(x);
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return reverse(x);
  }

  std::uint32_t key_;
  std::uint32_t index_;
  std::uint32_t dimension_ = 0;
};

}  // namespace atrium::scene
