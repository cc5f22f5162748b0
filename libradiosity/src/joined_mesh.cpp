#include "joined_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>

#include <unsupported/Eigen/BVH>

namespace atrium::radiosity {
namespace {

using scene::SurfaceField;
using Box = Eigen::AlignedBox3f;

/// Finds places within a tolerance of each other.
class Welder {
 public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {}

  /// The place of a point: the first one within the tolerance, or a new one.
  std::uint32_t place(const Vec3f& point) {
    const Vec3d p = point.cast<double>();
    const Key low = key(p.array() - tolerance_);
    const Key high = key(p.array() + tolerance_);
    for (std::int64_t z = low[2]; z <= high[2]; ++z)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          const auto it = voxels_.find({x, y, z});
          if (it == voxels_.end()) continue;
          for (std::uint32_t k = it->second; k != kNone; k = next_[k])
            if ((places_[k].cast<double>() - p).norm() <= tolerance_) return k;
        }
    const auto [first, added] = voxels_.try_emplace(key(p), kNone);
    next_.push_back(first->second);
    first->second = static_cast<std::uint32_t>(places_.size());
    places_.push_back(point);
    return static_cast<std::uint32_t>(places_.size() - 1);
  }

  [[nodiscard]] const std::vector<Vec3f>& places() const { return places_; }

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = 0x9e3779b97f4a7c15ULL;
      for (const std::int64_t x : k)
        h = (h ^ static_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdULL, h ^= h >> 32;
      return h;
    }
  };
  [[nodiscard]] Key key(const Vec3d& p) const {
    const auto at = [&](double x) {
      return static_cast<std::int64_t>(std::floor(x / (4.0 * tolerance_)));
    };
    return {at(p.x()), at(p.y()), at(p.z())};
  }

  double tolerance_;
  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::unordered_map<Key, std::uint32_t, Hash> voxels_;  // the place that came last
  std::vector<std::uint32_t> next_;  // by place: one of the same voxel, or kNone
  std::vector<Vec3f> places_;
};

/// Edges that two polygons pass in opposite ways: nothing lies between their ends that either would
/// have to meet.
class SharedEdges {
 public:
  explicit SharedEdges(const std::vector<std::vector<std::uint32_t>>& polygons) {
    for (const std::vector<std::uint32_t>& corners : polygons)
      for (std::size_t i = 0; i < corners.size(); ++i)
        passed_.push_back(key(corners[i], corners[(i + 1) % corners.size()]));
    std::sort(passed_.begin(), passed_.end());
  }
  [[nodiscard]] bool contains(std::uint32_t from, std::uint32_t to) const {
    return std::binary_search(passed_.begin(), passed_.end(), key(to, from));
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32U | to;
  }
  std::vector<std::uint64_t> passed_;
};

/// Places inside an edge, in the order from its start.
struct OnEdge {
  const std::vector<Vec3f>& places;
  std::uint32_t from, to;
  double tolerance;
  std::vector<std::pair<double, std::uint32_t>> found;

  [[nodiscard]] Box box() const {
    Box b(places[from]);
    b.extend(places[to]);
    b.min().array() -= static_cast<float>(tolerance);
    b.max().array() += static_cast<float>(tolerance);
    return b;
  }
  bool intersectVolume(const Box& b) const { return b.intersects(box()); }
  bool intersectObject(std::uint32_t place) {
    const Vec3d a = places[from].cast<double>();
    const Vec3d d = places[to].cast<double>() - a;
    const Vec3d p = places[place].cast<double>() - a;
    const double t = p.dot(d) / d.squaredNorm();
    if (place != from && place != to && t > 0.0 && t < 1.0 && (p - t * d).norm() <= tolerance)
      found.emplace_back(t, place);
    return false;
  }
};

class Joiner {
 public:
  Joiner(const scene::Scene& scene, const Elements& elements, const JoinOptions& options)
      : scene_(scene),
        elements_(elements),
        layout_(elements.layout),
        cos_crease_(std::cos(options.crease_angle_deg * std::numbers::pi / 180.0)) {
    element_of_.resize(elements.pieces.size());
    for (std::uint32_t e = 0; e + 1 < elements.first_piece.size(); ++e)
      for (std::uint32_t p = elements.first_piece[e]; p < elements.first_piece[e + 1]; ++p)
        element_of_[p] = e;
  }

  JoinedMesh join() {
    mesh_.first_corner.push_back(0);
    const std::size_t count = elements_.pieces.size();
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
      const scene::ObjectId object = elements_.pieces[begin].object;
      while (end < count && elements_.pieces[end].object == object) ++end;
      join_object(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
    }
    return std::move(mesh_);
  }

 private:
  void join_object(std::uint32_t begin, std::uint32_t end) {
    Welder welder(tolerance(begin, end));
    std::vector<std::vector<std::uint32_t>> polygons(end - begin);
    for (std::uint32_t p = begin; p < end; ++p)
      for (const Vec3f& c : elements_.pieces[p].corners)
        polygons[p - begin].push_back(welder.place(c));
    const std::size_t first_polygon = mesh_.piece.size();
    insert_places(polygons, begin, welder.places(), tolerance(begin, end));
    share_points(first_polygon, welder.places());
  }

  /// What float coordinates and the slack of grid lines leave of a position.
  double tolerance(std::uint32_t begin, std::uint32_t end) const {
    double reach = 0.0;
    double cell = 0.0;
    for (std::uint32_t p = begin; p < end; ++p) {
      for (const Vec3f& c : elements_.pieces[p].corners)
        reach = std::max(reach, static_cast<double>(c.cwiseAbs().maxCoeff()));
      const std::uint32_t e = element_of_[p];
      const bool clump = layout_.facets[layout_.element_facet[e]].clump != 0;
      if (!clump)
        cell = std::max(cell, std::ldexp(static_cast<double>(layout_.element_size(e)),
                                         layout_.element_level[e]));
    }
    return std::max({0x1p-21 * reach, 2e-6 * cell, 1e-30});
  }

  void insert_places(const std::vector<std::vector<std::uint32_t>>& polygons,
                     std::uint32_t first_piece, const std::vector<Vec3f>& places,
                     double tolerance) {
    std::vector<std::uint32_t> numbers(places.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    std::vector<Box> boxes;
    boxes.reserve(places.size());
    for (const Vec3f& p : places) boxes.emplace_back(p);
    Eigen::KdBVH<float, 3, std::uint32_t> tree;
    tree.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
    const SharedEdges shared(polygons);
    for (std::size_t k = 0; k < polygons.size(); ++k) {
      const std::vector<std::uint32_t>& corners = polygons[k];
      const std::size_t first = place_.size();
      for (std::size_t i = 0; i < corners.size(); ++i) {
        OnEdge edge{places, corners[i], corners[(i + 1) % corners.size()], tolerance, {}};
        if (edge.from == edge.to) continue;
        place_.push_back(edge.from);
        if (shared.contains(edge.from, edge.to)) continue;
        Eigen::BVIntersect(tree, edge);
        std::sort(edge.found.begin(), edge.found.end());
        for (const auto& [t, place] : edge.found) place_.push_back(place);
      }
      std::vector<std::uint32_t> distinct(place_.begin() + static_cast<std::ptrdiff_t>(first),
                                          place_.end());
      std::sort(distinct.begin(), distinct.end());
      if (place_.size() - first < 3 ||
          std::adjacent_find(distinct.begin(), distinct.end()) != distinct.end()) {
        place_.resize(first);  // collapsed
        continue;
      }
      mesh_.piece.push_back(first_piece + static_cast<std::uint32_t>(k));
      mesh_.first_corner.push_back(static_cast<std::uint32_t>(place_.size()));
    }
  }

  /// A polygon's corner at a place, with the places before and after it.
  struct Use {
    std::uint32_t place, corner, polygon, before, after;
  };

  void share_points(std::size_t first_polygon, const std::vector<Vec3f>& places) {
    std::vector<Use> uses;
    for (std::size_t p = first_polygon; p < mesh_.piece.size(); ++p) {
      const std::uint32_t begin = mesh_.first_corner[p];
      const std::uint32_t count = mesh_.first_corner[p + 1] - begin;
      for (std::uint32_t i = 0; i < count; ++i)
        uses.push_back({place_[begin + i], begin + i, static_cast<std::uint32_t>(p),
                        place_[begin + (i + count - 1) % count], place_[begin + (i + 1) % count]});
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
      return std::tie(a.place, a.corner) < std::tie(b.place, b.corner);
    });
    mesh_.point.resize(place_.size());
    for (auto begin = uses.begin(); begin != uses.end();) {
      const auto end =
          std::find_if(begin, uses.end(), [&](const Use& u) { return u.place != begin->place; });
      number_points(std::span(begin, end), places[begin->place]);
      begin = end;
    }
  }

  void number_points(std::span<const Use> uses, const Vec3f& position) {
    std::vector<std::size_t> root(uses.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (root[i] != i) i = root[i];
      return i;
    };
    for (std::size_t i = 1; i < uses.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const std::size_t a = find(i);
        const std::size_t b = find(j);
        if (a != b && continues(uses[i], uses[j], position)) root[std::max(a, b)] = std::min(a, b);
      }
    std::vector<std::uint32_t> point(uses.size());
    for (std::size_t i = 0; i < uses.size(); ++i) {
      const std::size_t r = find(i);
      if (r == i) {
        point[i] = static_cast<std::uint32_t>(mesh_.position.size());
        mesh_.position.push_back(position);
      }
      mesh_.point[uses[i].corner] = point[r];
    }
  }

  bool continues(const Use& a, const Use& b, const Vec3f& position) const {
    const std::uint32_t piece_a = mesh_.piece[a.polygon];
    const std::uint32_t piece_b = mesh_.piece[b.polygon];
    const std::uint32_t facet_a = layout_.element_facet[element_of_[piece_a]];
    const std::uint32_t facet_b = layout_.element_facet[element_of_[piece_b]];
    if (facet_a == facet_b) return true;
    if (a.before != b.after && a.after != b.before) return false;
    const SurfaceField::Facet& f = layout_.facets[facet_a];
    const SurfaceField::Facet& g = layout_.facets[facet_b];
    const auto normal = [](const SurfaceField::Facet& x) {
      return Vec3f(x.axis_u.cross(x.axis_v).normalized());
    };
    constexpr float kOnePlane = 0.9998f;               // 1 degree
    const bool clumps = f.clump != 0 && g.clump != 0;  // whose own planes mean little
    if (!clumps && (f.clump != 0 || g.clump != 0 || normal(f).dot(normal(g)) > kOnePlane))
      return false;
    const scene::SurfacePoint p = point_of(piece_a, position);
    const scene::SurfacePoint q = point_of(piece_b, position);
    return static_cast<double>(p.ng.dot(q.ng)) >= cos_crease_ && p.ns.dot(q.ns) > kOnePlane;
  }

  scene::SurfacePoint point_of(std::uint32_t piece, const Vec3f& position) const {
    const ElementPiece p = elements_.pieces[piece];
    const Vec2f uv = barycentric(scene_, p, position);
    return scene::surface_point(scene_, p.object, p.triangle, uv.x(), uv.y());
  }

  const scene::Scene& scene_;
  const Elements& elements_;
  const SurfaceField& layout_;
  double cos_crease_;
  std::vector<std::uint32_t> element_of_;  // by piece
  std::vector<std::uint32_t> place_;       // by corner of mesh_
  JoinedMesh mesh_;
};

}  // namespace

JoinedMesh join_pieces(const scene::Scene& scene, const Elements& elements,
                       const JoinOptions& options) {
  return Joiner(scene, elements, options).join();
}

Vec2f barycentric(const scene::Scene& scene, const ElementPiece& piece, const Vec3f& point) {
  const auto c = scene.corners(piece.object, piece.triangle);
  const Vec3d e1 = (c[1] - c[0]).cast<double>();
  const Vec3d e2 = (c[2] - c[0]).cast<double>();
  const Vec3d d = (point - c[0]).cast<double>();
  const Vec3d n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0.0)) return {1.0f / 3.0f, 1.0f / 3.0f};
  return {static_cast<float>(d.cross(e2).dot(n) / n2), static_cast<float>(e1.cross(d).dot(n) / n2)};
}

}  // namespace atrium::radiosity
