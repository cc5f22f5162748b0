#include "division.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "barrier_directions.h"
#include "open_edges.h"
#include "polygon.h"

namespace atrium::radiosity {
namespace {

using scene::SurfaceField;
constexpr std::uint32_t kNone = SurfaceField::kNone;
constexpr std::uint32_t kCut = SurfaceField::kCut;
// In cells: facets below the first are not divided, regions below the second get no element. Where
// models are full of things that touch and overlap, slivers would outnumber all other elements.
constexpr double kSmallestFacet = 1e-2;
constexpr double kSmallestRegion = 1e-3;
constexpr double kGap = 0.02;        // cells; narrower gaps between barriers connect nothing
constexpr double kWallLength = 2.0;  // cells; longer barriers part what is beside their ends, too
constexpr double kFreeLength = 0.5;  // cells; longer barriers that end free part what is near them
constexpr std::size_t kMostFree = 64;   // of one facet; more stay as they are
constexpr double kOutlineLength = 0.1;  // cells; shorter pieces of covers' outlines cut nothing
constexpr double kHang = 0.75;          // cells; what hangs lower keeps light from what is below
constexpr double kHangLength = 1.0;     // cells; the longest edge of what hangs, at least
constexpr std::size_t kMostBarriers = 4096;  // of one facet; of large objects first

/// A corner, and which line the edge to the next one lies on.
struct Vertex {
  Vec3d p;
  std::uint32_t line = kNone;
};

/// A convex part of one of the facet's triangles.
struct Fragment {
  std::vector<Vertex> corners;
  std::uint32_t triangle = 0;  // position in the facet's triangles
};

/// A line that parts fragments: an edge between two triangles or a cut through one.
struct Line {
  Vec3d point, direction;
};

double along(const Line& line, const Vec3d& p) { return (p - line.point).dot(line.direction); }

Barrier clipped(const Barrier& b, const Vec3d& point, const Vec3d& normal, double sign) {
  const double da = sign * (b.a - point).dot(normal);
  const double db = sign * (b.b - point).dot(normal);
  Barrier out = b;
  if (da < 0.0 && db > 0.0) out.a = b.a + da / (da - db) * (b.b - b.a);
  if (db < 0.0 && da > 0.0) out.b = b.a + da / (da - db) * (b.b - b.a);
  if (da <= 0.0 && db <= 0.0) out.b = out.a;
  return out;
}

class Divider {
 public:
  Divider(const BarrierFinder& finder, const Covers& covers, scene::ObjectId object,
          const Corners& corners, const Facet& facet, double cell)
      : finder_(finder),
        covers_(covers),
        object_(object),
        corners_(corners),
        facet_(facet),
        cell_(cell) {
    double size = 0.0;
    for (const std::uint32_t t : facet.triangles)
      for (const Vec3f& c : corners[t])
        size = std::max(size, static_cast<double>(c.cwiseAbs().maxCoeff()));
    tolerance_ = 0x1p-20 * size;  // some roundings of a coordinate
  }

  Division divide() {
    find_barriers();
    keep_large();
    if (barriers_.empty()) return {};
    number_edges();
    cut_triangles();
    connect();
    const std::vector<Wall> free = free_walls();
    if (!free.empty() && free.size() <= kMostFree && is_flat()) {
      fence_off(free);
      number_edges();
      cut_triangles();
      connect();
    }
    return collect();
  }

 private:
  void find_barriers() {
    first_.push_back(0);
    for (const std::uint32_t t : facet_.triangles) {
      for (const Barrier& b : finder_.on(object_, t, 0.01 * cell_))
        if ((b.b - b.a).norm() > tolerance_) barriers_.push_back(b);
      for (const Barrier& b : covers_.outlines_on(object_, t))
        if ((b.b - b.a).norm() > kOutlineLength * cell_) barriers_.push_back(b);
      for (const Barrier& b :
           finder_.outlines_above(object_, t, kHang * cell_, kHangLength * cell_))
        if ((b.b - b.a).norm() > tolerance_) barriers_.push_back(b);
      first_.push_back(barriers_.size());
    }
  }

  /// Too many barriers are those of many small things: chairs in an office, grass on a lawn. What
  /// stands there with the longest edges divides; of what does not fit only long edges do.
  void keep_large() {
    if (barriers_.size() <= kMostBarriers) return;
    const auto length = [&](std::size_t i) { return (barriers_[i].b - barriers_[i].a).norm(); };
    struct Thing {
      double longest = 0.0;
      std::vector<std::size_t> barriers;
    };
    std::map<std::uint32_t, Thing> by_object;
    for (std::size_t i = 0; i < barriers_.size(); ++i) {
      Thing& thing = by_object[barriers_[i].object.value];
      thing.longest = std::max(thing.longest, length(i));
      thing.barriers.push_back(i);
    }
    std::vector<Thing> things;
    things.reserve(by_object.size());
    for (auto& [object, thing] : by_object) things.push_back(std::move(thing));
    std::stable_sort(things.begin(), things.end(),
                     [](const Thing& x, const Thing& y) { return x.longest > y.longest; });
    std::vector<bool> kept(barriers_.size(), false);
    std::size_t left = kMostBarriers;
    for (Thing& thing : things) {
      if (thing.barriers.size() > left) {
        std::erase_if(thing.barriers,
                      [&](std::size_t i) { return length(i) < kFreeLength * cell_; });
        std::stable_sort(thing.barriers.begin(), thing.barriers.end(),
                         [&](std::size_t i, std::size_t j) { return length(i) > length(j); });
        thing.barriers.resize(std::min(thing.barriers.size(), left));
      }
      for (const std::size_t i : thing.barriers) kept[i] = true;
      left -= thing.barriers.size();
    }
    std::vector<Barrier> large;
    std::vector<std::size_t> first{0};
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
      for (std::size_t i = first_[t]; i < first_[t + 1]; ++i)
        if (kept[i]) large.push_back(barriers_[i]);
      first.push_back(large.size());
    }
    barriers_ = std::move(large);
    first_ = std::move(first);
  }

  /// An edge of a fragment that lies on a line.
  struct Use {
    std::uint32_t fragment;
    double low, high;  // along the line
  };

  // ---- walls that end free ----

  /// Where barriers lie on a line.
  struct Wall {
    Vec3d a, b;
  };

  /// Long barriers with the same region on both of their sides.
  std::vector<Wall> free_walls() {
    std::vector<Wall> walls;
    for (std::uint32_t line = 0; line < lines_.size(); ++line) {
      if (uses_[line].size() < 2) continue;
      for (const auto& [from, to] : covered(lines_[line], /*walls_only=*/true)) {
        if (to - from < kFreeLength * cell_ || !joined_across(uses_[line], from, to)) continue;
        const Wall w{lines_[line].point + from * lines_[line].direction,
                     lines_[line].point + to * lines_[line].direction};
        // A wall through several triangles has a line in each.
        const bool known = std::any_of(walls.begin(), walls.end(), [&](const Wall& v) {
          return (v.a + v.b - w.a - w.b).norm() < kGap * cell_;
        });
        if (!known) walls.push_back(w);
      }
    }
    return walls;
  }

  bool joined_across(const std::vector<Use>& uses, double from, double to) {
    for (std::size_t i = 0; i < uses.size(); ++i)
      for (std::size_t j = i + 1; j < uses.size(); ++j) {
        const double low = std::max({uses[i].low, uses[j].low, from});
        const double high = std::min({uses[i].high, uses[j].high, to});
        if (high - low > 4.0 * tolerance_ && root_of(uses[i].fragment) == root_of(uses[j].fragment))
          return true;
      }
    return false;
  }

  bool is_flat() const {
    const Vec3d origin = corners_[facet_.triangles[0]][0].cast<double>();
    return std::all_of(facet_.triangles.begin(), facet_.triangles.end(), [&](std::uint32_t t) {
      return std::all_of(corners_[t].begin(), corners_[t].end(), [&](const Vec3f& p) {
        return std::abs((p.cast<double>() - origin).dot(facet_.normal)) <= 4.0 * tolerance_;
      });
    });
  }

  /// A strip of a cell's width round each of these walls becomes a region of its own, and the
  /// wall's line parts it: no element near the wall lies on both of its sides.
  void fence_off(const std::vector<Wall>& walls) {
    std::vector<Barrier> fences;
    for (const Wall& w : walls) {
      const Vec3d along = cell_ * (w.b - w.a).normalized();
      const Vec3d across = facet_.normal.cross(along);
      const Vec3d a = w.a - along, b = w.b + along;
      fences.push_back({a, b, false, {}});
      fences.push_back({a - across, b - across, false, {}});
      fences.push_back({a + across, b + across, false, {}});
      fences.push_back({a - across, a + across, false, {}});
      fences.push_back({b - across, b + across, false, {}});
    }
    std::vector<Barrier> all;
    std::vector<std::size_t> first{0};
    for (std::size_t i = 0; i < facet_.triangles.size(); ++i) {
      all.insert(all.end(), barriers_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
                 barriers_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
      for (const Barrier& f : fences)
        if (const auto part = within_triangle(corners_[facet_.triangles[i]], f);
            part && (part->b - part->a).norm() > tolerance_)
          all.push_back(*part);
      first.push_back(all.size());
    }
    barriers_ = std::move(all);
    first_ = std::move(first);
    edge_line_.clear();
    lines_.clear();
    fragments_.clear();
    nodes_.clear();
    root_.clear();
  }

  /// Edges of two triangles of the facet get a line; others border nothing.
  void number_edges() {
    std::map<EdgeKey, int> uses;
    for (const std::uint32_t t : facet_.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        ++uses[edge_key(corners_[t][k], corners_[t][(k + 1) % 3])];
    for (const auto& [key, count] : uses) {
      if (count < 2) continue;
      const Vec3d a(key[0], key[1], key[2]), b(key[3], key[4], key[5]);
      edge_line_[key] = add_line(a, b - a);
    }
  }

  std::uint32_t add_line(const Vec3d& point, const Vec3d& direction) {
    lines_.push_back({point, direction.normalized()});
    return static_cast<std::uint32_t>(lines_.size() - 1);
  }

  void cut_triangles() {
    for (std::uint32_t i = 0; i < facet_.triangles.size(); ++i) {
      const auto& c = corners_[facet_.triangles[i]];
      Fragment whole;
      whole.triangle = i;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto it = edge_line_.find(edge_key(c[k], c[(k + 1) % 3]));
        whole.corners.push_back({c[k].cast<double>(), it == edge_line_.end() ? kNone : it->second});
      }
      normal_ = (whole.corners[1].p - whole.corners[0].p)
                    .cross(whole.corners[2].p - whole.corners[0].p)
                    .normalized();
      std::uint32_t root = static_cast<std::uint32_t>(fragments_.size());
      fragments_.push_back(std::move(whole));
      std::vector<Barrier> mine(barriers_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
                                barriers_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
      // Long ones first: walls part the room before table legs part its halves.
      std::stable_sort(mine.begin(), mine.end(), [](const Barrier& x, const Barrier& y) {
        return (x.b - x.a).squaredNorm() > (y.b - y.a).squaredNorm();
      });
      for (const Barrier& b : mine) root = insert(root, b);
      root_.push_back(root);
    }
  }

  /// Cuts the fragments below a tree's node that a barrier passes through. \return the new node.
  std::uint32_t insert(std::uint32_t node, const Barrier& b) {
    if ((b.b - b.a).norm() <= tolerance_) return node;
    if ((node & kCut) == 0) return cut(node, b);
    const std::uint32_t n = node & ~kCut;
    const Vec3d point = nodes_[n].point.cast<double>();
    const Vec3d normal = nodes_[n].normal.cast<double>();
    for (const std::size_t side : {0U, 1U}) {
      const std::uint32_t child =
          insert(nodes_[n].child[side], clipped(b, point, normal, side == 0 ? 1.0 : -1.0));
      nodes_[n].child[side] = child;
    }
    return node;
  }

  std::uint32_t cut(std::uint32_t leaf, const Barrier& b) {
    const Vec3d direction = (b.b - b.a).normalized();
    const Vec3d across = normal_.cross(direction).normalized();
    double low = 0.0, high = 0.0;
    for (const Vertex& v : fragments_[leaf].corners) {
      low = std::min(low, (v.p - b.a).dot(across));
      high = std::max(high, (v.p - b.a).dot(across));
    }
    if (low > -tolerance_ || high < tolerance_) return leaf;  // along its border
    const std::uint32_t line = add_line(b.a, direction);
    Fragment front = half(fragments_[leaf], b.a, across, line);
    Fragment back = half(fragments_[leaf], b.a, -across, line);
    if (front.corners.size() < 3 || back.corners.size() < 3) return leaf;
    fragments_[leaf] = std::move(front);
    const auto other = static_cast<std::uint32_t>(fragments_.size());
    fragments_.push_back(std::move(back));
    nodes_.push_back({b.a.cast<float>(), across.cast<float>(), {leaf, other}});
    return kCut | static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  /// The part in front of a cut; its new edge lies on the cut's line.
  static Fragment half(const Fragment& in, const Vec3d& point, const Vec3d& normal,
                       std::uint32_t line) {
    Fragment out;
    out.triangle = in.triangle;
    const std::size_t n = in.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vertex& a = in.corners[i];
      const Vertex& b = in.corners[(i + 1) % n];
      const double da = (a.p - point).dot(normal);
      const double db = (b.p - point).dot(normal);
      if (da >= 0.0) out.corners.push_back({a.p, da == 0.0 && db < 0.0 ? line : a.line});
      if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0))
        out.corners.push_back({a.p + da / (da - db) * (b.p - a.p), db < 0.0 ? line : a.line});
    }
    return out;
  }

  // ---- which fragments hang together ----

  void connect() {
    parent_.resize(fragments_.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    directions_.emplace(barriers_, facet_.axis, facet_.normal, 4.0 * tolerance_);
    std::vector<std::vector<Use>>& uses = uses_;
    uses.assign(lines_.size(), {});
    for (std::uint32_t f = 0; f < fragments_.size(); ++f) {
      const auto& c = fragments_[f].corners;
      for (std::size_t k = 0; k < c.size(); ++k) {
        if (c[k].line == kNone) continue;
        const double s = along(lines_[c[k].line], c[k].p);
        const double t = along(lines_[c[k].line], c[(k + 1) % c.size()].p);
        uses[c[k].line].push_back({f, std::min(s, t), std::max(s, t)});
      }
    }
    for (std::uint32_t line = 0; line < lines_.size(); ++line) connect_across(line, uses[line]);
  }

  void connect_across(std::uint32_t line, const std::vector<Use>& uses) {
    if (uses.size() < 2) return;
    const std::vector<Interval> closed = covered(lines_[line], false);
    const std::vector<Interval> walls = covered(lines_[line], true);
    for (std::size_t i = 0; i < uses.size(); ++i)
      for (std::size_t j = i + 1; j < uses.size(); ++j) {
        const double low = std::max(uses[i].low, uses[j].low);
        const double high = std::min(uses[i].high, uses[j].high);
        if (high - low > 4.0 * tolerance_ && is_open(low, high, closed, walls))
          parent_[root_of(uses[i].fragment)] = root_of(uses[j].fragment);
      }
  }

  using Interval = std::pair<double, double>;

  /// Where barriers lie on a line, ascending; what all but touches is one.
  /// \param walls_only  not what is a border without a wall.
  std::vector<Interval> covered(const Line& line, bool walls_only) const {
    std::vector<Interval> all;
    const auto off = [&](const Vec3d& p) {
      return (p - line.point - along(line, p) * line.direction).norm();
    };
    std::vector<std::uint32_t> parallel;
    directions_->along(line.direction, parallel);
    for (const std::uint32_t i : parallel) {
      const Barrier& b = barriers_[i];
      if (walls_only && !b.wall) continue;
      if (off(b.a) > 4.0 * tolerance_ || off(b.b) > 4.0 * tolerance_) continue;
      all.push_back(std::minmax(along(line, b.a), along(line, b.b)));
    }
    std::sort(all.begin(), all.end());
    std::vector<Interval> out;
    for (const Interval& i : all) {
      if (!out.empty() && i.first - out.back().second < kGap * cell_)
        out.back().second = std::max(out.back().second, i.second);
      else
        out.push_back(i);
    }
    return out;
  }

  /// Does a border between fragments connect them? Next to a wall's own line it does not, doorway
  /// or not: elements on both sides of the wall would be one. A short barrier (a table's leg) has
  /// to cover the border; one without any barrier is open however short it is.
  bool is_open(double low, double high, const std::vector<Interval>& closed,
               const std::vector<Interval>& walls) const {
    for (const auto& [from, to] : walls) {
      const double length = to - from;
      if (length > kWallLength * cell_ && from - high < length && low - to < length) return false;
    }
    double at = low;
    double widest = 0.0;
    for (const auto& [from, to] : closed) {
      if (from < high) widest = std::max(widest, std::min(from, high) - at);
      if (from < high) at = std::max(at, to);
    }
    widest = std::max(widest, high - at);
    return widest > std::min(kGap * cell_, 0.5 * (high - low));
  }

  std::uint32_t root_of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  // ---- the result ----

  Division collect() {
    Division out;
    std::map<std::uint32_t, std::uint32_t> facet_of_root;
    std::vector<std::uint32_t> facet_of(fragments_.size());
    for (std::uint32_t f = 0; f < fragments_.size(); ++f)
      facet_of[f] =
          facet_of_root.try_emplace(root_of(f), static_cast<std::uint32_t>(facet_of_root.size()))
              .first->second;
    if (facet_of_root.size() < 2) return {};
    out.facets.resize(facet_of_root.size());
    for (std::uint32_t f = 0; f < fragments_.size(); ++f) add(out, fragments_[f], facet_of[f]);
    const auto is_sliver = [&](const Facet& f) {
      return f.triangles.empty() || f.area < kSmallestRegion * cell_ * cell_;
    };
    std::vector<std::uint32_t> kept(out.facets.size(), kNone);
    std::uint32_t count = 0;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      Facet& f = out.facets[k];
      if (is_sliver(f)) continue;
      f.normal = facet_.normal;
      f.axis = facet_.axis;
      f.centre /= f.area;
      kept[k] = count++;
    }
    if (count == 0) return {};
    std::erase_if(out.facets, [&](const Facet& f) { return is_sliver(f); });
    out.nodes = nodes_;
    const auto leaf = [&](std::uint32_t& node) {
      if ((node & kCut) == 0) node = kept[facet_of[node]];
    };
    for (SurfaceField::Cut& n : out.nodes)
      for (std::uint32_t& child : n.child) leaf(child);
    out.root = root_;
    for (std::uint32_t& r : out.root) leaf(r);
    return out;
  }

  void add(Division& out, const Fragment& fragment, std::uint32_t facet) const {
    const auto& c = fragment.corners;
    for (std::size_t k = 1; k + 1 < c.size(); ++k) {
      const double area = 0.5 * (c[k].p - c[0].p).cross(c[k + 1].p - c[0].p).norm();
      if (!(area > 0.0)) continue;
      Facet& f = out.facets[facet];
      f.triangles.push_back(static_cast<std::uint32_t>(out.corners.size()));
      f.area += area;
      f.centre += area / 3.0 * (c[0].p + c[k].p + c[k + 1].p);
      out.corners.push_back({c[0].p.cast<float>(), c[k].p.cast<float>(), c[k + 1].p.cast<float>()});
      out.original.push_back(facet_.triangles[fragment.triangle]);
    }
  }

  const BarrierFinder& finder_;
  const Covers& covers_;
  scene::ObjectId object_;
  const Corners& corners_;
  const Facet& facet_;
  double cell_, tolerance_ = 0.0;
  Vec3d normal_ = Vec3d::UnitZ();  // of the triangle being cut
  std::vector<Barrier> barriers_;
  std::vector<std::size_t> first_;               // barrier of each triangle
  std::optional<BarrierDirections> directions_;  // of the barriers
  std::map<EdgeKey, std::uint32_t> edge_line_;
  std::vector<Line> lines_;
  std::vector<Fragment> fragments_;
  std::vector<SurfaceField::Cut> nodes_;
  std::vector<std::uint32_t> root_, parent_;
  std::vector<std::vector<Use>> uses_;  // by line
};

}  // namespace

Division divide_facet(const BarrierFinder& barriers, const Covers& covers, scene::ObjectId object,
                      const Corners& corners, const Facet& facet, double cell) {
  if (facet.clump || facet.area < kSmallestFacet * cell * cell) return {};
  return Divider(barriers, covers, object, corners, facet, cell).divide();
}

}  // namespace atrium::radiosity
