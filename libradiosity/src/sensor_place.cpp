#include "sensor_place.h"

#include <algorithm>

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

}  // namespace atrium::radiosity
