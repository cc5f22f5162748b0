#include "share_weights.h"

#include <algorithm>
#include <cmath>

namespace atrium::trace {
namespace {

constexpr float kNothing = 32.0f;  // unlikeness from which on a neighbour's light is none
constexpr float kErrors = 3.0f;    // standard errors of a difference that noise may explain
constexpr float kPlane = 0.1f;     // tangent of the slope that counts as the same surface
constexpr float kTiny = 1e-37f;    // keeps quotients of nothing finite

float power_16(float x) {
  const float x2 = x * x, x4 = x2 * x2, x8 = x4 * x4;
  return x8 * x8;
}
float power_48(float x) {
  const float x16 = power_16(x);
  return x16 * x16 * x16;
}

/// About exp(-x), for a fifth of its time: (1 - x / 32)^32, nothing from there on. Of this the
/// root.
float falloff_root(float x) { return std::max(0.0f, 1.0f - x / kNothing); }
float power_32(float x) {
  const float x16 = power_16(x);
  return x16 * x16;
}

}  // namespace

void find_weights(const ShareGuides& guides, const ShareNoise& light, std::size_t p, std::size_t q,
                  std::size_t count, float factor, const std::array<float*, 2>& weights) {
  const float *nx = guides.normals[0].data(), *ny = guides.normals[1].data(),
              *nz = guides.normals[2].data();
  const float *x = guides.positions[0].data(), *y = guides.positions[1].data(),
              *z = guides.positions[2].data();
  const float *depth = guides.depth.data(), *noise = light.variance.data();
  const float *first = light.luminance[0].data(), *second = light.luminance[1].data();
  // Loops without branches that write to arrays of their own: the compiler does four pixels at
  // once. Powers are a loop for themselves, of what has been cut at 0: in one loop they would be
  // taken of what is cut as well, and overflow.
  constexpr std::size_t kBatch = 64;
  std::array<float, kBatch> facing, flat, of_first, of_second;
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t end = std::min(count, begin + kBatch);
    for (std::size_t i = 0; i < end - begin; ++i) {
      const std::size_t a = p + begin + i, b = q + begin + i;
      facing[i] = std::max(0.0f, nx[a] * nx[b] + (ny[a] * ny[b] + nz[a] * nz[b]));
      const float dx = x[b] - x[a], dy = y[b] - y[a], dz = z[b] - z[a];
      const float above_a = std::abs(dx * nx[a] + (dy * ny[a] + dz * nz[a]));
      const float above_b = std::abs(dx * nx[b] + (dy * ny[b] + dz * nz[b]));
      const float height = std::max(above_a, above_b);
      const float rounding = 1e-5f * std::max(depth[a], depth[b]);
      const float off_plane =
          height * height /
          (kPlane * kPlane * (dx * dx + (dy * dy + dz * dz)) + rounding * rounding + kTiny);
      const float nearer = std::min(depth[a], depth[b]);  // 0: nothing there
      flat[i] = nearer > 0.0f ? falloff_root(off_plane) : 0.0f;
      // Harmonic mean of the noise: a pixel that is sure of its light does not take from one that
      // is not, as next to a lamp that nearly touches a ceiling. Without noise only the same light
      // is alike.
      const float both = noise[a] * noise[b];
      const float scale =
          (noise[a] + noise[b]) / (2.0f * kErrors * kErrors * (both > 0.0f ? both : 1.0f));
      const auto unlike = [&](float d) {
        const float certain = d == 0.0f ? 0.0f : kNothing;
        return both > 0.0f ? scale * d * d : certain;
      };
      of_first[i] = falloff_root(unlike(first[a] - first[b]));
      of_second[i] = falloff_root(unlike(second[a] - second[b]));
    }
    for (std::size_t i = 0; i < end - begin; ++i) {
      const float surface = power_48(facing[i]) * power_32(flat[i]);
      of_first[i] = factor * surface * power_32(of_first[i]);
      of_second[i] = factor * surface * power_32(of_second[i]);
    }
    std::copy_n(of_first.begin(), end - begin, weights[0] + begin);
    std::copy_n(of_second.begin(), end - begin, weights[1] + begin);
  }
}

}  // namespace atrium::trace
