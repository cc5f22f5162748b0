#include "scene/portal.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "material/error.h"
#include "scene/sampler.h"
#include "wall_holes.h"

namespace atrium::scene {
namespace {

constexpr int kOpennessRays = 128;
constexpr int kRoomRays = 512;
constexpr double kLeastOutside = 0.02;     ///< share of an open half space that a window must see
constexpr double kLeastOutsideHole = 0.1;  ///< of a hole: under tables there is always some sky
constexpr double kMostInside = 0.5;        ///< share inside of a pane, relative to outside
constexpr double kMostInsideHole = 0.25;   ///< of a hole, which may be a mere gate
constexpr double kNamed = 2.0;             ///< nothing is asked of what hints name
constexpr double kRim = 0.9;               ///< share of the border that surfaces rim
constexpr std::size_t kMostFound = 64;
constexpr std::size_t kMostTriangles = 64;  ///< of a pane; a finer mesh is no plain window

/// A flat piece: an object or a polygon.
struct Piece {
  std::vector<std::array<Vec3f, 3>> triangles;
  double area = 0.0;

  void add(const std::array<Vec3f, 3>& t) {
    const double a = 0.5 * static_cast<double>((t[1] - t[0]).cross(t[2] - t[0]).norm());
    if (!(a > 0.0)) return;
    triangles.push_back(t);
    area += a;
  }
  [[nodiscard]] Vec3f center() const {
    Vec3d sum = Vec3d::Zero();
    for (const auto& t : triangles)
      sum += (t[0] + t[1] + t[2]).cast<double>() / 6.0 *
             static_cast<double>((t[1] - t[0]).cross(t[2] - t[0]).norm());
    return (sum / area).cast<float>();
  }
  [[nodiscard]] Vec3f normal() const {
    const auto& t = triangles[0];
    return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  }
  [[nodiscard]] bool flat() const {
    const Vec3f n = normal();
    return std::all_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      return std::abs(n.dot((t[1] - t[0]).cross(t[2] - t[0]).normalized())) > 0.999f;
    });
  }
};

class Finder {
 public:
  explicit Finder(const RayQuery& query) : query_(query), scene_(query.scene()) {
    margin_ = 1e-4f * static_cast<float>(scene_.bounds.diagonal().norm());
  }

  std::vector<Opening> find() {
    for (const std::vector<Vec3d>& polygon : scene_.portals.polygons) take_polygon(polygon);
    for (const std::string& name : scene_.portals.objects) take_named(name);
    if (!scene_.portals.find) return std::move(openings_);
    const std::size_t most = openings_.size() + kMostFound;
    for (std::size_t i = 0; i < scene_.objects.size() && openings_.size() < most; ++i)
      try_pane(ObjectId(i));
    if (openings_.size() >= most) return std::move(openings_);
    for (const HoleCandidate& hole : find_hole_candidates(scene_)) {
      if (openings_.size() >= most) break;
      try_hole(hole);
    }
    return std::move(openings_);
  }

 private:
  // Rays into the half space around `normal`, cosine distributed, from points of the opening.
  template <class F>
  void rays(const Piece& opening, const Vec3f& normal, int count, F&& f) {
    const Frame frame(normal);
    for (int i = 0; i < count; ++i) {
      Sampler sampler(0x9027a1, 0, static_cast<std::uint32_t>(i));
      const Vec2f u = sampler.next_2d();
      const auto& t = opening.triangles[static_cast<std::size_t>(i) % opening.triangles.size()];
      const float s = std::sqrt(u.x());
      const Vec3f from =
          t[0] + s * (1.0f - u.y()) * (t[1] - t[0]) + s * u.y() * (t[2] - t[0]) + margin_ * normal;
      f(Ray{from, frame.to_world(sample_cosine_hemisphere(sampler.next_2d()))});
    }
  }

  /// Share of the half space from which the sky is seen, panes counting as open.
  double openness(const Piece& opening, const Vec3f& normal) {
    int open = 0;
    rays(opening, normal, kOpennessRays, [&](const Ray& ray) {
      open += query_.occluded(ray, counters_, Counter::RaysProbe, kOpaque | kAlpha) ? 0 : 1;
    });
    return static_cast<double>(open) / kOpennessRays;
  }

  /// \param most_inside  share inside, relative to outside; above 1: it is an opening in any case.
  void take(const Piece& opening, const std::string& reason, double most_inside,
            double least_outside = kLeastOutside) {
    if (opening.triangles.empty()) return;
    Vec3f inwards = opening.normal();
    double inside = openness(opening, inwards), outside = openness(opening, -inwards);
    if (inside > outside) {
      inwards = -inwards;
      std::swap(inside, outside);
    }
    if (most_inside <= 1.0 && !(outside >= least_outside && inside <= most_inside * outside))
      return;
    Eigen::AlignedBox3f room;
    rays(opening, inwards, kRoomRays, [&](const Ray& ray) {
      if (const auto hit = query_.closest(ray, counters_, Counter::RaysProbe, kOpaque | kAlpha))
        room.extend(Vec3f(ray.origin + hit->t * ray.direction));
    });
    for (const auto& t : opening.triangles)
      for (const Vec3f& c : t) room.extend(c);
    const Vec3f pad = Vec3f::Constant(0.02f * room.diagonal().norm() + margin_);
    room = Eigen::AlignedBox3f(room.min() - pad, room.max() + pad);
    Opening found{.portals = {},
                  .reason = reason,
                  .center = opening.center().cast<double>() + scene_.origin,
                  .area = opening.area,
                  .outside = outside,
                  .inside = inside};
    for (std::array<Vec3f, 3> t : opening.triangles) {
      if ((t[1] - t[0]).cross(t[2] - t[0]).dot(inwards) < 0.0f) std::swap(t[1], t[2]);
      found.portals.push_back({t, room});
    }
    openings_.push_back(std::move(found));
    taken_.push_back(opening);
  }

  void take_polygon(const std::vector<Vec3d>& polygon) {
    Piece opening;
    for (std::size_t k = 2; k < polygon.size(); ++k)
      opening.add(
          {polygon[0].cast<float>(), polygon[k - 1].cast<float>(), polygon[k].cast<float>()});
    take(opening, "named by a polygon", kNamed);
  }

  Piece opening_of(ObjectId id) const {
    Piece opening;
    const std::size_t count = scene_.mesh_of(id).triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      opening.add(scene_.corners(id, static_cast<std::uint32_t>(t)));
    return opening;
  }

  void take_named(const std::string& name) {
    bool found = false;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      if (scene_.objects[i].name != name) continue;
      const Piece opening = opening_of(ObjectId(i));
      if (opening.triangles.empty()) continue;
      if (!opening.flat()) throw Error("portals: the object '" + name + "' is not flat");
      found = true;
      take(opening, "named by the object '" + name + "'", kNamed);
    }
    if (!found) throw Error("portals: there is no object '" + name + "'");
  }

  void try_pane(ObjectId id) {
    const material::Material& m = scene_.material_of(id);
    const std::size_t count = scene_.mesh_of(id).triangles.size();
    if (m.medium != material::Material::Medium::Pane || count == 0 || count > kMostTriangles)
      return;
    const Piece opening = opening_of(id);
    if (!opening.triangles.empty() && opening.flat() && !known(opening))
      take(opening, "pane '" + scene_.objects[id.value].name + "' between sky and room",
           kMostInside);
  }

  void try_hole(const HoleCandidate& hole) {
    const auto& c = hole.corners;
    Piece opening;
    opening.add({c[0], c[1], c[2]});
    opening.add({c[0], c[2], c[3]});
    if (opening.triangles.empty() || known(opening) || !rimmed(hole) || !clear(hole)) return;
    take(opening,
         hole.wall_missing ? "missing wall between sky and room"
                           : "hole in a wall between sky and room",
         kMostInsideHole, kLeastOutsideHole);
  }

  /// Do surfaces meet the border of a rectangle all round? Just outside of it in its plane, or
  /// across it just beside its plane.
  bool rimmed(const HoleCandidate& hole) {
    constexpr int kPoints = 12;  // of a side
    const auto& c = hole.corners;
    const Vec3f normal = (c[1] - c[0]).cross(c[3] - c[0]).normalized();
    const Vec3f middle = 0.25f * (c[0] + c[1] + c[2] + c[3]);
    const float step = 0.01f * std::min((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
    int met = 0;
    for (std::size_t k = 0; k < 4; ++k)
      for (int i = 0; i < kPoints; ++i) {
        const Vec3f &a = c[k], &b = c[(k + 1) % 4];
        const Vec3f at = a + (static_cast<float>(i) + 0.5f) / kPoints * (b - a);
        Vec3f out = normal.cross(b - a).normalized();
        if (out.dot(at - middle) < 0.0f) out = -out;
        const auto hits = [&](const Vec3f& from, const Vec3f& direction, float length) {
          return query_.occluded({from, direction, 0.0f, length}, counters_, Counter::RaysProbe,
                                 kOpaque | kAlpha);
        };
        met += hits(at + step * (out + normal), -normal, 2.0f * step) ||
                       hits(at + step * (normal - out), out, 2.0f * step) ||
                       hits(at - step * (normal + out), out, 2.0f * step)
                   ? 1
                   : 0;
      }
    return met >= kRim * 4 * kPoints;
  }

  /// Is nothing in the plane of a rectangle?
  bool clear(const HoleCandidate& hole) {
    constexpr int kPoints = 8;  // each way
    const auto& c = hole.corners;
    const Vec3f u = c[1] - c[0], v = c[3] - c[0], normal = u.cross(v).normalized();
    const float step = 0.01f * std::min(u.norm(), v.norm());
    int open = 0;
    for (int i = 0; i < kPoints * kPoints; ++i) {
      const int row = i / kPoints, column = i % kPoints;
      const Vec3f at = c[0] + (static_cast<float>(column) + 0.5f) / kPoints * u +
                       (static_cast<float>(row) + 0.5f) / kPoints * v;
      const Ray ray{at - step * normal, normal, 0.0f, 2.0f * step};
      open += query_.occluded(ray, counters_, Counter::RaysProbe, kOpaque | kAlpha) ? 0 : 1;
    }
    return open >= kRim * kPoints * kPoints;
  }

  // The second sheet of a double glazing, a pane in an opening that was named, a hole with panes.
  bool known(const Piece& opening) const {
    const Vec3f normal = opening.normal(), center = opening.center();
    const float size = static_cast<float>(std::sqrt(opening.area));
    Eigen::AlignedBox3f box;
    for (const auto& t : opening.triangles)
      for (const Vec3f& c : t) box.extend(c);
    box = Eigen::AlignedBox3f(box.min() - Vec3f::Constant(0.02f * size),
                              box.max() + Vec3f::Constant(0.02f * size));
    double area = 0.0;
    for (const Piece& other : taken_) {
      if (std::abs(other.normal().dot(normal)) < 0.99f) continue;
      const float before = normal.dot(other.center() - center);
      if (std::abs(before) < 0.2f * size && box.contains(Vec3f(other.center() - before * normal)))
        area += other.area;
    }
    return area > 0.5 * opening.area;
  }

  const RayQuery& query_;
  const Scene& scene_;
  Counters counters_;
  float margin_ = 0.0f;
  std::vector<Piece> taken_;
  std::vector<Opening> openings_;
};

bool has_sky(const Scene& scene) {
  return (scene.environment && material::max_value(scene.environment->radiance) > 0.0) ||
         std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
           return std::holds_alternative<DirectionalLight>(light.kind);
         });
}

}  // namespace

std::vector<Opening> find_openings(const RayQuery& query) {
  return has_sky(query.scene()) ? Finder(query).find() : std::vector<Opening>();
}

std::vector<Portal> find_portals(const RayQuery& query) {
  std::vector<Portal> portals;
  for (const Opening& o : find_openings(query))
    portals.insert(portals.end(), o.portals.begin(), o.portals.end());
  return portals;
}

}  // namespace atrium::scene
