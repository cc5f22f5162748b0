#include "wall_holes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace atrium::scene {
namespace {

constexpr std::size_t kMostWalls = 128;
constexpr std::size_t kMostObjects = 64;
constexpr std::size_t kMostCandidates = 256;
constexpr int kCells = 192;          ///< along the longer side of a wall
constexpr double kLeastSide = 0.01;  ///< of the scene's diagonal
constexpr double kLeastFill = 0.97;  ///< of its bounds, of what is taken for a rectangle
constexpr double kFlatness = 1e-4;   ///< of the diagonal: what lies in one plane
constexpr float kNormalSteps = 200.0F;

using Corners = std::array<Vec3f, 3>;

/// Coplanar triangles, whichever objects they are of.
struct Wall {
  Vec3f normal = Vec3f::Zero();
  std::vector<Corners> triangles;
  double area = 0.0;
};

double area_of(const Corners& t) {
  return 0.5 * static_cast<double>((t[1] - t[0]).cross(t[2] - t[0]).norm());
}

/// Of the normal's line, in steps: opposite normals have the same.
std::array<int, 3> direction_key(Vec3f& n) {
  std::array<int, 3> key{};
  for (int k = 0; k < 3; ++k)
    key[static_cast<std::size_t>(k)] = static_cast<int>(std::lround(n[k] * kNormalSteps));
  const auto first = std::find_if(key.begin(), key.end(), [](int x) { return x != 0; });
  if (first != key.end() && *first < 0) {
    for (int& x : key) x = -x;
    n = -n;
  }
  return key;
}

struct Placed {
  double offset;
  Corners corners;
};

template <class F>
void each_opaque_triangle(const Scene& scene, F&& f) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const ObjectId id(o);
    if (scene.material_of(id).medium == material::Material::Medium::Pane) continue;
    const std::size_t count = scene.mesh_of(id).triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      const Corners c = scene.corners(id, static_cast<std::uint32_t>(t));
      const Vec3f cross = (c[1] - c[0]).cross(c[2] - c[0]);
      const float length = cross.norm();
      if (!(length > 0.0F)) continue;
      Vec3f n = cross / length;
      const auto key = direction_key(n);
      f(c, n, key);
    }
  }
}

/// The largest walls. What has too little area in its direction is not even stored, so that curved
/// meshes cost no memory.
std::vector<Wall> find_walls(const Scene& scene, double diagonal) {
  const double least_area = std::pow(2.0 * kLeastSide * diagonal, 2);
  std::map<std::array<int, 3>, double> area;
  each_opaque_triangle(scene, [&](const Corners& c, const Vec3f&, const std::array<int, 3>& key) {
    area[key] += area_of(c);
  });
  std::map<std::array<int, 3>, std::pair<Vec3f, std::vector<Placed>>> by_direction;
  each_opaque_triangle(scene, [&](const Corners& c, const Vec3f& n, const std::array<int, 3>& key) {
    if (area[key] < least_area) return;
    auto& [normal, list] = by_direction[key];
    if (list.empty()) normal = n;
    list.push_back({n.cast<double>().dot(c[0].cast<double>()), c});
  });
  std::vector<Wall> walls;
  for (auto& [key, direction] : by_direction) {
    auto& [normal, placed] = direction;
    std::stable_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.offset < b.offset; });
    for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
      Wall wall{.normal = normal, .triangles = {}};
      for (end = begin; end < placed.size(); ++end) {
        if (end > begin && placed[end].offset > placed[end - 1].offset + kFlatness * diagonal)
          break;
        wall.area += area_of(placed[end].corners);
      }
      if (wall.area < least_area) continue;
      for (std::size_t i = begin; i < end; ++i) wall.triangles.push_back(placed[i].corners);
      walls.push_back(std::move(wall));
    }
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const Wall& a, const Wall& b) { return a.area > b.area; });
  if (walls.size() > kMostWalls) walls.resize(kMostWalls);
  return walls;
}

/// A wall drawn on a grid along its longest edge.
class WallPlan {
 public:
  WallPlan(const Wall& wall, double diagonal) : normal_(wall.normal) {
    origin_ = wall.triangles[0][0];
    Vec3f longest = Vec3f::Zero();
    for (const Corners& t : wall.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f edge = t[(k + 1) % 3] - t[k];
        if (edge.squaredNorm() > 1.0001F * longest.squaredNorm()) longest = edge;
      }
    // A diagonal of a rectangle is longer than its sides: of two edges of one triangle at a right
    // angle the longer one is the axis.
    if (const auto side = rectangle_side(wall)) longest = *side;
    u_ = (longest - longest.dot(normal_) * normal_).normalized();
    v_ = normal_.cross(u_);
    for (const Corners& t : wall.triangles)
      for (const Vec3f& c : t) bounds_.extend(plan(c));
    cell_ = bounds_.sizes().maxCoeff() / kCells;
    least_ = kLeastSide * diagonal;
    if (!(bounds_.sizes().minCoeff() > least_) || !(cell_ > 0.0)) return;
    width_ = std::max(1, static_cast<int>(std::lround(bounds_.sizes().x() / cell_)));
    height_ = std::max(1, static_cast<int>(std::lround(bounds_.sizes().y() / cell_)));
    const int cells = width_ * height_;
    covered_.assign(static_cast<std::size_t>(cells), 0);
    for (const Corners& t : wall.triangles) draw(t);
    for (int axis = 0; axis < 2; ++axis) {
      auto& list = lines_[static_cast<std::size_t>(axis)];
      for (const Corners& t : wall.triangles)
        for (const Vec3f& c : t) list.push_back(plan(c)[axis]);
      std::sort(list.begin(), list.end());
    }
  }

  /// Rectangles that nothing covers.
  [[nodiscard]] std::vector<HoleCandidate> holes() {
    std::vector<HoleCandidate> list;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (covered(x, y) == 0) take(x, y, list);
    return list;
  }

 private:
  using Vec2 = Eigen::Vector2d;

  static std::optional<Vec3f> rectangle_side(const Wall& wall) {
    std::optional<Vec3f> best;
    for (const Corners& t : wall.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f a = t[(k + 1) % 3] - t[k], b = t[(k + 2) % 3] - t[k];
        if (std::abs(a.dot(b)) > 1e-3F * a.norm() * b.norm()) continue;
        const Vec3f side = a.squaredNorm() >= b.squaredNorm() ? a : b;
        if (!best || side.squaredNorm() > 1.0001F * best->squaredNorm()) best = side;
      }
    return best;
  }

  [[nodiscard]] Vec2 plan(const Vec3f& p) const {
    const Vec3d d = (p - origin_).cast<double>();
    return {d.dot(u_.cast<double>()), d.dot(v_.cast<double>())};
  }
  [[nodiscard]] Vec3f place(double x, double y) const {
    return origin_ + static_cast<float>(x) * u_ + static_cast<float>(y) * v_;
  }
  [[nodiscard]] std::uint8_t& covered(int x, int y) {
    const int i = y * width_ + x;
    return covered_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Vec2 centre(int x, int y) const {
    return {bounds_.min().x() + (x + 0.5) * bounds_.sizes().x() / width_,
            bounds_.min().y() + (y + 0.5) * bounds_.sizes().y() / height_};
  }

  // Cells whose centres lie in the triangle or within rounding of its edges.
  void draw(const Corners& t) {
    const std::array<Vec2, 3> c{plan(t[0]), plan(t[1]), plan(t[2])};
    Eigen::AlignedBox2d box;
    for (const Vec2& p : c) box.extend(p);
    const auto cell_of = [&](double value, int axis, int count) {
      const double share = (value - bounds_.min()[axis]) / bounds_.sizes()[axis];
      return std::clamp(static_cast<int>(share * count), 0, count - 1);
    };
    const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) {
      return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
    };
    const double turn = side(c[0], c[1], c[2]) < 0.0 ? -1.0 : 1.0;
    for (int y = cell_of(box.min().y(), 1, height_); y <= cell_of(box.max().y(), 1, height_); ++y)
      for (int x = cell_of(box.min().x(), 0, width_); x <= cell_of(box.max().x(), 0, width_); ++x) {
        const Vec2 p = centre(x, y);
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec2 &a = c[k], &b = c[(k + 1) % 3];
          inside = inside && turn * side(a, b, p) >= -1e-3 * cell_ * (b - a).norm();
        }
        if (inside) covered(x, y) = 1;
      }
  }

  [[nodiscard]] double snapped(double value, std::size_t axis) const {
    const std::vector<double>& list = lines_[axis];
    const auto after = std::lower_bound(list.begin(), list.end(), value);
    double best = value, distance = 1.5 * cell_;
    for (const auto it : {after, after == list.begin() ? after : after - 1})
      if (it != list.end() && std::abs(*it - value) < distance) {
        distance = std::abs(*it - value);
        best = *it;
      }
    return best;
  }

  // The connected cells round a free one.
  void take(int x0, int y0, std::vector<HoleCandidate>& list) {
    Eigen::AlignedBox2i box;
    std::vector<Eigen::Vector2i> open{{x0, y0}};
    covered(x0, y0) = 2;
    std::size_t count = 0;
    while (!open.empty()) {
      const Eigen::Vector2i at = open.back();
      open.pop_back();
      box.extend(at);
      ++count;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int x = at.x() + dx, y = at.y() + dy;
        if (x < 0 || y < 0 || x >= width_ || y >= height_ || covered(x, y) != 0) continue;
        covered(x, y) = 2;
        open.emplace_back(x, y);
      }
    }
    const Eigen::Vector2i cells = box.sizes() + Eigen::Vector2i(1, 1);
    if (static_cast<double>(count) < kLeastFill * cells.x() * cells.y()) return;
    const Vec2 step(bounds_.sizes().x() / width_, bounds_.sizes().y() / height_);
    const Vec2 low = bounds_.min() + step.cwiseProduct(box.min().cast<double>());
    const Vec2 high = low + step.cwiseProduct(cells.cast<double>());
    const double a = snapped(low.x(), 0), b = snapped(high.x(), 0);
    const double c = snapped(low.y(), 1), d = snapped(high.y(), 1);
    if (!(b - a >= least_ && d - c >= least_)) return;
    list.push_back({{place(a, c), place(b, c), place(b, d), place(a, d)}});
  }

  Vec3f normal_, origin_, u_, v_;
  Eigen::AlignedBox2d bounds_;
  double cell_ = 0.0, least_ = 0.0;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> covered_;  // 0 free, 1 wall, 2 free and taken
  std::array<std::vector<double>, 2> lines_;
};

void add_box(const Eigen::AlignedBox3f& box, double least, std::vector<HoleCandidate>& list) {
  if (!(static_cast<double>(box.sizes().minCoeff()) > least)) return;
  for (int axis = 0; axis < 3; ++axis)
    for (const Vec3f& at : {box.min(), box.max()}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      HoleCandidate c{.corners = {}, .wall_missing = true};
      for (std::size_t k = 0; k < 4; ++k) {
        Vec3f& p = c.corners[k];
        p[axis] = at[axis];
        p[a] = (k == 1 || k == 2 ? box.max() : box.min())[a];
        p[b] = (k >= 2 ? box.max() : box.min())[b];
      }
      list.push_back(c);
    }
}

void add_boxes(const Scene& scene, double diagonal, std::vector<HoleCandidate>& list) {
  const double least = kLeastSide * diagonal;
  add_box(scene.bounds.cast<float>(), least, list);
  if (scene.objects.size() > kMostObjects) return;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    Eigen::AlignedBox3f box;
    const std::size_t count = scene.mesh_of(ObjectId(o)).triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      for (const Vec3f& c : scene.corners(ObjectId(o), static_cast<std::uint32_t>(t)))
        box.extend(c);
    if (static_cast<double>(box.diagonal().norm()) > 0.1 * diagonal) add_box(box, least, list);
  }
}

}  // namespace

std::vector<HoleCandidate> find_hole_candidates(const Scene& scene) {
  const double diagonal = scene.bounds.diagonal().norm();
  std::vector<HoleCandidate> list;
  if (!(diagonal > 0.0)) return list;
  for (const Wall& wall : find_walls(scene, diagonal)) {
    const std::vector<HoleCandidate> holes = WallPlan(wall, diagonal).holes();
    list.insert(list.end(), holes.begin(), holes.end());
  }
  add_boxes(scene, diagonal, list);
  const auto area = [](const HoleCandidate& h) {
    return (h.corners[1] - h.corners[0]).cross(h.corners[3] - h.corners[0]).norm();
  };
  std::stable_sort(list.begin(), list.end(), [&](const HoleCandidate& a, const HoleCandidate& b) {
    return area(a) > area(b);
  });
  if (list.size() > kMostCandidates) list.resize(kMostCandidates);
  return list;
}

}  // namespace atrium::scene
