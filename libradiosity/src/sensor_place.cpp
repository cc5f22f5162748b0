#include "sensor_place.h"

#include <algorithm>

#include "scene/sampler.h"

namespace atrium::radiosity {

using scene::Counter;

SensorPlace place_sensor(const scene::RayQuery& query, const Sensor& sensor,
                         scene::Counters& counters) {
  const scene::Scene& scene = query.scene();
  SensorPlace place{.position = sensor.position - scene.origin,
                    .normal = sensor.normal,
                    .origin = {},
                    .surface = {}};
  const Vec3f normal = place.normal.cast<float>();
  const Vec3f p = place.position.cast<float>();
  const float size = static_cast<float>(scene.bounds.diagonal().norm());
  // As the error of a surface point: what rounding does to coordinates of this magnitude.
  const float rounding = 28.0f * 0x1p-24f * std::max(p.cwiseAbs().maxCoeff(), size);
  const float reach = std::max(1e-5f * size, 2.0f * rounding);
  const auto hit = query.closest({p + reach * normal, -normal, 0.0f, 2.0f * reach}, counters,
                                 Counter::RaysProbe);
  if (!hit) {
    place.origin = p;
    return place;
  }
  const scene::SurfacePoint surface = scene::surface_point(scene, *hit);
  place.side = surface.ng.dot(normal) >= 0.0f ? scene::Side::Front : scene::Side::Back;
  const Vec3f up = place.side == scene::Side::Front ? surface.ng : Vec3f(-surface.ng);
  place.surface = surface;
  place.origin = scene::offset_origin(surface, up);
  return place;
}

bool inside_solid(const scene::RayQuery& query, const std::vector<std::uint8_t>& closed_opaque,
                  const SensorPlace& place, scene::Counters& counters) {
  if (std::find(closed_opaque.begin(), closed_opaque.end(), 1) == closed_opaque.end()) return false;
  constexpr std::uint32_t kRays = 33;
  std::uint32_t inside = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    scene::Sampler sampler(0x501d, 0, k);
    // On a surface only one side is asked: what is below it does not matter.
    const Vec3f up = place.normal.cast<float>();
    const Vec3f local = sample_cosine_hemisphere(sampler.next_2d());
    const bool flip = !place.surface && (k & 1U) != 0;
    const Vec3f direction = Frame(up).to_world(flip ? Vec3f(-local) : local).normalized();
    const auto hit = query.closest({place.origin, direction}, counters, Counter::RaysProbe);
    if (!hit || closed_opaque[hit->object.value] == 0) continue;
    const scene::SurfacePoint point = scene::surface_point(query.scene(), *hit);
    inside += point.ng.dot(direction) > 0.0f ? 1 : 0;
  }
  return 2 * inside > kRays;
}

}  // namespace atrium::radiosity
