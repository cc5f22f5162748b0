#pragma once

#include <functional>

#include "physics/radiosity_support.h"
#include "scene/surface_field.h"

// Two rooms under one shell whose floor, ceiling and long walls run through both; a lamp in the
// left one. Whatever parts them, no light may be found outside the left one.
namespace atrium::test {

struct Box {
  Vec3f low, high;
  [[nodiscard]] bool contains(const Vec3f& p) const {
    return (p.array() > low.array()).all() && (p.array() < high.array()).all();
  }
};

inline const Box kShell{{-2, 0, 0}, {2.1f, 3, 2.5f}};
constexpr float kWall = 0.03f;  // where the left room ends; no multiple of a cell
inline const Box kLeft{{-2, 0, 0}, {kWall, 3, 2.5f}};
constexpr double kReflectance = 0.6;
constexpr double kIntensity = 10.0;

// Corner k of a box is (k & 1, k & 2, k & 4); wound outwards unless `inside_out`.
inline void add_box(SceneMaker& maker, scene::MaterialId m, const Box& b, bool inside_out = false) {
  std::vector<Vec3f> p;
  for (int k = 0; k < 8; ++k)
    p.emplace_back((k & 1) != 0 ? b.high.x() : b.low.x(), (k & 2) != 0 ? b.high.y() : b.low.y(),
                   (k & 4) != 0 ? b.high.z() : b.low.z());
  std::vector<scene::Triangle> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  if (inside_out)
    for (scene::Triangle& v : t) std::swap(v[1], v[2]);
  maker.object(m, std::move(p), std::move(t), true);
}

using Partition = std::function<void(SceneMaker&, scene::MaterialId)>;

inline scene::Scene two_rooms(const Partition& partition) {
  SceneMaker maker;
  const scene::MaterialId white = maker.material(diffuse(kReflectance));
  maker.room(kShell.low, kShell.high, white);
  partition(maker, white);
  maker.point_light({-1.1, 1.4, 1.7}, kIntensity);
  return maker.take();
}

/// Total irradiance interpolated at the surface that a ray meets.
inline double look(const Solved& s, const Vec3f& from, const Vec3f& direction) {
  scene::Counters counters;
  const auto hit = s.query.closest({from, direction}, counters, scene::Counter::RaysProbe);
  if (!hit) return 0.0;
  const scene::SurfacePoint p = scene::surface_point(s.scene, *hit);
  const scene::Side side = p.ng.dot(direction) < 0.0f ? scene::Side::Front : scene::Side::Back;
  const auto& f = s.result.field;
  const auto stencil = f.stencil(s.scene, p.object, p.triangle, p.position, side);
  double sum = 0.0;
  for (const auto* q : {&f.irradiance.direct, &f.irradiance.caustic, &f.irradiance.indirect})
    sum += static_cast<double>(f.interpolate<1>(*q, stencil, side)[0]);
  return sum;
}

}  // namespace atrium::test
