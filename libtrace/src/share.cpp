#include "share.h"

#include <array>
#include <cmath>

#include "scene/parallel.h"

namespace atrium::trace {
namespace {

constexpr int kLevels = 5;          // reach: 2 * (1 + 2 + 4 + 8 + 16) pixels
constexpr float kNothing = 104.0f;  // exp(-104) is no float
constexpr float kErrors = 3.0f;     // standard errors of a difference that noise may explain
constexpr float kNormalPower = 48.0f;
constexpr float kPlane = 0.1f;  // tangent of the slope that counts as the same surface
constexpr std::array<float, 3> kSpline{0.375f, 0.25f, 0.0625f};  // B3

template <class F>
void for_rows(const ShareGuides& guides, F&& pixel) {
  scene::parallel_for(static_cast<std::size_t>(guides.height), 4,
                      [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y)
                          for (int x = 0; x < guides.width; ++x) pixel(x, static_cast<int>(y));
                      });
}

/// The state between two levels: the replicates, and each half's own average that guides the other.
struct Levels {
  Illumination light;
  std::array<std::vector<Rgb>, 2> guide;
};

class Level {
 public:
  // Weights are the same from p to q as from q to p: what a pixel gives away others receive.
  Level(const ShareGuides& guides, const Levels& in, int step)
      : g_(guides), in_(in), step_(step), noise_(in.light.variance.size()) {
    for_rows(guides, [&](int x, int y) { noise_[index(x, y)] = blurred_variance(x, y); });
  }

  void pixel(int x, int y, Levels& out) const {
    const std::size_t p = index(x, y);
    if (!(g_.depth[p] > 0.0f)) {
      for (std::size_t r = 0; r < kReplicates; ++r)
        out.light.replicate[r][p] = in_.light.replicate[r][p];
      for (std::size_t h = 0; h < 2; ++h) out.guide[h][p] = in_.guide[h][p];
      out.light.variance[p] = in_.light.variance[p];
      return;
    }
    std::array<Rgb, kReplicates> sum;
    std::array<Rgb, 2> guide;
    std::array<float, 2> weights{}, variance{};
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int qx = x + dx * step_, qy = y + dy * step_;
        if (qx < 0 || qy < 0 || qx >= g_.width || qy >= g_.height) continue;
        const std::size_t q = index(qx, qy);
        const float surface = kSpline[static_cast<std::size_t>(std::abs(dx))] *
                              kSpline[static_cast<std::size_t>(std::abs(dy))] *
                              (p == q ? 1.0f : same_surface(p, q));
        if (!(surface > 0.0f)) continue;
        for (std::size_t h = 0; h < 2; ++h) {
          const float w = p == q ? surface : surface * same_light(in_.guide[h], p, q);
          guide[h] += in_.guide[h][q] * w;
          const std::size_t other = 2 * (1 - h);
          sum[other] += in_.light.replicate[other][q] * w;
          sum[other + 1] += in_.light.replicate[other + 1][q] * w;
          weights[h] += w;
          variance[h] += w * w * in_.light.variance[q];
        }
      }
    // From the second level on neighbours hold some of the same samples: composed, the splines
    // divide the variance by 4 per level where independent pixels would divide it by 13.
    constexpr float kOverlap = 3.3f;
    float independent = 0.0f;
    for (std::size_t h = 0; h < 2; ++h) {
      out.guide[h][p] = guide[h] / weights[h];
      const std::size_t other = 2 * (1 - h);
      out.light.replicate[other][p] = sum[other] / weights[h];
      out.light.replicate[other + 1][p] = sum[other + 1] / weights[h];
      independent += 0.5f * variance[h] / (weights[h] * weights[h]);
    }
    out.light.variance[p] =
        step_ > 1 ? std::min(kOverlap * independent, in_.light.variance[p]) : independent;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(g_.width) +
           static_cast<std::size_t>(x);
  }
  // The variance of one pixel is itself noisy: a pixel that no bright sample has hit looks certain.
  [[nodiscard]] float blurred_variance(int x, int y) const {
    float sum = 0.0f, weights = 0.0f;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int qx = x + dx, qy = y + dy;
        if (qx < 0 || qy < 0 || qx >= g_.width || qy >= g_.height) continue;
        const std::size_t q = index(qx, qy);
        if (!(g_.depth[q] > 0.0f)) continue;
        const float w = kSpline[static_cast<std::size_t>(std::abs(dx))] *
                        kSpline[static_cast<std::size_t>(std::abs(dy))];
        sum += w * in_.light.variance[q];
        weights += w;
      }
    return weights > 0.0f ? sum / weights : 0.0f;
  }
  [[nodiscard]] float same_surface(std::size_t p, std::size_t q) const {
    if (!(g_.depth[q] > 0.0f)) return 0.0f;
    const float cosine = g_.normal[p].dot(g_.normal[q]);
    if (!(cosine > 0.0f)) return 0.0f;
    const Vec3f d = g_.position[q] - g_.position[p];
    const float height = std::max(std::abs(d.dot(g_.normal[p])), std::abs(d.dot(g_.normal[q])));
    const float off_plane =
        height / (kPlane * d.norm() + 1e-5f * std::max(g_.depth[p], g_.depth[q]));
    return std::pow(cosine, kNormalPower) * std::exp(-off_plane * off_plane);
  }
  [[nodiscard]] float same_light(const std::vector<Rgb>& value, std::size_t p,
                                 std::size_t q) const {
    const float difference = luminance(value[p]) - luminance(value[q]);
    // Harmonic mean: a pixel that is sure of its light does not take from one that is not, as next
    // to a lamp that nearly touches a ceiling.
    const float sum = noise_[p] + noise_[q];
    const float allowed =
        sum > 0.0f ? kErrors * kErrors * 2.0f * noise_[p] * noise_[q] / sum : 0.0f;
    if (!(allowed > 0.0f)) return difference == 0.0f ? 1.0f : 0.0f;
    const float square = difference * difference;
    return square < kNothing * allowed ? std::exp(-square / allowed) : 0.0f;
  }

  const ShareGuides& g_;
  const Levels& in_;
  int step_;
  std::vector<float> noise_;
};

}  // namespace

std::vector<Illumination> share_by_levels(const ShareGuides& guides, Illumination illumination) {
  std::vector<Illumination> kept{illumination};
  Levels now{std::move(illumination), {}};
  for (std::size_t h = 0; h < 2; ++h) {
    const std::vector<Rgb>& a = now.light.replicate[2 * h];
    const std::vector<Rgb>& b = now.light.replicate[2 * h + 1];
    now.guide[h].resize(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) now.guide[h][i] = (a[i] + b[i]) * 0.5f;
  }
  Levels next = now;
  for (int level = 0; level < kLevels; ++level) {
    const Level pass(guides, now, 1 << level);
    for_rows(guides, [&](int x, int y) { pass.pixel(x, y, next); });
    std::swap(now, next);
    if (level == 0 || level == 2 || level == kLevels - 1) kept.push_back(now.light);
  }
  return kept;
}

Illumination share_illumination(const ShareGuides& guides, Illumination illumination) {
  return std::move(share_by_levels(guides, std::move(illumination)).back());
}

}  // namespace atrium::trace
