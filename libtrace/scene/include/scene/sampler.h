#pragma once

#include <array>
#include <cstddef>
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
      : key_(hash_combine(
            hash_combine(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)),
            stream)),
        index_(index) {}

  /// The numbers of one sample from dimension pair `first_pair` on.
  Sampler(std::uint64_t seed, std::uint32_t stream, std::uint32_t index, std::uint32_t first_pair)
      : Sampler(seed, stream, index) {
    dimension_ = first_pair;
  }

  [[nodiscard]] Vec2f next_2d() {
    Vec2f u;
    draw(keys(key_, dimension_++), index_, u.x(), u.y());
    return u;
  }
  /// The first number of such a pair.
  [[nodiscard]] float next_1d() {
    const Keys k = keys(key_, dimension_++);
    return to_unit(reverse(scramble(shuffled(k, index_), k.x)));
  }

  /// Dimension pairs 0 and 1 of samples first_index .. first_index + count - 1 of a stream, as
  /// Sampler has them, many at a time. \param u  room for `count` numbers of each of the four
  /// dimensions.
  static void fill(std::uint64_t seed, std::uint32_t stream, std::uint32_t first_index,
                   std::size_t count, std::array<float*, 4> u);

 private:
  struct Keys {
    std::uint32_t shuffle, x, y;
  };
  static constexpr Keys keys(std::uint32_t key, std::uint32_t dimension) {
    const std::uint32_t k = hash_combine(key, dimension);
    return {k, hash32(k ^ 0x68bc21ebU), hash32(k ^ 0x02e5be93U)};
  }
  static constexpr std::uint32_t shuffled(const Keys& k, std::uint32_t index) {
    return reverse(scramble(reverse(index), k.shuffle));
  }
  static constexpr void draw(const Keys& k, std::uint32_t index, float& x, float& y) {
    const std::uint32_t i = shuffled(k, index);
    x = to_unit(reverse(scramble(i, k.x)));
    y = to_unit(reverse(scramble(pascal(i), k.y)));
  }
  static constexpr float to_unit(std::uint32_t v) {
    return static_cast<float>(static_cast<std::int32_t>(v >> 8)) * 0x1p-24f;
  }
  static constexpr std::uint32_t reverse(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
    return (x >> 16) | (x << 16);
  }
  /// Second Sobol dimension, digits reversed: the Pascal matrix modulo 2. As a polynomial the
  /// digits i(x) become i(1 + x), and (1 + x)^m = 1 + x^m for m a power of two.
  static constexpr std::uint32_t pascal(std::uint32_t i) {
    i ^= i >> 16;
    i ^= (i >> 8) & 0x00ff00ffU;
    i ^= (i >> 4) & 0x0f0f0f0fU;
    i ^= (i >> 2) & 0x33333333U;
    return i ^ ((i >> 1) & 0x55555555U);
  }
  /// Hash-based nested uniform scramble (Laine & Karras 2011) of digits, least significant first.
  static constexpr std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return x;
  }

  std::uint32_t key_;
  std::uint32_t index_;
  std::uint32_t dimension_ = 0;
};

}  // namespace atrium::scene
