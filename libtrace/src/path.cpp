#include "attribution.h"
#include "integrator.h"
#include "scene/roulette.h"

namespace atrium::trace {

using scene::Counter;
using namespace material;

namespace {

constexpr int kRouletteDepth = 6;

template <int N>
void sample_light(const View<N>& view, const scene::Interaction<N>& surface, const Vec3f& wo,
                  const Spectrum<N>& beta, const Attribution<N>& attribution, PixelSample<N>& out,
                  scene::Sampler& sampler, scene::Counters& counters) {
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  if (!surface.bsdf.has(kDiffuseEvents | kLobeEvents)) return;
  const auto light =
      view.shading.lights().sample(surface.point.position, light_normal(surface), u_choice, u);
  if (!light) return;
  const Vec3f wi = surface.to_local(light->wi);
  if ((wi.z() > 0.0f) != (light->wi.dot(surface.ng) > 0.0f)) return;
  const BsdfValue<N> f = surface.bsdf.eval(wo, wi);
  Spectrum<N> contribution = f.sum() * light->radiance * beta * (std::abs(wi.z()) / light->pdf);
  if (contribution.is_zero()) return;
  contribution *= view.shading.visibility(surface.point, *light, counters, Counter::RaysShadow);
  if (!light->dirac) contribution *= mis_weight(light->pdf, surface.bsdf.pdf(wo, wi));
  attribution.add_direct(out, f, wi.z() > 0.0f, contribution);
}

}  // namespace

template <int N>
PixelSample<N> trace_path(const View<N>& view, const scene::Ray& camera_ray,
                          scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  PixelSample<N> out;
  Attribution<N> attribution(view.options.classes);
  ScatterVertex vertex;
  scene::MediumStack media;
  Spectrum<N> beta = Spectrum<N>::one();
  scene::Ray ray = camera_ray;
  Counter kind = Counter::RaysPrimary;
  float eta_scale = 1.0f;  // undoes the (n1/n2)^2 of radiance inside a solid, for roulette
  int scattered = 0;       // events after the first surface, straight panes apart

  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      const Spectrum<N> sky = sky_radiance(shading, ray);
      if (!sky.is_zero())
        attribution.add(out, beta * sky * environment_weight(shading, vertex, ray.direction),
                        scattered == 1);
      break;
    }
    const Vec3f wo_world = -ray.direction;
    const scene::Interaction<N> surface = shading.interact(*hit, wo_world);
    const Vec3f wo = surface.to_local(wo_world);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
    }
    const Spectrum<N> emitted = shading.lights().emitted(*hit, wo_world);
    if (!emitted.is_zero())
      attribution.add(out, beta * emitted * emission_weight(shading, vertex, *hit), scattered == 1);

    sample_light(view, surface, wo, beta, attribution, out, sampler, counters);

    const float u_choice = sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    const auto s = surface.bsdf.sample(wo, u_choice, u);
    if (!s) break;
    const Vec3f wi = surface.to_world(s->wi);
    if ((s->wi.z() > 0.0f) != (wi.dot(surface.ng) > 0.0f))
      break;  // shading normal against the surface
    if (s->dirac())
      attribution.pass(s->event);
    else if (attribution.open())
      attribution.scatter(s->event, surface.bsdf.eval(wo, s->wi));
    beta *= s->weight;
    pass_surface(media, surface, s->event);
    if ((s->event & (kRefraction | kLobeTransmission)) != 0)
      eta_scale *= surface.bsdf.eta() * surface.bsdf.eta();
    if (s->event != kPaneStraight) {
      ++scattered;
      vertex = {!s->dirac(), hit->position, light_normal(surface), s->pdf};
    }
    if (depth >= kRouletteDepth) {
      const float survive = std::min(scene::long_path_survival(scattered), beta.max() * eta_scale);
      if (!(sampler.next_1d() < survive)) break;
      beta /= survive;
    }
    ray = {scene::offset_origin(*hit, wi), wi};
    kind = (s->event & kDiffuseEvents) != 0 ? Counter::RaysPath : Counter::RaysSpecular;
  }
  return out;
}

template PixelSample<1> trace_path<1>(const View<1>&, const scene::Ray&, scene::Sampler&,
                                      scene::Counters&);
template PixelSample<3> trace_path<3>(const View<3>&, const scene::Ray&, scene::Sampler&,
                                      scene::Counters&);
template PixelSample<4> trace_path<4>(const View<4>&, const scene::Ray&, scene::Sampler&,
                                      scene::Counters&);
template PixelSample<8> trace_path<8>(const View<8>&, const scene::Ray&, scene::Sampler&,
                                      scene::Counters&);

}  // namespace atrium::trace
