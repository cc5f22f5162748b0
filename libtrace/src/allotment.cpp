#include "allotment.h"

#include <algorithm>
#include <cmath>

#include "box_sums.h"
#include "picture_samples.h"

namespace atrium::trace {
namespace {

constexpr int kNear = 3, kWide = 9;  // radius of neighbourhoods [pixels]
constexpr double kPrior = 0.2;       // weight of the wide one
constexpr double kMostGrowth = 8.0;  // of one pixel in one round

/// Of a pixel: what its error falls by, what a sample costs, and sqrt(a / cost).
struct Slope {
  double a = 0.0, cost = 1.0, root = 0.0;
};

// Means over squares of pixels without the pixel in the middle.
std::vector<Slope> slopes_of(const PixelCosts& p) {
  const auto noise_of = [&](std::size_t i) {
    return static_cast<double>(p.noise[i]) * static_cast<double>(p.count[i]);
  };
  const auto bias_of = [&](std::size_t i) {
    return static_cast<double>(p.bias[i]) * static_cast<double>(p.count[i]);
  };
  const BoxSums noise(p.width, p.height, noise_of), bias(p.width, p.height, bias_of);
  const BoxSums cost(p.width, p.height, [&](std::size_t i) { return p.cost[i]; });
  std::vector<Slope> slopes(p.noise.size());
  std::size_t i = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x, ++i) {
      const auto others = [&](const BoxSums& sums, double own, int radius) {
        const double count = sums.count(x, y, radius) - 1.0;
        return count > 0.0 ? std::max(0.0, sums.around(x, y, radius) - own) / count : own;
      };
      Slope& slope = slopes[i];
      slope.a = (1.0 - kPrior) * others(noise, noise_of(i), kNear) +
                kPrior * others(noise, noise_of(i), kWide) + others(bias, bias_of(i), kWide);
      slope.cost = std::max(1e-3, others(cost, static_cast<double>(p.cost[i]), kNear));
      slope.root = std::sqrt(slope.a / slope.cost);
    }
  return slopes;
}

double wanted(const PixelCosts& p, const RoundLimits& limits, const Slope& slope, std::size_t i,
              double k) {
  const double now = p.count[i];
  const double most = std::max(now, std::min(static_cast<double>(limits.most), kMostGrowth * now));
  return std::clamp(k * slope.root, now, most);
}

/// Of the whole picture.
struct Plan {
  double square = 0.0;  ///< e^2
  double cost = 0.0;
};

Plan plan(const PixelCosts& p, const RoundLimits& limits, const std::vector<Slope>& slopes,
          double k) {
  Plan total;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double n = wanted(p, limits, slopes[i], i, k);
    total.square += slopes[i].a / n;
    total.cost += slopes[i].cost * n;
  }
  total.square /= static_cast<double>(slopes.size());
  return total;
}

}  // namespace

std::vector<std::uint32_t> allot_samples(const PixelCosts& p, const RoundLimits& limits) {
  const std::vector<Slope> slopes = slopes_of(p);
  const double most_cost = limits.growth * plan(p, limits, slopes, 0.0).cost;
  // The least k that reaches the goal, or the largest that may be paid.
  double low = 0.0, high = 1.0;
  const auto enough = [&](double k) {
    const Plan total = plan(p, limits, slopes, k);
    return total.square <= limits.goal * limits.goal || total.cost >= most_cost;
  };
  for (int i = 0; i < 200 && !enough(high); ++i) high *= 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (enough(middle) ? high : low) = middle;
  }
  std::vector<std::uint32_t> target(p.count);
  constexpr auto kStep = static_cast<std::uint32_t>(kReplicates);
  for (std::size_t i = 0; i < target.size(); ++i) {
    const double more = wanted(p, limits, slopes[i], i, high) - static_cast<double>(p.count[i]);
    const auto steps = static_cast<std::uint32_t>(std::lround(more / kStep));
    target[i] = std::min(std::max(limits.most, p.count[i]), p.count[i] + steps * kStep);
  }
  return target;
}

}  // namespace atrium::trace
