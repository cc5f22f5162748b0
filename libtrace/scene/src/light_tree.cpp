#include "light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

namespace atrium::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float safe_acos(float c) { return std::acos(std::clamp(c, -1.0f, 1.0f)); }
float sin_from_cos(float c) { return std::sqrt(std::max(0.0f, 1.0f - c * c)); }

// Smallest cone that holds two cones.
void merge_cones(LightBounds& a, const LightBounds& b) {
  const float ta = safe_acos(a.cos_spread);
  const float tb = safe_acos(b.cos_spread);
  const float between = safe_acos(a.axis.dot(b.axis));
  if (std::min(between + tb, kPi) <= ta) return;
  if (std::min(between + ta, kPi) <= tb) {
    a.axis = b.axis;
    a.cos_spread = b.cos_spread;
    return;
  }
  const float t = 0.5f * (ta + between + tb);
  const Vec3f pivot = a.axis.cross(b.axis);
  if (t >= kPi || pivot.squaredNorm() < 1e-12f) {
    a.cos_spread = -1.0f;
    return;
  }
  a.axis = (Eigen::AngleAxisf(t - ta, pivot.normalized()) * a.axis).normalized();
  a.cos_spread = std::cos(t);
}

LightBounds merge(LightBounds a, const LightBounds& b) {
  if (!(a.power > 0.0f)) return b;
  if (!(b.power > 0.0f)) return a;
  merge_cones(a, b);
  a.box.extend(b.box);
  a.power += b.power;
  a.cos_emission = std::min(a.cos_emission, b.cos_emission);
  a.two_sided |= b.two_sided;
  return a;
}

// Cost of a cluster: power times area times solid angle of its orientations.
float cluster_cost(const LightBounds& b, float extent_ratio) {
  if (!(b.power > 0.0f)) return 0.0f;
  const float to = safe_acos(b.cos_spread);
  const float te = safe_acos(b.cos_emission);
  const float tw = std::min(to + te, kPi);
  const float so = sin_from_cos(b.cos_spread);
  const float measure =
      2.0f * kPi * (1.0f - b.cos_spread) +
      0.5f * kPi * (2.0f * tw * so - std::cos(to - 2.0f * tw) - 2.0f * to * so + b.cos_spread);
  const Vec3f d = b.box.sizes();
  const float area = 2.0f * (d.x() * d.y() + d.y() * d.z() + d.z() * d.x());
  return b.power * std::max(measure, 1e-3f) * extent_ratio * std::max(area, 1e-12f);
}

constexpr int kBuckets = 12;

struct Split {
  int axis = -1;
  float position = 0.0f;
};

Split best_split(const std::vector<LightBounds>& lights, std::span<const std::uint32_t> items,
                 const Eigen::AlignedBox3f& centroids) {
  Split best;
  float best_cost = std::numeric_limits<float>::infinity();
  const Vec3f size = centroids.sizes();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0.0f)) continue;
    std::array<LightBounds, kBuckets> bucket{};
    const auto bucket_of = [&](std::uint32_t i) {
      const float x = (lights[i].box.center()[axis] - centroids.min()[axis]) / size[axis];
      return static_cast<std::size_t>(std::clamp(static_cast<int>(x * kBuckets), 0, kBuckets - 1));
    };
    for (const std::uint32_t i : items) {
      LightBounds& b = bucket[bucket_of(i)];
      b = merge(b, lights[i]);
    }
    const float ratio = size.maxCoeff() / size[axis];
    std::array<float, kBuckets> left{};
    LightBounds below{};
    for (std::size_t s = 0; s + 1 < kBuckets; ++s) {
      below = merge(below, bucket[s]);
      left[s] = cluster_cost(below, ratio);
    }
    LightBounds above{};
    for (std::size_t s = kBuckets - 1; s > 0; --s) {
      above = merge(above, bucket[s]);
      const float cost = left[s - 1] + cluster_cost(above, ratio);
      if (cost < best_cost) {
        best_cost = cost;
        best = {axis, centroids.min()[axis] + size[axis] * static_cast<float>(s) / kBuckets};
      }
    }
  }
  return best;
}

}  // namespace

LightTree::Cluster::Cluster(const LightBounds& b)
    : center(b.box.center()),
      axis(b.axis),
      radius(0.5f * b.box.sizes().norm()),
      power(b.power),
      cos_spread(b.cos_spread),
      sin_spread(sin_from_cos(b.cos_spread)),
      cos_emission(b.cos_emission),
      two_sided(b.two_sided) {}

float LightTree::Cluster::importance(const Vec3f& p, const Vec3f* normal) const {
  const Vec3f to_light = center - p;
  const float distance2 = std::max(to_light.squaredNorm(), 1e-20f);
  const float inverse = 1.0f / std::sqrt(distance2);
  // The bounding sphere is seen within an angle b of its centre.
  const float sin_b = radius * inverse;
  if (sin_b >= 1.0f) return std::max(power / (radius * radius), 1e-30f);
  const float cos_b = sin_from_cos(sin_b);
  float result = power * inverse * inverse;

  float cos_w = -axis.dot(to_light) * inverse;
  if (two_sided) cos_w = std::abs(cos_w);
  if (cos_w <= cos_spread) {  // x = w - spread, e = x - b
    const float sin_w = sin_from_cos(cos_w);
    const float cos_x = cos_w * cos_spread + sin_w * sin_spread;
    const float sin_x = sin_w * cos_spread - cos_w * sin_spread;
    const float cos_e = cos_x > cos_b ? 1.0f : cos_x * cos_b + sin_x * sin_b;
    if (cos_e <= cos_emission) return 0.0f;
    result *= cos_e;
  }
  if (normal != nullptr) {
    const float cos_i = normal->dot(to_light) * inverse;
    const float cos_r = cos_i > cos_b ? 1.0f : cos_i * cos_b + sin_from_cos(cos_i) * sin_b;
    if (cos_r <= 0.0f) return 0.0f;
    result *= cos_r;
  }
  return std::max(result, 1e-30f);
}

LightTree::LightTree(std::vector<LightBounds> lights) {
  std::vector<std::uint32_t> items(lights.size());
  std::iota(items.begin(), items.end(), 0U);
  std::erase_if(items, [&](std::uint32_t i) { return !(lights[i].power > 0.0f); });
  leaf_of_light_.assign(lights.size(), 0xffffffffU);
  if (items.empty()) return;

  struct Task {
    std::size_t begin, end;
    std::uint32_t node;
  };
  nodes_.emplace_back();
  std::vector<Task> tasks{{0, items.size(), 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const std::span<std::uint32_t> range(items.data() + task.begin, task.end - task.begin);
    LightBounds bounds = lights[range[0]];
    Eigen::AlignedBox3f centroids(lights[range[0]].box.center());
    for (const std::uint32_t i : range.subspan(1)) {
      bounds = merge(bounds, lights[i]);
      centroids.extend(lights[i].box.center());
    }
    nodes_[task.node].cluster = Cluster(bounds);
    if (range.size() == 1) {
      nodes_[task.node].light = range[0];
      leaf_of_light_[range[0]] = task.node;
      continue;
    }
    const Split split = best_split(lights, range, centroids);
    auto middle = range.begin();
    if (split.axis >= 0)
      middle = std::partition(range.begin(), range.end(), [&](std::uint32_t i) {
        return lights[i].box.center()[split.axis] < split.position;
      });
    if (middle == range.begin() || middle == range.end())
      middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[left].parent = nodes_[left + 1].parent = task.node;
    nodes_[task.node].left = left;
    const std::size_t m = task.begin + static_cast<std::size_t>(middle - range.begin());
    tasks.push_back({task.begin, m, left});
    tasks.push_back({m, task.end, left + 1});
  }
}

std::optional<LightTree::Choice> LightTree::choose(const Vec3f& p, const Vec3f& normal,
                                                   float u) const {
  if (nodes_.empty()) return std::nullopt;
  const Vec3f* const n = normal.isZero() ? nullptr : &normal;
  std::uint32_t node = 0;
  float probability = 1.0f;
  while (nodes_[node].left != 0) {
    const std::uint32_t left = nodes_[node].left;
    const float a = nodes_[left].cluster.importance(p, n);
    const float b = nodes_[left + 1].cluster.importance(p, n);
    if (!(a + b > 0.0f)) return std::nullopt;
    const float pa = a / (a + b);
    if (u < pa) {
      u = std::min(u / pa, 0x1.fffffep-1f);
      probability *= pa;
      node = left;
    } else {
      u = std::min((u - pa) / (1.0f - pa), 0x1.fffffep-1f);
      probability *= 1.0f - pa;
      node = left + 1;
    }
  }
  if (node == 0 && !(nodes_[0].cluster.importance(p, n) > 0.0f)) return std::nullopt;
  return Choice{nodes_[node].light, probability};
}

float LightTree::probability(const Vec3f& p, const Vec3f& normal, std::uint32_t light) const {
  std::uint32_t node = light < leaf_of_light_.size() ? leaf_of_light_[light] : 0xffffffffU;
  if (node == 0xffffffffU) return 0.0f;
  const Vec3f* const n = normal.isZero() ? nullptr : &normal;
  float probability = 1.0f;
  while (node != 0) {
    const std::uint32_t left = nodes_[nodes_[node].parent].left;
    const float a = nodes_[left].cluster.importance(p, n);
    const float b = nodes_[left + 1].cluster.importance(p, n);
    if (!(a + b > 0.0f)) return 0.0f;
    probability *= (node == left ? a : b) / (a + b);
    node = nodes_[node].parent;
  }
  return probability;
}

}  // namespace atrium::scene
