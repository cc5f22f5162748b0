#include "facets.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "scene/edge_parts.h"

namespace atrium::radiosity {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Neighbours = std::vector<std::array<std::uint32_t, 3>>;  // across edges 01, 12, 20

struct Bits3 {
  std::array<std::uint32_t, 3> v;
  bool operator==(const Bits3&) const = default;
};
struct HashBits3 {
  std::size_t operator()(const Bits3& b) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (const std::uint32_t x : b.v) h = (h ^ x) * 0xff51afd7ed558ccdULL, h ^= h >> 32;
    return h;
  }
};

Bits3 bits(const Vec3f& p) {
  Bits3 b{};
  for (int i = 0; i < 3; ++i) {
    const float x = p[i] + 0.0f;  // -0 and 0 are one place
    std::memcpy(&b.v[static_cast<std::size_t>(i)], &x, sizeof x);
  }
  return b;
}

HalfEdgeMesh::Point to_point(const Vec3f& p) { return {p.x(), p.y(), p.z()}; }

/// What the growth needs to know about a triangle.
struct Geometry {
  std::vector<Vec3d> normal;  // unit; zero for triangles that take no part
  std::vector<double> area;
};

Geometry measure(const Corners& corners) {
  Geometry g;
  g.normal.resize(corners.size(), Vec3d::Zero());
  g.area.resize(corners.size(), 0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = corners[i][0].cast<double>();
    const Vec3d n = (corners[i][1].cast<double>() - a).cross(corners[i][2].cast<double>() - a);
    const double twice = n.norm();
    if (!(twice > 0.0) || !std::isfinite(twice)) continue;
    g.normal[i] = n / twice;
    g.area[i] = 0.5 * twice;
  }
  return g;
}

/// A library does not print; OpenMesh's error stream is one for the whole process.
void silence_openmesh() {
  static const bool once = [] {
    omerr().disable();
    return true;
  }();
  static_cast<void>(once);
}

/// OpenMesh refuses a face that would make an edge or vertex non-manifold: such a face gets
/// vertices of its own, which cuts the surface open there.
Neighbours adjacency(const Corners& corners, const Geometry& geometry) {
  HalfEdgeMesh mesh;
  mesh.reserve(corners.size(), corners.size() * 2, corners.size());
  std::unordered_map<Bits3, HalfEdgeMesh::VertexHandle, HashBits3> welded;
  welded.reserve(corners.size());
  std::vector<HalfEdgeMesh::FaceHandle> face_of(corners.size());
  std::vector<std::uint32_t> triangle_of;
  silence_openmesh();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (geometry.area[i] == 0.0) continue;
    std::array<HalfEdgeMesh::VertexHandle, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [it, fresh] = welded.try_emplace(bits(corners[i][k]));
      if (fresh) it->second = mesh.add_vertex(to_point(corners[i][k]));
      v[k] = it->second;
    }
    HalfEdgeMesh::FaceHandle f = mesh.add_face(v[0], v[1], v[2]);
    if (!f.is_valid()) {
      for (std::size_t k = 0; k < 3; ++k) v[k] = mesh.add_vertex(to_point(corners[i][k]));
      f = mesh.add_face(v[0], v[1], v[2]);
    }
    face_of[i] = f;
    triangle_of.push_back(static_cast<std::uint32_t>(i));
  }
  Neighbours result(corners.size(), {kNone, kNone, kNone});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!face_of[i].is_valid()) continue;
    // The first half-edge of a face ends in its first corner's successor; order is irrelevant here
    // but for the boundary test, which asks for "no neighbour in the facet".
    auto h = mesh.halfedge_handle(face_of[i]);
    for (std::size_t k = 0; k < 3; ++k, h = mesh.next_halfedge_handle(h)) {
      const auto other = mesh.opposite_face_handle(h);
      const auto from = mesh.point(mesh.from_vertex_handle(h));
      const Vec3f p(from[0], from[1], from[2]);
      const std::size_t edge = p == corners[i][0] ? 0 : p == corners[i][1] ? 1 : 2;
      if (other.is_valid()) result[i][edge] = triangle_of[static_cast<std::size_t>(other.idx())];
    }
  }
  return result;
}

/// What lies across the open edges that meet others at T-junctions: by 3 * triangle + edge, the
/// triangle across each of the edge's parts, or kNone.
using PartNeighbours = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

/// Only within a plane: there a T-junction is a matter of triangulation.
PartNeighbours across_t_junctions(const Corners& corners, const Geometry& geometry,
                                  const Neighbours& neighbours) {
  constexpr double kFlat = 1.0 - 1e-6;
  std::unordered_map<Bits3, std::uint32_t, HashBits3> welded;
  std::vector<scene::OpenEdge> edges;
  std::vector<std::uint32_t> slot;
  for (std::uint32_t t = 0; t < corners.size(); ++t) {
    if (geometry.area[t] == 0.0) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (neighbours[t][k] != kNone) continue;
      const Vec3f& a = corners[t][k];
      const Vec3f& b = corners[t][(k + 1) % 3];
      const auto id = [&](const Vec3f& p) {
        return welded.try_emplace(bits(p), static_cast<std::uint32_t>(welded.size())).first->second;
      };
      const std::uint32_t from = id(a);
      edges.push_back({a.cast<double>(), b.cast<double>(), from, id(b)});
      slot.push_back(3 * t + k);
    }
  }
  PartNeighbours result;
  const auto parts = scene::divide_edges(edges);
  if (!parts) return result;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> uses;
  std::vector<std::uint32_t> count(edges.size(), 0);
  for (std::uint32_t p = 0; p < parts->size(); ++p) {
    uses[std::minmax((*parts)[p].id_a, (*parts)[p].id_b)].push_back(p);
    ++count[(*parts)[p].edge];
  }
  for (const scene::EdgePart& p : *parts) {
    const auto& both = uses[std::minmax(p.id_a, p.id_b)];
    std::uint32_t other = kNone;
    if (both.size() == 2) {
      const scene::EdgePart& q =
          (*parts)[both[0]].edge == p.edge ? (*parts)[both[1]] : (*parts)[both[0]];
      const std::uint32_t across = slot[q.edge] / 3;
      const bool divided = count[p.edge] > 1 || count[q.edge] > 1;
      if (divided && q.id_a == p.id_b &&
          geometry.normal[across].dot(geometry.normal[slot[p.edge] / 3]) > kFlat)
        other = across;
    }
    result[slot[p.edge]].push_back(other);
  }
  return result;
}

class Grower {
 public:
  Grower(const Corners& corners, const FacetOptions& options)
      : corners_(corners),
        options_(options),
        geometry_(measure(corners)),
        neighbours_(adjacency(corners, geometry_)),
        part_neighbours_(across_t_junctions(corners, geometry_, neighbours_)),
        facet_of_(corners.size(), kNone) {}

  std::vector<Facet> grow_all() {
    std::vector<std::uint32_t> order(corners_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return geometry_.area[a] > geometry_.area[b];
    });
    std::vector<Facet> facets;
    for (const std::uint32_t seed : order) {
      if (facet_of_[seed] != kNone || geometry_.area[seed] == 0.0) continue;
      facets.push_back(grow(seed, static_cast<std::uint32_t>(facets.size())));
    }
    return facets;
  }

 private:
  /// First against the seed's normal, then against the mean of what that found.
  Facet grow(std::uint32_t seed, std::uint32_t id) {
    Facet facet;
    facet.normal = geometry_.normal[seed];
    flood(facet, seed, id);
    const Vec3d mean = mean_normal(facet);
    if (mean.dot(facet.normal) < 1.0 - 1e-9 && mean.dot(facet.normal) >= options_.cos_cone) {
      for (const std::uint32_t t : facet.triangles) facet_of_[t] = kNone;
      facet.triangles.clear();
      facet.normal = mean;
      flood(facet, seed, id);
    }
    finish(facet, id);
    return facet;
  }

  void flood(Facet& facet, std::uint32_t seed, std::uint32_t id) {
    const Vec3d origin =
        (corners_[seed][0] + corners_[seed][1] + corners_[seed][2]).cast<double>() / 3.0;
    facet.triangles.push_back(seed);
    facet_of_[seed] = id;
    for (std::size_t next = 0; next < facet.triangles.size(); ++next)
      for (std::uint32_t k = 0; k < 3; ++k)
        visit_across(facet.triangles[next], k, [&](std::uint32_t t) {
          if (t == kNone || facet_of_[t] != kNone || !fits(facet, origin, t)) return;
          facet_of_[t] = id;
          facet.triangles.push_back(t);
        });
  }

  /// f(triangle or kNone) for all that lies across an edge.
  template <class F>
  void visit_across(std::uint32_t t, std::uint32_t k, F&& f) const {
    const auto it =
        neighbours_[t][k] == kNone ? part_neighbours_.find(3 * t + k) : part_neighbours_.end();
    if (it == part_neighbours_.end()) {
      f(neighbours_[t][k]);
      return;
    }
    for (const std::uint32_t other : it->second) f(other);
  }

  bool fits(const Facet& facet, const Vec3d& origin, std::uint32_t t) const {
    if (!(geometry_.normal[t].dot(facet.normal) >= options_.cos_cone)) return false;
    return std::all_of(corners_[t].begin(), corners_[t].end(), [&](const Vec3f& p) {
      return std::abs((p.cast<double>() - origin).dot(facet.normal)) <= options_.max_height;
    });
  }

  Vec3d mean_normal(const Facet& facet) const {
    Vec3d sum = Vec3d::Zero();
    for (const std::uint32_t t : facet.triangles) sum += geometry_.area[t] * geometry_.normal[t];
    return sum.normalized();
  }

  void finish(Facet& facet, std::uint32_t id) const {
    double longest = -1.0;
    for (const std::uint32_t t : facet.triangles) {
      const auto& c = corners_[t];
      facet.area += geometry_.area[t];
      facet.centre += geometry_.area[t] * (c[0] + c[1] + c[2]).cast<double>() / 3.0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        bool inside = true;
        visit_across(t, k, [&](std::uint32_t other) {
          inside = inside && other != kNone && facet_of_[other] == id;
        });
        if (inside) continue;
        Vec3d edge = (c[(k + 1) % 3] - c[k]).cast<double>();
        edge -= edge.dot(facet.normal) * facet.normal;
        if (edge.squaredNorm() <= longest * (1.0 + 1e-6)) continue;
        longest = edge.squaredNorm();
        facet.axis = edge;
      }
    }
    facet.centre /= facet.area;
    facet.axis = longest > 0.0 ? Vec3d(facet.axis.normalized()) : facet.normal.unitOrthogonal();
  }

  const Corners& corners_;
  FacetOptions options_;
  Geometry geometry_;
  Neighbours neighbours_;
  PartNeighbours part_neighbours_;
  std::vector<std::uint32_t> facet_of_;
};

using ClumpKey = std::array<std::int64_t, 4>;

ClumpKey clump_key(const Facet& f, double voxel) {
  int axis = 0;
  f.normal.cwiseAbs().maxCoeff(&axis);
  ClumpKey key{axis * 2 + (f.normal[axis] < 0.0 ? 1 : 0), 0, 0, 0};
  for (int i = 0; i < 3; ++i)
    key[static_cast<std::size_t>(i) + 1] =
        static_cast<std::int64_t>(std::floor(f.centre[i] / voxel));
  return key;
}

void absorb(Facet& clump, const Facet& f) {
  const double area = clump.area + f.area;
  clump.centre = (clump.centre * clump.area + f.centre * f.area) / area;
  clump.normal = (clump.normal * clump.area + f.normal * f.area).normalized();
  clump.area = area;
  clump.triangles.insert(clump.triangles.end(), f.triangles.begin(), f.triangles.end());
  clump.axis = clump.normal.unitOrthogonal();
  clump.clump = true;
}

}  // namespace

std::vector<Facet> grow_facets(const Corners& corners, const FacetOptions& options) {
  return Grower(corners, options).grow_all();
}

std::vector<Facet> merge_small_facets(std::vector<Facet> facets, double cell, double voxel) {
  std::vector<Facet> result;
  std::map<ClumpKey, std::size_t> clumps;
  for (Facet& f : facets) {
    if (f.area >= cell * cell) {
      result.push_back(std::move(f));
      continue;
    }
    const auto [it, fresh] = clumps.try_emplace(clump_key(f, voxel), result.size());
    if (fresh)
      result.push_back(std::move(f));
    else
      absorb(result[it->second], f);
  }
  return result;
}

}  // namespace atrium::radiosity
