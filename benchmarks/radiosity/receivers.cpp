#include "receivers.h"

#include <algorithm>

#include "scene/sampler.h"

namespace atrium::bench {
namespace {

using scene::ObjectId;
using scene::Side;
using scene::SurfaceField;

/// Draws triangles by their area.
class AreaChoice {
 public:
  explicit AreaChoice(const Workload& workload) {
    const scene::Scene& scene = workload.scene();
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const ObjectId id(o);
      const std::size_t count = scene.mesh_of(id).triangles.size();
      for (std::uint32_t t = 0; t < count; ++t) {
        const scene::SurfacePoint p = scene::surface_point(scene, id, t, 0.3f, 0.3f);
        if (!workload.shading().interact(p, p.ng).bsdf.has(material::kDiffuseReflection)) continue;
        const std::array<Vec3f, 3> c = scene.corners(id, t);
        const Vec3d normal = (c[1] - c[0]).cast<double>().cross((c[2] - c[0]).cast<double>());
        total_ += 0.5 * normal.norm();
        until_.push_back(total_);
        triangles_.push_back({id, t});
      }
    }
  }

  scene::SurfacePoint sample(const scene::Scene& scene, float choice, const Vec2f& u) const {
    const double x = static_cast<double>(choice) * total_;
    const auto it = std::min(std::upper_bound(until_.begin(), until_.end(), x), until_.end() - 1);
    const auto& [object, triangle] = triangles_[static_cast<std::size_t>(it - until_.begin())];
    const float root = std::sqrt(u.x());
    return scene::surface_point(scene, object, triangle, root * (1.0f - u.y()), root * u.y());
  }

 private:
  std::vector<double> until_;
  std::vector<std::pair<ObjectId, std::uint32_t>> triangles_;
  double total_ = 0.0;
};

bool can_be_lit(const Workload& workload, const scene::SurfacePoint& point, std::uint64_t seed,
                std::uint32_t stream) {
  constexpr std::uint32_t kRays = 32;
  scene::Counters unused;
  int fronts = 0;
  int backs = 0;
  int sky = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    scene::Sampler sampler(seed ^ 0xbacU, stream, k);
    const Vec3f w =
        Frame(point.ng).to_world(sample_cosine_hemisphere(sampler.next_2d())).normalized();
    const auto hit = workload.shading().closest({scene::offset_origin(point, w), w}, unused,
                                                scene::Counter::RaysProbe);
    if (!hit)
      ++sky;
    else
      ++(hit->ng.dot(w) < 0.0f ? fronts : backs);
  }
  if (backs > static_cast<int>(kRays) / 2) return false;
  return fronts > 0 || (sky > 0 && workload.scene().environment);
}

/// Barycentric coordinates of corners 1 and 2, kept inside the triangle.
Vec2f barycentric(const std::array<Vec3f, 3>& c, const Vec3f& p) {
  const Vec3d e1 = (c[1] - c[0]).cast<double>();
  const Vec3d e2 = (c[2] - c[0]).cast<double>();
  const Vec3d d = (p - c[0]).cast<double>();
  const Vec3d n = e1.cross(e2);
  const double u = std::clamp(d.cross(e2).dot(n) / n.squaredNorm(), 0.0, 1.0);
  const double v = std::clamp(e1.cross(d).dot(n) / n.squaredNorm(), 0.0, 1.0 - u);
  return {static_cast<float>(u), static_cast<float>(v)};
}

std::vector<Receiver> choose_points(const Workload& workload, std::size_t count,
                                    std::uint64_t seed) {
  const AreaChoice area(workload);
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; receivers.size() < count; ++i) {
    scene::Sampler sampler(seed ^ 0x4eceU, 0, i);
    const float choice = sampler.next_1d();
    const scene::SurfacePoint p = area.sample(workload.scene(), choice, sampler.next_2d());
    if (can_be_lit(workload, p, seed, i)) receivers.emplace_back(p);
  }
  return receivers;
}

std::vector<Receiver> choose_patches(const Workload& workload, std::size_t count, double size,
                                     std::uint64_t seed) {
  constexpr std::uint32_t kLooks = 8;
  const radiosity::Elements grid =
      radiosity::make_elements(workload.scene(), {.element_size = size, .max_elements = 10000000});
  std::vector<double> until;
  double total = 0.0;
  for (const float area : grid.layout.element_area)
    until.push_back(total += static_cast<double>(area));
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; receivers.size() < count; ++i) {
    scene::Sampler sampler(seed ^ 0x9a7cU, 0, i);
    const double x = static_cast<double>(sampler.next_1d()) * total;
    const auto it = std::min(std::upper_bound(until.begin(), until.end(), x), until.end() - 1);
    const auto e = static_cast<std::size_t>(it - until.begin());
    std::vector<radiosity::ElementPiece> pieces;
    for (std::size_t k = grid.first_piece[e]; k < grid.first_piece[e + 1]; ++k)
      pieces.push_back(grid.pieces[k]);
    const Receiver r(pieces);
    bool lit = true;
    for (std::uint32_t k = 0; k < kLooks && lit; ++k) {
      scene::Sampler look(seed ^ 0x100cU, i, k);
      lit = can_be_lit(workload, r.sample(workload.scene(), look.next_2d()), seed, i * kLooks + k);
    }
    if (lit) receivers.push_back(r);
  }
  return receivers;
}

}  // namespace

Receiver::Receiver(const std::vector<radiosity::ElementPiece>& pieces) {
  double total = 0.0;
  for (const radiosity::ElementPiece& piece : pieces)
    for (std::size_t k = 1; k + 1 < piece.corners.size(); ++k) {
      const std::array<Vec3f, 3> c = {piece.corners[0], piece.corners[k], piece.corners[k + 1]};
      total += static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
      triangles_.push_back({piece.object, piece.triangle, c, total});
    }
}

scene::SurfacePoint Receiver::sample(const scene::Scene& scene, const Vec2f& u) const {
  if (is_point()) return point_;
  const double x = static_cast<double>(u.x()) * triangles_.back().area_until;
  const auto it =
      std::min(std::upper_bound(triangles_.begin(), triangles_.end(), x,
                                [](double a, const Part& b) { return a < b.area_until; }),
               triangles_.end() - 1);
  const double before = it == triangles_.begin() ? 0.0 : (it - 1)->area_until;
  const double share = it->area_until > before ? (x - before) / (it->area_until - before) : 0.5;
  const float root = std::sqrt(static_cast<float>(std::clamp(share, 0.0, 1.0)));
  const Vec3f p = it->corners[0] * (1.0f - root) + it->corners[1] * (root * (1.0f - u.y())) +
                  it->corners[2] * (root * u.y());
  const Vec2f b = barycentric(scene.corners(it->object, it->triangle), p);
  return scene::surface_point(scene, it->object, it->triangle, b.x(), b.y());
}

std::vector<Receiver> choose_receivers(const Workload& workload, std::size_t count, double size,
                                       std::uint64_t seed) {
  return size > 0.0 ? choose_patches(workload, count, size, seed)
                    : choose_points(workload, count, seed);
}

namespace {

double value(const std::vector<float>& array, std::uint32_t element) {
  return array.empty() ? 0.0 : static_cast<double>(array[element * 2]);
}

double read(const Workload& workload, const SurfaceField& field, const scene::SurfacePoint& p,
            Reading reading) {
  const SurfaceField::Quantities& q = field.irradiance;
  if (reading == Reading::Interpolated) {
    const auto s = field.stencil(workload.scene(), p.object, p.triangle, p.position, Side::Front);
    return static_cast<double>((field.interpolate<1>(q.direct, s, Side::Front) +
                                field.interpolate<1>(q.caustic, s, Side::Front) +
                                field.interpolate<1>(q.indirect, s, Side::Front))
                                   .mean());
  }
  const std::uint32_t e = field.element_at(workload.scene(), p.object, p.triangle, p.position);
  if (e == SurfaceField::kNone) return 0.0;
  return value(q.direct, e) + value(q.caustic, e) + value(q.indirect, e);
}

}  // namespace

std::vector<double> read_field(const Workload& workload, const SurfaceField& field,
                               const std::vector<Receiver>& receivers, Reading reading) {
  constexpr std::uint32_t kPoints = 64;
  std::vector<double> values;
  values.reserve(receivers.size());
  for (const Receiver& r : receivers) {
    const std::uint32_t points = r.is_point() ? 1 : kPoints;
    double sum = 0.0;
    for (std::uint32_t k = 0; k < points; ++k) {
      scene::Sampler sampler(0x4eadU, static_cast<std::uint32_t>(values.size()), k);
      sum += read(workload, field, r.sample(workload.scene(), sampler.next_2d()), reading);
    }
    values.push_back(sum / points);
  }
  return values;
}

}  // namespace atrium::bench
