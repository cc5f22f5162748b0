#include "scene/sampler.h"

#include <vector>

#include <gtest/gtest.h>

namespace atrium::scene {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  std::uint32_t r = 0;
  for (int bit = 0; bit < 32; ++bit) r |= (x >> bit & 1U) << (31 - bit);
  return r;
}
std::uint32_t owen(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return reversed(x);
}
// Second Sobol dimension by its direction numbers: v_0 = 1/2, v_(k+1) = v_k ^ (v_k >> 1).
std::uint32_t sobol(std::uint32_t i) {
  std::uint32_t r = 0;
  for (std::uint32_t v = 1U << 31; i != 0; i >>= 1, v ^= v >> 1)
    if ((i & 1U) != 0) r ^= v;
  return r;
}

// The short cuts of the sampler against Burley 2020 written out: shuffle, two dimensions, scramble.
TEST(Sampler, IsAScrambledSobolSequenceBitByBit) {
  for (const std::uint32_t stream : {0U, 7U, 123456789U})
    for (const std::uint32_t index : {0U, 1U, 2U, 63U, 64U, 1000003U, 0xffffffffU}) {
      Sampler sampler(42, stream, index);
      const std::uint32_t key = hash_combine(hash_combine(42, 0), stream);
      for (std::uint32_t pair = 0; pair < 3; ++pair) {
        const std::uint32_t k = hash_combine(key, pair);
        const std::uint32_t i = owen(index, k);
        const std::uint32_t a = owen(reversed(i), hash32(k ^ 0x68bc21ebU));
        const std::uint32_t b = owen(sobol(i), hash32(k ^ 0x02e5be93U));
        const Vec2f u = sampler.next_2d();
        EXPECT_EQ(u.x(), static_cast<float>(a >> 8) * 0x1p-24f);
        EXPECT_EQ(u.y(), static_cast<float>(b >> 8) * 0x1p-24f);
      }
    }
}

// Many at a time, whatever instructions that takes, and starting at a later pair.
TEST(Sampler, FillAndLaterPairsAreTheSameNumbers) {
  constexpr std::size_t kCount = 37;
  std::array<std::vector<float>, 4> u;
  for (auto& v : u) v.resize(kCount);
  Sampler::fill(3, 9, 1000, kCount, {u[0].data(), u[1].data(), u[2].data(), u[3].data()});
  for (std::size_t n = 0; n < kCount; ++n) {
    const auto index = static_cast<std::uint32_t>(1000 + n);
    Sampler sampler(3, 9, index);
    const Vec2f a = sampler.next_2d(), b = sampler.next_2d();
    EXPECT_EQ(a, Vec2f(u[0][n], u[1][n]));
    EXPECT_EQ(b, Vec2f(u[2][n], u[3][n]));
    EXPECT_EQ(sampler.next_2d(), Sampler(3, 9, index, 2).next_2d());
  }
}

}  // namespace
}  // namespace atrium::scene
