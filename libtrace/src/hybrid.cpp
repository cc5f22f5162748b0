#include <numbers>

#include "integrator.h"
#include "scene/roulette.h"

namespace atrium::trace {

using scene::Counter;
using scene::Side;
using scene::SurfaceField;
using namespace material;

namespace {

constexpr int kRouletteDepth = 4;
constexpr float kInvPi = std::numbers::inv_pi_v<float>;

Side other(Side side) { return side == Side::Front ? Side::Back : Side::Front; }

/// Which parts of the stored irradiance a look-up sums.
struct Parts {
  bool direct, caustic, indirect;
};

template <int N>
Spectrum<N> stored(const SurfaceField& field, const SurfaceField::Quantities& q,
                   const SurfaceField::Stencil& s, Side side, Parts parts) {
  Spectrum<N> e;
  if (parts.direct) e += field.interpolate<N>(q.direct, s, side);
  if (parts.caustic) e += field.interpolate<N>(q.caustic, s, side);
  if (parts.indirect) e += field.interpolate<N>(q.indirect, s, side);
  return e;
}

/// Edge of the element at a point [m]; 0 where there is none.
float element_size(const SurfaceField& field, const scene::Scene& scene,
                   const scene::SurfacePoint& p) {
  const std::uint32_t e = field.element_at(scene, p.object, p.triangle, p.position);
  return e == SurfaceField::kNone ? 0.0f : field.element_size(e);
}

/// Radiance towards the viewer that the field gives at a point, by reflection and by transmission
/// of what arrives on the other side.
template <int N>
struct FieldRadiance {
  Spectrum<N> reflected, transmitted;
};
template <int N>
FieldRadiance<N> field_radiance(const View<N>& view, const scene::Interaction<N>& surface,
                                const Vec3f& wo, Parts parts) {
  FieldRadiance<N> r;
  if (view.field.empty() || !surface.bsdf.has(kDiffuseEvents)) return r;
  const scene::SurfacePoint& p = surface.point;
  const auto irradiance = [&](Side side, const SurfaceField::Quantities& q) {
    const auto s = view.field.stencil(view.shading.scene(), p.object, p.triangle, p.position, side);
    return stored<N>(view.field, q, s, side, parts);
  };
  if (surface.bsdf.has(kDiffuseReflection)) {
    const auto& q = surface.bsdf.coupled() ? view.field.body_irradiance : view.field.irradiance;
    r.reflected = surface.bsdf.diffuse_reflectance(wo) * irradiance(surface.side, q) * kInvPi;
  }
  if (surface.bsdf.has(kDiffuseTransmission))
    r.transmitted = surface.bsdf.diffuse_transmittance() *
                    irradiance(other(surface.side), view.field.irradiance) * kInvPi;
  return r;
}

/// Light sources as seen from a point. Body and lobe have different rivals among the sampled
/// directions: gather rays for the body (if there are any), specular rays for the lobe.
template <int N>
struct DirectLight {
  Spectrum<N> reflected, transmitted;
  Spectrum<N> body;  ///< share of `reflected` by the body
};
enum class Lobes { Counted, LeftToCaustics };
template <int N>
DirectLight<N> direct_light(const View<N>& view, const scene::Interaction<N>& surface,
                            const Vec3f& wo, bool gathers, Lobes lobes, scene::Sampler& sampler,
                            scene::Counters& counters) {
  DirectLight<N> d;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  if (!surface.bsdf.has(kDiffuseEvents | kLobeEvents)) return d;
  const auto light =
      view.shading.lights().sample(surface.point.position, light_normal(surface), u_choice, u);
  if (!light) return d;
  const Vec3f wi = surface.to_local(light->wi);
  if ((wi.z() > 0.0f) != (light->wi.dot(surface.ng) > 0.0f)) return d;
  BsdfValue<N> f = surface.bsdf.eval(wo, wi);
  if (lobes == Lobes::LeftToCaustics) f.lobe = Spectrum<N>::zero();
  if (!light->dirac) {
    if (gathers) f.diffuse *= mis_weight(light->pdf, surface.bsdf.pdf(wo, wi, kDiffuseEvents));
    if (!f.lobe.is_zero())
      f.lobe *= mis_weight(light->pdf, surface.bsdf.pdf(wo, wi, kSpecularEvents));
  }
  const Spectrum<N> unoccluded = light->radiance * (std::abs(wi.z()) / light->pdf);
  if ((f.sum() * unoccluded).is_zero()) return d;
  const Spectrum<N> arriving =
      unoccluded * view.shading.visibility(surface.point, *light, counters, Counter::RaysShadow);
  (wi.z() > 0.0f ? d.reflected : d.transmitted) = f.sum() * arriving;
  if (wi.z() > 0.0f) d.body = f.diffuse * arriving;
  return d;
}

/// A specular step of a path: direction, throughput and the vertex for emission beyond it.
/// `scattered` counts those that are no straight passages through panes.
template <int N>
bool specular_step(const scene::Interaction<N>& surface, const Vec3f& wo, int depth, int& scattered,
                   scene::MediumStack& media, scene::Ray& ray, Spectrum<N>& beta,
                   ScatterVertex& vertex, Event& event, scene::Sampler& sampler) {
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = surface.bsdf.sample(wo, u_choice, u, kSpecularEvents);
  if (!s) return false;
  const Vec3f wi = surface.to_world(s->wi);
  if ((s->wi.z() > 0.0f) != (wi.dot(surface.ng) > 0.0f)) return false;
  beta *= s->weight;
  pass_surface(media, surface, s->event);
  if (s->event != kPaneStraight) {
    ++scattered;
    vertex = {!s->dirac(), surface.point.position, light_normal(surface), s->pdf};
  }
  if (depth >= kRouletteDepth) {
    const float survive = std::min(scene::long_path_survival(scattered), beta.max());
    if (!(sampler.next_1d() < survive)) return false;
    beta /= survive;
  }
  event = s->event;
  ray = {scene::offset_origin(surface.point, wi), wi};
  return true;
}

/// One ray from a diffuse point into its hemisphere (or through the sheet): radiance that arrives,
/// times f cos / pdf. `straight` gets the share that comes directly from a light. `media`: the
/// bodies that the point is in.
template <int N>
struct Gathered {
  Spectrum<N> straight, indirect;
  bool reflected = true;
};
template <int N>
Gathered<N> gather(const View<N>& view, const scene::Interaction<N>& from, const Vec3f& wo_from,
                   scene::MediumStack media, scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  Gathered<N> g;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = from.bsdf.sample(wo_from, u_choice, u, kDiffuseEvents);
  if (!s) return g;
  const Vec3f wi = from.to_world(s->wi);
  if ((s->wi.z() > 0.0f) != (wi.dot(from.ng) > 0.0f)) return g;
  g.reflected = s->event == kDiffuseReflection;
  ScatterVertex vertex{true, from.point.position, light_normal(from), s->pdf};
  Spectrum<N> beta = s->weight;
  scene::Ray ray{scene::offset_origin(from.point, wi), wi};
  int scattered = 0;  // specular events, straight panes apart
  Counter kind = Counter::RaysGather;

  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      if (scattered == 0)
        g.straight +=
            beta * sky_radiance(shading, ray) * environment_weight(shading, vertex, ray.direction);
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    if (scattered == 0) {
      const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
      if (!emitted.is_zero()) g.straight += beta * emitted * emission_weight(shading, vertex, *hit);
    }
    // Closer than an element, its mean direct light is too coarse: look at the lights again.
    const bool close = depth == 0 && surface.bsdf.has(kDiffuseEvents) &&
                       distance < element_size(view.field, shading.scene(), *hit);
    const FieldRadiance<N> r = field_radiance(view, surface, wo, {!close, true, true});
    g.indirect += beta * (r.reflected + r.transmitted);
    if (close) {
      const DirectLight<N> d =
          direct_light(view, surface, wo, false, Lobes::LeftToCaustics, sampler, counters);
      g.indirect += beta * (d.reflected + d.transmitted);
    }
    Event event{};
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, event, sampler))
      break;
    kind = Counter::RaysSpecular;
  }
  return g;
}

}  // namespace

template <int N>
PixelSample<N> trace_hybrid(const View<N>& view, const scene::Ray& camera_ray,
                            scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  const bool has_field = view.options.method == Method::Hybrid && !view.field.empty();
  const bool gathers = has_field && view.options.indirect == Indirect::Gather;
  PixelSample<N> out;
  Spectrum<N> beta = Spectrum<N>::one();
  ScatterVertex vertex;
  scene::MediumStack media;
  scene::Ray ray = camera_ray;
  Counter kind = Counter::RaysPrimary;
  Event first{};      // what the first surface did
  Event last{};       // what the previous one did
  int scattered = 0;  // specular events, straight panes apart

  // Light that arrives along the specular chain belongs to the term of its first event.
  const auto add = [&](int depth, Term here, const Spectrum<N>& radiance) {
    out[depth == 0 ? here : term_of(first, false)] += beta * radiance;
  };
  const auto add_emission = [&](int depth, const Spectrum<N>& radiance) {
    const bool highlight = scattered == 1 && (first & kLobeEvents) != 0;
    out[depth == 0 ? Term::Emission : term_of(first, highlight)] += beta * radiance;
  };

  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      const Spectrum<N> sky = sky_radiance(shading, ray);
      if (!sky.is_zero())
        add_emission(depth, sky * environment_weight(shading, vertex, ray.direction));
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
      if (has_field) {
        const auto s = view.field.stencil(shading.scene(), hit->object, hit->triangle,
                                          hit->position, surface.side);
        out.irradiance =
            stored<N>(view.field, view.field.irradiance, s, surface.side, {true, true, true});
      }
    }
    const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
    if (!emitted.is_zero()) add_emission(depth, emitted * emission_weight(shading, vertex, *hit));

    const DirectLight<N> direct =
        direct_light(view, surface, wo, gathers, Lobes::Counted, sampler, counters);
    add(depth, Term::DirectReflection, direct.reflected);
    add(depth, Term::DirectTransmission, direct.transmitted);
    if (depth == 0) {
      out.position = hit->position;
      out.body_albedo = surface.bsdf.diffuse_reflectance(wo);
      out.body_direct = direct.body;
    }
    if (has_field && surface.bsdf.has(kDiffuseEvents)) {
      const FieldRadiance<N> r = field_radiance(view, surface, wo, {false, true, !gathers});
      add(depth, Term::IndirectReflection, r.reflected);
      add(depth, Term::IndirectTransmission, r.transmitted);
      // What the field knows needs no sharing: what samples find beside it has less shape.
      if (depth == 0 && gathers && view.options.share_samples)
        out.body_indirect -= field_radiance(view, surface, wo, {false, false, true}).reflected;
      if (gathers) {
        const Gathered<N> g = gather(view, surface, wo, media, sampler, counters);
        add(depth, g.reflected ? Term::DirectReflection : Term::DirectTransmission, g.straight);
        add(depth, g.reflected ? Term::IndirectReflection : Term::IndirectTransmission, g.indirect);
        if (depth == 0 && g.reflected) {
          out.body_direct += g.straight;
          out.body_indirect += g.indirect;
        }
      }
    }
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, last, sampler))
      break;
    if (depth == 0) first = last;
    kind = Counter::RaysSpecular;
  }
  return out;
}

template PixelSample<1> trace_hybrid<1>(const View<1>&, const scene::Ray&, scene::Sampler&,
                                        scene::Counters&);
template PixelSample<3> trace_hybrid<3>(const View<3>&, const scene::Ray&, scene::Sampler&,
                                        scene::Counters&);
template PixelSample<4> trace_hybrid<4>(const View<4>&, const scene::Ray&, scene::Sampler&,
                                        scene::Counters&);
template PixelSample<8> trace_hybrid<8>(const View<8>&, const scene::Ray&, scene::Sampler&,
                                        scene::Counters&);

}  // namespace atrium::trace
