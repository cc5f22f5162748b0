#include "share_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "box_sums.h"
#include "for_pixels.h"

namespace atrium::trace {
namespace {

// Surroundings [pixels]: wide, because the noise of single pixels hides the bias, and because a
// pixel's own samples must not count for much.
constexpr int kReach = 9;
constexpr std::uint8_t kKinds = 3;
constexpr int kNear = 2;           // neighbours that say what kind of pixel one is [pixels]
constexpr float kFacing = 0.985f;  // least cosine between normals of one surface
constexpr float kPlane = 0.05f;    // largest slope within it

std::uint8_t kind_of(const ShareGuides& g, int x, int y) {
  const auto index = [&](int u, int v) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(g.width) +
           static_cast<std::size_t>(u);
  };
  const std::size_t p = index(x, y);
  int same = 0, all = 0;
  for (int v = std::max(0, y - kNear); v <= std::min(g.height - 1, y + kNear); ++v)
    for (int u = std::max(0, x - kNear); u <= std::min(g.width - 1, x + kNear); ++u) {
      if (u == x && v == y) continue;
      ++all;
      const std::size_t q = index(u, v);
      if (!(g.depth[p] > 0.0f && g.depth[q] > 0.0f)) continue;
      const Vec3f d = g.position(q) - g.position(p);
      const float height = std::max(std::abs(d.dot(g.normal(p))), std::abs(d.dot(g.normal(q))));
      if (g.normal(p).dot(g.normal(q)) > kFacing && height < kPlane * d.norm()) ++same;
    }
  return static_cast<std::uint8_t>(3 * same < all ? 2 : 3 * same < 2 * all ? 1 : 0);
}

// Expectation, of one half: variance of the mean of two replicates of equal size plus square of
// its bias.
double squared_error(const Illumination& own, const Illumination& candidate, const Rgb& weight,
                     std::size_t half, std::size_t i) {
  const std::size_t first = 2 * half, second = first + 1;
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto w = static_cast<double>(weight[c]);
    const auto a = static_cast<double>(candidate.replicate[first][i][c]);
    const auto b = static_cast<double>(candidate.replicate[second][i][c]);
    const double change_a = a - static_cast<double>(own.replicate[first][i][c]);
    const double change_b = b - static_cast<double>(own.replicate[second][i][c]);
    // Of the mean of four: half of that of two.
    sum += w * w * ((a - b) * (a - b) / 8.0 + change_a * change_b);
  }
  return sum;
}

}  // namespace

std::vector<std::uint8_t> surface_kinds(const ShareGuides& guides) {
  std::vector<std::uint8_t> kinds(guides.depth.size());
  for_pixels(guides.width, guides.height,
             [&](int x, int y, std::size_t i) { kinds[i] = kind_of(guides, x, y); });
  return kinds;
}

ShareChoice::ShareChoice(const ShareGuides& guides, const std::vector<std::uint8_t>& kinds,
                         const std::vector<Rgb>& weight, const Illumination& own)
    : width_(guides.width),
      height_(guides.height),
      kinds_(kinds),
      weight_(weight),
      own_(own),
      best_(own) {
  for (const std::size_t half : {0U, 1U}) {
    least_[half] = error_around(1 - half, own_);
    taken_[half].assign(weight_.size(), 0);
  }
}

void ShareChoice::offer(const Illumination& candidate) {
  for (const std::size_t half : {0U, 1U}) {
    const std::vector<double> error = error_around(1 - half, candidate);
    for_pixels(width_, height_, [&](int, int, std::size_t i) {
      if (!(error[i] < least_[half][i])) return;
      least_[half][i] = error[i];
      taken_[half][i] = 1;
      for (const std::size_t r : {2 * half, 2 * half + 1})
        best_.replicate[r][i] = candidate.replicate[r][i];
    });
  }
}

// As a half sees it: sums over the pixel's surroundings, of its kind.
std::vector<double> ShareChoice::error_around(std::size_t half,
                                              const Illumination& candidate) const {
  std::vector<double> squares(weight_.size()), around(weight_.size());
  for_pixels(width_, height_, [&](int, int, std::size_t i) {
    squares[i] = squared_error(own_, candidate, weight_[i], half, i);
  });
  for (std::uint8_t kind = 0; kind < kKinds; ++kind) {
    const BoxSums errors(width_, height_,
                         [&](std::size_t i) { return kinds_[i] == kind ? squares[i] : 0.0; });
    for_pixels(width_, height_, [&](int x, int y, std::size_t i) {
      if (kinds_[i] == kind) around[i] = errors.around(x, y, kReach);
    });
  }
  return around;
}

}  // namespace atrium::trace
