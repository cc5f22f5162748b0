#pragma once

#include "problem.h"

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

}  // namespace atrium::radiosity
