#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "adjacency.h"
#include "scene/edge_parts.h"

namespace atrium::scene {
namespace {

constexpr std::size_t kMostEdges = 100'000;
constexpr int kMostSteps = 2'000;  // cells along one edge

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

/// Where p lies along the segment, if it lies on it and off its ends.
std::optional<double> place_within(const OpenEdge& s, const Vec3d& p) {
  constexpr double kOn = 1e-5;
  const Vec3d d = s.b - s.a;
  const double t = (p - s.a).dot(d) / d.squaredNorm();
  if (!(t > kOn && t < 1.0 - kOn)) return std::nullopt;
  if (!((s.a + t * d - p).norm() <= kOn * d.norm())) return std::nullopt;
  return t;
}

/// Places that lie on an edge, along it.
std::vector<std::pair<double, std::uint32_t>> places_on(const OpenEdge& s, const Grid& grid) {
  std::vector<std::pair<double, std::uint32_t>> on;
  const int steps = std::min(kMostSteps, 1 + static_cast<int>((s.b - s.a).norm() / grid.cell()));
  for (int i = 0; i <= steps; ++i)
    grid.near(s.a + (s.b - s.a) * (static_cast<double>(i) / steps),
              [&](std::uint32_t id, const Vec3d& q) {
                if (id == s.id_a || id == s.id_b) return;
                if (const auto t = place_within(s, q)) on.emplace_back(*t, id);
              });
  std::sort(on.begin(), on.end());
  on.erase(std::unique(on.begin(), on.end()), on.end());
  return on;
}

}  // namespace

std::optional<std::vector<EdgePart>> divide_edges(std::span<const OpenEdge> edges) {
  std::vector<EdgePart> parts;
  if (edges.empty()) return parts;
  if (edges.size() > kMostEdges) return std::nullopt;
  double length = 0.0;
  std::uint32_t ids = 0;
  for (const OpenEdge& s : edges) {
    length += (s.b - s.a).norm();
    ids = std::max({ids, s.id_a + 1, s.id_b + 1});
  }
  if (!(length > 0.0)) return std::nullopt;
  Grid grid(length / static_cast<double>(edges.size()));
  std::vector<bool> added(ids, false);
  for (const OpenEdge& s : edges) {
    if (!added[s.id_a]) grid.add(s.id_a, s.a);
    added[s.id_a] = true;
    if (!added[s.id_b]) grid.add(s.id_b, s.b);
    added[s.id_b] = true;
  }
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    std::uint32_t from = edges[e].id_a;
    for (const auto& [t, id] : places_on(edges[e], grid)) {
      parts.push_back({e, from, id});
      from = id;
    }
    parts.push_back({e, from, edges[e].id_b});
  }
  return parts;
}

std::optional<std::uint64_t> count_t_junctions(const std::vector<Vec3f>& positions,
                                               const std::vector<Triangle>& triangles,
                                               const Weld& weld, const Adjacency& adjacency) {
  std::vector<OpenEdge> edges;
  adjacency.for_each_edge([&](const Adjacency::EdgeUse* first, const Adjacency::EdgeUse* last) {
    if (last - first != 1) return;
    const Triangle& t = triangles[first->slot / 3];
    const std::uint32_t a = t[first->slot % 3];
    const std::uint32_t b = t[(first->slot % 3 + 1) % 3];
    edges.push_back(
        {positions[a].cast<double>(), positions[b].cast<double>(), weld.id[a], weld.id[b]});
  });
  const auto parts = divide_edges(edges);
  if (!parts) return std::nullopt;
  std::vector<bool> found(weld.count, false);
  for (const EdgePart& p : *parts)
    if (p.id_b != edges[p.edge].id_b) found[p.id_b] = true;
  return static_cast<std::uint64_t>(std::count(found.begin(), found.end(), true));
}

}  // namespace atrium::scene
