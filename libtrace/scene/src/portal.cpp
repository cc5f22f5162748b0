#include "scene/portal.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "material/error.h"
#include "scene/sampler.h"

namespace atrium::scene {
namespace {

constexpr int kOpennessRays = 128;
constexpr int kRoomRays = 512;
constexpr double kLeastOutside = 0.02;      ///< share of an open half space that a window must see
constexpr double kMostInside = 0.5;         ///< share inside, relative to outside
constexpr std::size_t kMostTriangles = 64;  ///< of a pane; a finer mesh is no plain window

/// A flat piece: an object or a polygon.
struct Opening {
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

  std::vector<Portal> find() {
    for (const std::vector<Vec3d>& polygon : scene_.portals.polygons) take_polygon(polygon);
    for (const std::string& name : scene_.portals.objects) take_named(name);
    if (scene_.portals.find)
      for (std::size_t i = 0; i < scene_.objects.size(); ++i) try_pane(ObjectId(i));
    return std::move(portals_);
  }

 private:
  // Rays into the half space around `normal`, cosine distributed, from points of the opening.
  template <class F>
  void rays(const Opening& opening, const Vec3f& normal, int count, F&& f) {
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
  double openness(const Opening& opening, const Vec3f& normal) {
    int open = 0;
    rays(opening, normal, kOpennessRays, [&](const Ray& ray) {
      open += query_.occluded(ray, counters_, Counter::RaysProbe, kOpaque | kAlpha) ? 0 : 1;
    });
    return static_cast<double>(open) / kOpennessRays;
  }

  void take(const Opening& opening, bool certain) {
    if (opening.triangles.empty()) return;
    Vec3f inwards = opening.normal();
    double inside = openness(opening, inwards), outside = openness(opening, -inwards);
    if (inside > outside) {
      inwards = -inwards;
      std::swap(inside, outside);
    }
    if (!certain && !(outside >= kLeastOutside && inside <= kMostInside * outside)) return;
    Eigen::AlignedBox3f room;
    rays(opening, inwards, kRoomRays, [&](const Ray& ray) {
      if (const auto hit = query_.closest(ray, counters_, Counter::RaysProbe, kOpaque | kAlpha))
        room.extend(Vec3f(ray.origin + hit->t * ray.direction));
    });
    for (const auto& t : opening.triangles)
      for (const Vec3f& c : t) room.extend(c);
    const Vec3f pad = Vec3f::Constant(0.02f * room.diagonal().norm() + margin_);
    room = Eigen::AlignedBox3f(room.min() - pad, room.max() + pad);
    for (std::array<Vec3f, 3> t : opening.triangles) {
      if ((t[1] - t[0]).cross(t[2] - t[0]).dot(inwards) < 0.0f) std::swap(t[1], t[2]);
      portals_.push_back({t, room});
    }
    taken_.push_back(opening);
  }

  void take_polygon(const std::vector<Vec3d>& polygon) {
    Opening opening;
    for (std::size_t k = 2; k < polygon.size(); ++k)
      opening.add(
          {polygon[0].cast<float>(), polygon[k - 1].cast<float>(), polygon[k].cast<float>()});
    take(opening, true);
  }

  Opening opening_of(ObjectId id) const {
    Opening opening;
    const std::size_t count = scene_.mesh_of(id).triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      opening.add(scene_.corners(id, static_cast<std::uint32_t>(t)));
    return opening;
  }

  void take_named(const std::string& name) {
    bool found = false;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      if (scene_.objects[i].name != name) continue;
      const Opening opening = opening_of(ObjectId(i));
      if (opening.triangles.empty()) continue;
      if (!opening.flat()) throw Error("portals: the object '" + name + "' is not flat");
      found = true;
      take(opening, true);
    }
    if (!found) throw Error("portals: there is no object '" + name + "'");
  }

  void try_pane(ObjectId id) {
    const material::Material& m = scene_.material_of(id);
    const std::size_t count = scene_.mesh_of(id).triangles.size();
    if (m.medium != material::Material::Medium::Pane || count == 0 || count > kMostTriangles)
      return;
    const Opening opening = opening_of(id);
    if (!opening.triangles.empty() && opening.flat() && !known(opening)) take(opening, false);
  }

  // The second sheet of a double glazing, or a pane in an opening that was named.
  bool known(const Opening& opening) const {
    const float size = static_cast<float>(std::sqrt(opening.area));
    return std::any_of(taken_.begin(), taken_.end(), [&](const Opening& other) {
      return std::abs(other.normal().dot(opening.normal())) > 0.99f &&
             (other.center() - opening.center()).norm() < 0.2f * size &&
             other.area > 0.8 * opening.area;
    });
  }

  const RayQuery& query_;
  const Scene& scene_;
  Counters counters_;
  float margin_ = 0.0f;
  std::vector<Opening> taken_;
  std::vector<Portal> portals_;
};

bool has_sky(const Scene& scene) {
  return (scene.environment && material::max_value(scene.environment->radiance) > 0.0) ||
         std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
           return std::holds_alternative<DirectionalLight>(light.kind);
         });
}

}  // namespace

std::vector<Portal> find_portals(const RayQuery& query) {
  return has_sky(query.scene()) ? Finder(query).find() : std::vector<Portal>();
}

}  // namespace atrium::scene
