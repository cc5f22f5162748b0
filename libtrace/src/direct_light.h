#pragma once

#include "gather_directions.h"
#include "integrator.h"

namespace atrium::trace {

/// Light sources as seen from a point. Body and lobe have different rivals among the sampled
/// directions: gather rays for the body (if there are any), specular rays for the lobe.
template <int N>
struct DirectLight {
  Spectrum<N> reflected, transmitted;
  Spectrum<N> body;  ///< share of `reflected` by the body
  Spectrum<N> lobe;  ///< share of both by the lobe
};
enum class Lobes { Counted, LeftToCaustics };
template <int N>
DirectLight<N> direct_light(const View<N>& view, const scene::Interaction<N>& surface,
                            const Vec3f& wo, const GatherDirections<N>* gathers, Lobes lobes,
                            scene::Sampler& sampler, scene::Counters& counters) {
  DirectLight<N> d;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  if (!surface.bsdf.has(material::kDiffuseEvents | material::kLobeEvents)) return d;
  const auto light =
      view.shading.lights().sample(surface.point.position, light_normal(surface), u_choice, u);
  if (!light) return d;
  const Vec3f wi = surface.to_local(light->wi);
  if ((wi.z() > 0.0f) != (light->wi.dot(surface.ng) > 0.0f)) return d;
  material::BsdfValue<N> f = surface.bsdf.eval(wo, wi);
  if (lobes == Lobes::LeftToCaustics) f.lobe = Spectrum<N>::zero();
  if (!light->dirac) {
    if (gathers != nullptr) f.diffuse *= mis_weight(light->pdf, gathers->pdf(wi));
    if (!f.lobe.is_zero())
      f.lobe *= mis_weight(light->pdf, surface.bsdf.pdf(wo, wi, material::kSpecularEvents));
  }
  const Spectrum<N> unoccluded = light->radiance * (std::abs(wi.z()) / light->pdf);
  if ((f.sum() * unoccluded).is_zero()) return d;
  const Spectrum<N> arriving = unoccluded * view.shading.visibility(surface.point, *light, counters,
                                                                    scene::Counter::RaysShadow);
  (wi.z() > 0.0f ? d.reflected : d.transmitted) = f.sum() * arriving;
  if (wi.z() > 0.0f) d.body = f.diffuse * arriving;
  d.lobe = f.lobe * arriving;
  return d;
}

}  // namespace atrium::trace
