#pragma once

#include "hot_patches.h"

namespace atrium::radiosity {

/// A ray from a random point of a side in a cosine-distributed direction of its hemisphere.
template <int N>
struct HemisphereRay {
  scene::Ray ray;
  float cosine = 0.0f;                           ///< at the receiver
  Spectrum<N> body_weight = Spectrum<N>::one();  ///< of the direction in E_B

  HemisphereRay(const Problem<N>& problem, SideIndex side, scene::Sampler& sampler) {
    const scene::SurfacePoint p = problem.points.sample(side / 2, sampler.next_2d());
    const Vec3f normal = side_of(side) == scene::Side::Front ? p.ng : Vec3f(-p.ng);
    const Vec3f local = sample_cosine_hemisphere(sampler.next_2d());
    cosine = local.z();
    ray.direction = Frame(normal).to_world(local).normalized();
    ray.origin = scene::offset_origin(p, ray.direction);
    if (problem.sides.coupled[side / 2] != 0)
      body_weight = problem.shading.interact(p, normal).bsdf.body_weight(local.z());
  }
};

/// Does a ray from a point of a side start inside a closed opaque body? One ray decides.
template <int N>
[[nodiscard]] bool is_buried(const Problem<N>& problem, const scene::SurfacePoint& p,
                             const Vec3f& normal, const Vec2f& u, scene::Counters& counters) {
  const Vec3f w = Frame(normal).to_world(sample_cosine_hemisphere(u)).normalized();
  const auto hit = problem.shading.closest({scene::offset_origin(p, w), w}, counters,
                                           scene::Counter::RaysProbe);
  return hit && hit->ng.dot(w) > 0.0f && problem.sides.closed_opaque[hit->object.value] != 0;
}

/// HotPatches::share_of_chance for the point that a hemisphere ray hit, straight or through panes.
template <int N>
[[nodiscard]] float share_of_chance(const HotPatches<N>& hot, const HemisphereRay<N>& start,
                                    const Vec3f& position, const Vec3f& normal, SideIndex j) {
  if (!hot.contains(j)) return 1.0f;
  return hot.share_of_chance(j, position - start.ray.origin, start.cosine,
                             std::abs(normal.dot(start.ray.direction)));
}

}  // namespace atrium::radiosity
