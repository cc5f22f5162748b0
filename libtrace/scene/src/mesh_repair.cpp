#include "mesh_repair.h"

#include <algorithm>
#include <cmath>

#include "adjacency.h"

namespace atrium::scene {
namespace {

Vec3d cross_of(const Mesh& mesh, const Triangle& t) {
  const Vec3d a = mesh.positions[t[0]].cast<double>();
  return (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a);
}

void drop_non_finite(Mesh& mesh, LoadReport& report) {
  std::vector<bool> bad(mesh.positions.size(), false);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    // Ray queries square coordinates: beyond 1e15 that is no number any more.
    bad[i] = !(mesh.positions[i].cwiseAbs().maxCoeff() <= 1e15f) || !mesh.positions[i].allFinite();
    if (bad[i]) ++count;
  }
  if (count == 0) return;
  report.non_finite_dropped += count;
  std::erase_if(mesh.triangles,
                [&](const Triangle& t) { return bad[t[0]] || bad[t[1]] || bad[t[2]]; });
  for (std::size_t i = 0; i < bad.size(); ++i) {
    if (bad[i]) mesh.positions[i].setZero();  // unused now
  }
}

bool is_degenerate(const Mesh& mesh, const Triangle& t) {
  const Vec3d a = mesh.positions[t[0]].cast<double>();
  const Vec3d b = mesh.positions[t[1]].cast<double>();
  const Vec3d c = mesh.positions[t[2]].cast<double>();
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  const double height = (b - a).cross(c - a).norm() / longest;  // not a number if all coincide
  const double size =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  return !(height > std::max(1e-10 * longest, 0x1p-23 * size));
}

void drop_degenerate(Mesh& mesh, LoadReport& report) {
  report.degenerate_dropped +=
      std::erase_if(mesh.triangles, [&](const Triangle& t) { return is_degenerate(mesh, t); });
}

/// A triangle by its welded corners in rising order, and which way round it runs.
struct SortedTriangle {
  std::array<std::uint32_t, 3> id;
  std::uint32_t triangle;
  bool even;
};

SortedTriangle sorted(const Triangle& t, const Weld& weld, std::size_t index) {
  SortedTriangle s{
      {weld.id[t[0]], weld.id[t[1]], weld.id[t[2]]}, static_cast<std::uint32_t>(index), true};
  const auto order = [&](std::size_t i, std::size_t j) {
    if (s.id[i] <= s.id[j]) return;
    std::swap(s.id[i], s.id[j]);
    s.even = !s.even;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return s;
}

void drop_duplicates(Mesh& mesh, const Weld& weld, bool keep_opposite, LoadReport& report) {
  std::vector<SortedTriangle> all(mesh.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = sorted(mesh.triangles[i], weld, i);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.id != b.id ? a.id < b.id : a.triangle < b.triangle;
  });
  std::vector<bool> drop(all.size(), false);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < all.size();) {
    bool seen[2] = {false, false};
    std::size_t j = i;
    for (; j < all.size() && all[j].id == all[i].id; ++j) {
      const bool twin = keep_opposite ? seen[all[j].even ? 1 : 0] : j > i;
      seen[all[j].even ? 1 : 0] = true;
      drop[all[j].triangle] = twin;
      if (twin) ++count;
    }
    i = j;
  }
  if (count == 0) return;
  report.duplicate_dropped += count;
  std::size_t index = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return drop[index++]; });
}

// ---- winding ----

/// One part of a mesh, walked across edges of two triangles.
struct Walk {
  std::vector<std::uint32_t> triangles;
  bool closed = true;  ///< no edge with one or more than two triangles
  bool orientable = true;
  bool consistent = true;  ///< as given
};

/// Walks from `seed`; flip[t] says which triangles to turn so that all agree with the seed.
Walk walk_part(const Mesh& mesh, const Weld& weld, const Adjacency& adjacency, std::uint32_t seed,
               std::vector<std::int8_t>& flip) {
  const auto forward = [&](std::uint32_t slot) {
    const Triangle& t = mesh.triangles[slot / 3];
    return weld.id[t[slot % 3]] < weld.id[t[(slot % 3 + 1) % 3]];
  };
  Walk walk;
  walk.triangles.push_back(seed);
  flip[seed] = 0;
  for (std::size_t i = 0; i < walk.triangles.size(); ++i) {
    const std::uint32_t t = walk.triangles[i];
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint32_t other = adjacency.across[3 * t + e];
      if (other == Adjacency::kNone) {
        walk.closed = false;
        continue;
      }
      const bool clash = forward(3 * t + e) == forward(other);  // neighbours run opposite ways
      const auto wanted = static_cast<std::int8_t>(clash ? 1 - flip[t] : flip[t]);
      if (clash) walk.consistent = false;
      if (flip[other / 3] < 0) {
        flip[other / 3] = wanted;
        walk.triangles.push_back(other / 3);
      } else if (flip[other / 3] != wanted) {
        walk.orientable = false;
      }
    }
  }
  return walk;
}

/// Six times the volume enclosed, about a corner of the part for precision.
double volume6(const Mesh& mesh, const std::vector<std::uint32_t>& triangles,
               const std::vector<std::int8_t>& flip) {
  const Vec3d origin = mesh.positions[mesh.triangles[triangles[0]][0]].cast<double>();
  double sum = 0.0;
  for (const std::uint32_t i : triangles) {
    const Triangle& t = mesh.triangles[i];
    const double v = (mesh.positions[t[0]].cast<double>() - origin).dot(cross_of(mesh, t));
    sum += flip[i] > 0 ? -v : v;
  }
  return sum;
}

void turn(Triangle& t, LoadReport& report) {
  std::swap(t[1], t[2]);
  ++report.triangles_flipped;
}

/// Closed parts whose triangles disagree are wound outwards.
void make_winding_consistent(Mesh& mesh, const Weld& weld, const Adjacency& adjacency,
                             LoadReport& report) {
  std::vector<std::int8_t> flip(mesh.triangles.size(), -1);
  std::vector<std::uint32_t> to_turn;
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (flip[seed] >= 0) continue;
    const Walk walk = walk_part(mesh, weld, adjacency, seed, flip);
    if (!walk.closed || !walk.orientable || walk.consistent) continue;
    const bool inside_out = volume6(mesh, walk.triangles, flip) < 0.0;
    for (const std::uint32_t t : walk.triangles) {
      if ((flip[t] > 0) != inside_out) to_turn.push_back(t);
    }
  }
  for (const std::uint32_t t : to_turn) turn(mesh.triangles[t], report);
}

/// Every edge is run along as often one way as the other.
bool is_closed(const std::vector<Triangle>& triangles, const Weld& weld) {
  const Adjacency adjacency = find_adjacency(triangles, weld);
  bool closed = !triangles.empty();
  adjacency.for_each_edge([&](const Adjacency::EdgeUse* first, const Adjacency::EdgeUse* last) {
    const auto forward = std::count_if(first, last, [](const auto& use) { return use.forward; });
    if (2 * forward != last - first) closed = false;
  });
  return closed;
}

/// A body whose whole surface points inwards is turned inside out.
void turn_inside_out_solid(Mesh& mesh, LoadReport& report) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  if (!(volume6(mesh, all, std::vector<std::int8_t>(all.size(), 0)) < 0.0)) return;
  for (Triangle& t : mesh.triangles) turn(t, report);
}

// ---- attributes ----

void repair_normals(Mesh& mesh) {
  std::vector<std::uint32_t> broken;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const double length = mesh.normals[i].cast<double>().norm();
    if (length > 1e-20 && std::isfinite(length)) {
      mesh.normals[i] = (mesh.normals[i].cast<double>() / length).cast<float>();
    } else {
      broken.push_back(static_cast<std::uint32_t>(i));
      mesh.normals[i].setZero();
    }
  }
  if (broken.empty()) return;
  std::vector<Vec3d> sum(mesh.positions.size(), Vec3d::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d n = cross_of(mesh, t);  // weighted by area
    for (const std::uint32_t v : t) sum[v] += n;
  }
  for (const std::uint32_t v : broken) {
    const double length = sum[v].norm();
    mesh.normals[v] = length > 0.0 ? Vec3f((sum[v] / length).cast<float>()) : Vec3f::UnitZ();
  }
}

void repair_other_attributes(Mesh& mesh) {
  for (Vec2f& uv : mesh.uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  for (Vec3f& c : mesh.colors) {
    c = c.allFinite() ? Vec3f(c.cwiseMax(0.0f).cwiseMin(1.0f)) : Vec3f::Ones();
  }
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  std::vector<T> out(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) out[i] = values[kept[i]];
  values = std::move(out);
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> to(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) to[v] = 1;
  }
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] == 0) continue;
    to[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  if (kept.size() == mesh.positions.size()) return;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = to[v];
  }
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.colors, kept);
}

}  // namespace

void repair_mesh(Mesh& mesh, const RepairRules& rules, LoadReport& report) {
  drop_non_finite(mesh, report);
  if (rules.repair) drop_degenerate(mesh, report);
  drop_unused_vertices(mesh);
  const Weld weld = weld_positions(mesh.positions);
  if (rules.repair) {
    report.vertices_welded += mesh.positions.size() - weld.count;
    drop_duplicates(mesh, weld, rules.one_sided_emission || rules.solid, report);
    const Adjacency adjacency = find_adjacency(mesh.triangles, weld);
    report.non_manifold_edges += adjacency.non_manifold;
    make_winding_consistent(mesh, weld, adjacency, report);
    const auto junctions = count_t_junctions(mesh.positions, mesh.triangles, weld, adjacency);
    report.t_junctions += junctions.value_or(0);
    if (!junctions) {
      report.warnings.push_back("mesh '" + mesh.name +
                                "': too many boundary edges to look for T-junctions");
    }
  }
  mesh.closed = is_closed(mesh.triangles, weld);
  if (rules.repair && rules.solid && mesh.closed) turn_inside_out_solid(mesh, report);
  if (mesh.closed) ++report.meshes_closed;
  if (mesh.normals.empty()) ++report.normals_made;
  repair_normals(mesh);
  repair_other_attributes(mesh);
}

void add_report(LoadReport& sum, const LoadReport& part) {
  sum.triangles_read += part.triangles_read;
  sum.degenerate_dropped += part.degenerate_dropped;
  sum.duplicate_dropped += part.duplicate_dropped;
  sum.vertices_welded += part.vertices_welded;
  sum.non_finite_dropped += part.non_finite_dropped;
  sum.triangles_flipped += part.triangles_flipped;
  sum.non_manifold_edges += part.non_manifold_edges;
  sum.t_junctions += part.t_junctions;
  sum.coplanar_twins += part.coplanar_twins;
  sum.meshes_closed += part.meshes_closed;
  sum.meshes_shared += part.meshes_shared;
  sum.normals_made += part.normals_made;
  sum.panes_recognised += part.panes_recognised;
  sum.subdivision_triangles += part.subdivision_triangles;
  sum.warnings.insert(sum.warnings.end(), part.warnings.begin(), part.warnings.end());
}

}  // namespace atrium::scene
