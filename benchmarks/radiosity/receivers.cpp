#include "receivers.h"

#include <algorithm>

#include "scene/parallel.h"
#include "scene/sampler.h"

namespace atrium::measure {
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

}  // namespace

std::vector<Receiver> choose_receivers(const Workload& workload, std::size_t count,
                                       std::uint64_t seed) {
  const AreaChoice area(workload);
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; receivers.size() < count; ++i) {
    scene::Sampler sampler(seed ^ 0x4eceU, 0, i);
    const float choice = sampler.next_1d();
    const scene::SurfacePoint p = area.sample(workload.scene(), choice, sampler.next_2d());
    if (can_be_lit(workload, p, seed, i)) receivers.push_back({p});
  }
  return receivers;
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
  std::vector<double> values;
  values.reserve(receivers.size());
  for (const Receiver& r : receivers) values.push_back(read(workload, field, r.point, reading));
  return values;
}

}  // namespace atrium::measure
