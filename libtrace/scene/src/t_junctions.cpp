#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "adjacency.h"

namespace atrium::scene {
namespace {

constexpr std::size_t kMostEdges = 100'000;
constexpr int kMostSteps = 2'000;  // cells along one edge

struct Segment {
  Vec3d a, b;
  std::uint32_t id_a, id_b;
};

std::vector<Segment> boundary(const std::vector<Vec3f>& positions,
                              const std::vector<Triangle>& triangles, const Weld& weld,
                              const Adjacency& adjacency) {
  std::vector<Segment> out;
  adjacency.for_each_edge([&](const Adjacency::EdgeUse* first, const Adjacency::EdgeUse* last) {
    if (last - first != 1) return;
    const Triangle& t = triangles[first->slot / 3];
    const std::uint32_t a = t[first->slot % 3];
    const std::uint32_t b = t[(first->slot % 3 + 1) % 3];
    out.push_back(
        {positions[a].cast<double>(), positions[b].cast<double>(), weld.id[a], weld.id[b]});
  });
  return out;
}

/// Boundary vertices in the cells of a grid.
class Grid {
 public:
  explicit Grid(double cell) : cell_(cell) {}
  void add(std::uint32_t id, const Vec3d& p) { cells_[key(cell_of(p))].push_back({id, p}); }
  [[nodiscard]] double cell() const { return cell_; }
  /// Calls f(id, position) for the vertices of the 27 cells round p.
  template <class F>
  void near(const Vec3d& p, F&& f) const {
    const Eigen::Vector3i c = cell_of(p);
    for (int i = 0; i < 27; ++i) {
      const auto it = cells_.find(key(c + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
      if (it == cells_.end()) continue;
      for (const auto& [id, q] : it->second) f(id, q);
    }
  }

 private:
  [[nodiscard]] Eigen::Vector3i cell_of(const Vec3d& p) const {
    return (p / cell_).array().floor().cwiseMax(-1e9).cwiseMin(1e9).cast<int>();
  }
  static std::uint64_t key(const Eigen::Vector3i& c) {
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ static_cast<std::uint32_t>(c[k])) * 0x9E3779B97F4A7C15u;
    return h;
  }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<std::uint32_t, Vec3d>>> cells_;
};

/// Is p inside the segment, well away from its ends, and on it to 1e-5 of its length?
bool lies_within(const Segment& s, const Vec3d& p) {
  const Vec3d d = s.b - s.a;
  const double t = (p - s.a).dot(d) / d.squaredNorm();
  if (!(t > 1e-3 && t < 1.0 - 1e-3)) return false;
  return (s.a + t * d - p).norm() <= 1e-5 * d.norm();
}

}  // namespace

std::optional<std::uint64_t> count_t_junctions(const std::vector<Vec3f>& positions,
                                               const std::vector<Triangle>& triangles,
                                               const Weld& weld, const Adjacency& adjacency) {
  const std::vector<Segment> edges = boundary(positions, triangles, weld, adjacency);
  if (edges.empty()) return 0;
  if (edges.size() > kMostEdges) return std::nullopt;
  double length = 0.0;
  for (const Segment& s : edges) length += (s.b - s.a).norm();
  Grid grid(length / static_cast<double>(edges.size()));
  std::vector<bool> added(weld.count, false);
  for (const Segment& s : edges) {
    if (!added[s.id_a]) grid.add(s.id_a, s.a);
    if (!added[s.id_b]) grid.add(s.id_b, s.b);
    added[s.id_a] = added[s.id_b] = true;
  }
  std::vector<bool> found(weld.count, false);
  for (const Segment& s : edges) {
    const int steps = std::min(kMostSteps, 1 + static_cast<int>((s.b - s.a).norm() / grid.cell()));
    for (int i = 0; i <= steps; ++i) {
      const Vec3d p = s.a + (s.b - s.a) * (static_cast<double>(i) / steps);
      grid.near(p, [&](std::uint32_t id, const Vec3d& q) {
        if (id != s.id_a && id != s.id_b && !found[id] && lies_within(s, q)) found[id] = true;
      });
    }
  }
  return static_cast<std::uint64_t>(std::count(found.begin(), found.end(), true));
}

}  // namespace atrium::scene
