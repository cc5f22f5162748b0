#include <numbers>

#include "gather_directions.h"
#include "integrator.h"
#include "scene/segment.h"

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
  if (!surface.bsdf.has(kDiffuseEvents | kLobeEvents)) return d;
  const auto light =
      view.shading.lights().sample(surface.point.position, light_normal(surface), u_choice, u);
  if (!light) return d;
  const Vec3f wi = surface.to_local(light->wi);
  if ((wi.z() > 0.0f) != (light->wi.dot(surface.ng) > 0.0f)) return d;
  BsdfValue<N> f = surface.bsdf.eval(wo, wi);
  if (lobes == Lobes::LeftToCaustics) f.lobe = Spectrum<N>::zero();
  if (!light->dirac) {
    if (gathers != nullptr) f.diffuse *= mis_weight(light->pdf, gathers->pdf(wi));
    if (!f.lobe.is_zero())
      f.lobe *= mis_weight(light->pdf, surface.bsdf.pdf(wo, wi, kSpecularEvents));
  }
  const Spectrum<N> unoccluded = light->radiance * (std::abs(wi.z()) / light->pdf);
  if ((f.sum() * unoccluded).is_zero()) return d;
  const Spectrum<N> arriving =
      unoccluded * view.shading.visibility(surface.point, *light, counters, Counter::RaysShadow);
  (wi.z() > 0.0f ? d.reflected : d.transmitted) = f.sum() * arriving;
  if (wi.z() > 0.0f) d.body = f.diffuse * arriving;
  d.lobe = f.lobe * arriving;
  return d;
}

/// A specular step of a path: direction, throughput and the vertex for emission beyond it.
template <int N>
bool specular_step(const scene::Interaction<N>& surface, const Vec3f& wo, int depth,
                   scene::Ray& ray, Spectrum<N>& beta, ScatterVertex& vertex, Event& event,
                   scene::Sampler& sampler) {
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = surface.bsdf.sample(wo, u_choice, u, kSpecularEvents);
  if (!s) return false;
  const Vec3f wi = surface.to_world(s->wi);
  if ((s->wi.z() > 0.0f) != (wi.dot(surface.ng) > 0.0f)) return false;
  beta *= s->weight;
  if (s->event != kPaneStraight)
    vertex = {!s->dirac(), surface.point.position, light_normal(surface), s->pdf};
  if (depth >= kRouletteDepth) {
    const float survive = std::min(0.97f, beta.max());
    if (!(sampler.next_1d() < survive)) return false;
    beta /= survive;
  }
  event = s->event;
  ray = {scene::offset_origin(surface.point, wi), wi};
  return true;
}

/// What the body of a surface sends on: all, and of that the first reflections of lights and of
/// caustics, for classes of light.
template <int N>
struct SentLight {
  Spectrum<N> all, once, caustic;
};
/// What the body of a surface sends towards a diffuse point. Closer than an element, its mean
/// direct light is too coarse: look at the lights again. \param straight  nothing but panes lies
/// between.
template <int N>
SentLight<N> sent_light(const View<N>& view, const scene::SurfacePoint& receiver,
                        const scene::Interaction<N>& surface, const Vec3f& wo, bool straight,
                        scene::Sampler& sampler, scene::Counters& counters) {
  SentLight<N> sent;
  if (!surface.bsdf.has(kDiffuseEvents)) return sent;
  const bool close = straight && (surface.point.position - receiver.position).norm() <
                                     element_size(view.field, view.shading.scene(), surface.point);
  const auto of_field = [&](Parts parts) {
    const FieldRadiance<N> r = field_radiance(view, surface, wo, parts);
    return r.reflected + r.transmitted;
  };
  sent.all = of_field({!close, true, true});
  if (view.options.classes) {
    sent.once = of_field({!close, false, false});
    sent.caustic = of_field({false, true, false});
  }
  if (close) {
    const DirectLight<N> d =
        direct_light<N>(view, surface, wo, nullptr, Lobes::LeftToCaustics, sampler, counters);
    sent.all += d.reflected + d.transmitted;
    sent.once += d.reflected + d.transmitted;
  }
  return sent;
}

/// Density [1/sr] of points on bright surfaces, seen from a point that light reaches straight.
float bright_pdf(float pdf_area, const Vec3f& between, float sender_cosine) {
  return sender_cosine > 0.0f ? pdf_area * between.squaredNorm() / sender_cosine : 0.0f;
}

/// The part of a bright surface's light that a gather ray accounts for which met it by chance.
template <int N>
float share_of_chance(const View<N>& view, const ScatterVertex& from,
                      const scene::Interaction<N>& surface) {
  if (view.bright.empty()) return 1.0f;
  const float pdf_area = view.bright.pdf(from.position, from.normal, surface.point, surface.side);
  if (!(pdf_area > 0.0f)) return 1.0f;
  const Vec3f between = surface.point.position - from.position;
  return mis_weight(from.pdf, bright_pdf(pdf_area, between, -between.normalized().dot(surface.ng)));
}

/// One ray from a diffuse point into its hemisphere (or through the sheet): radiance that arrives,
/// times f cos / pdf. `straight` gets the share that comes directly from a light.
template <int N>
struct Gathered {
  Spectrum<N> straight, indirect;
  Spectrum<N> once, caustic;  ///< of `indirect`: first reflections of lights, and of caustics
  bool reflected = true;

  void take(const SentLight<N>& sent, const Spectrum<N>& weight) {
    indirect += weight * sent.all;
    once += weight * sent.once;
    caustic += weight * sent.caustic;
  }
};
template <int N>
Gathered<N> gather(const View<N>& view, const scene::Interaction<N>& from,
                   const GatherDirections<N>& directions, GatherGuide& guide,
                   scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  Gathered<N> g;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = directions.sample(u_choice, u);
  if (!s) return g;
  g.reflected = s->reflected;
  ScatterVertex vertex{true, from.point.position, light_normal(from), s->pdf};
  Spectrum<N> beta = s->weight;
  scene::Ray ray{scene::offset_origin(from.point, s->wi), s->wi};
  bool straight = true;  // nothing but panes passed so far
  Counter kind = Counter::RaysGather;

  for (int depth = 0; depth < view.options.max_specular_depth; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      if (straight)
        g.straight +=
            beta * sky_radiance(shading, ray) * environment_weight(shading, vertex, ray.direction);
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, surface, ray, distance);
    if (straight) {
      const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
      if (!emitted.is_zero()) g.straight += beta * emitted * emission_weight(shading, vertex, *hit);
    }
    const SentLight<N> sent =
        sent_light(view, from.point, surface, wo, straight, sampler, counters);
    g.take(sent, straight ? beta * share_of_chance(view, vertex, surface) : beta);
    Event event{};
    if (!specular_step(surface, wo, depth, ray, beta, vertex, event, sampler)) break;
    straight &= event == kPaneStraight;
    kind = Counter::RaysSpecular;
  }
  const float found = (g.straight + g.indirect).mean() * s->density;
  guide.found(directions.place(), s->where, found * found, s->density);
  return g;
}

/// A point of the bright surfaces instead of a direction: what gather rays would rarely meet.
template <int N>
Gathered<N> look_at_bright(const View<N>& view, const scene::Interaction<N>& from,
                           const Vec3f& wo_from, const GatherDirections<N>& directions,
                           scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  Gathered<N> g;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = view.bright.sample(from.point.position, light_normal(from), u_choice, u);
  if (!s) return g;
  const Vec3f between = s->point.position - from.point.position;
  const Vec3f w = between.normalized();
  const float sender = w.dot(s->side == Side::Front ? Vec3f(-s->point.ng) : s->point.ng);
  const float pdf = bright_pdf(s->pdf, between, sender);
  if (!(pdf > 0.0f)) return g;
  const Vec3f wi = from.to_local(w);
  if ((wi.z() > 0.0f) != (w.dot(from.ng) > 0.0f)) return g;
  const Spectrum<N> f = from.bsdf.eval(wo_from, wi).diffuse;
  if (f.is_zero()) return g;
  const Spectrum<N> visible =
      shading.transmittance(scene::segment(from.point, s->point), counters, Counter::RaysGather);
  if (visible.is_zero()) return g;
  const scene::Interaction<N> surface = shading.interact(s->point, -w);
  g.reflected = wi.z() > 0.0f;
  g.take(sent_light(view, from.point, surface, surface.to_local(-w), true, sampler, counters),
         f * visible * (std::abs(wi.z()) / pdf * mis_weight(pdf, directions.pdf(wi))));
  return g;
}

}  // namespace

template <int N>
PixelSample<N> trace_hybrid(const View<N>& view, const scene::Ray& camera_ray, GatherGuide& guide,
                            scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  const bool has_field = view.options.method == Method::Hybrid && !view.field.empty();
  const bool gathers = has_field && view.options.indirect == Indirect::Gather;
  PixelSample<N> out;
  Spectrum<N> beta = Spectrum<N>::one();
  ScatterVertex vertex;
  scene::Ray ray = camera_ray;
  Counter kind = Counter::RaysPrimary;
  Event first{};           // what the first surface did
  Event last{};            // what the previous one did
  int scattered = 0;       // specular events, straight panes apart
  float travelled = 0.0f;  // [m]

  // Light that arrives along the specular chain belongs to the term of its first event.
  const auto add = [&](int depth, Term here, const Spectrum<N>& radiance) {
    out[depth == 0 ? here : term_of(first, false)] += beta * radiance;
  };
  // The same by class of light paths. \param unseen  the class without a specular chain at the eye.
  const auto add_class = [&](LightClass unseen, const Spectrum<N>& radiance) {
    const std::size_t seen = scattered > 0 ? 1U : 0U;
    if (view.options.classes)
      out.light_class[static_cast<std::size_t>(unseen) + seen] += beta * radiance;
  };
  const auto add_emission = [&](int depth, const Spectrum<N>& radiance) {
    add_class(LightClass::LE, radiance);
    const bool highlight = scattered == 1 && (first & kLobeEvents) != 0;
    out[depth == 0 ? Term::Emission : term_of(first, highlight)] += beta * radiance;
  };

  for (int depth = 0; depth < view.options.max_specular_depth; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      const Spectrum<N> sky = sky_radiance(shading, ray);
      if (!sky.is_zero())
        add_emission(depth, sky * environment_weight(shading, vertex, ray.direction));
      break;
    }
    travelled += distance;
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, surface, ray, distance);
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

    std::optional<GatherDirections<N>> directions;
    if (gathers && surface.bsdf.has(kDiffuseEvents))
      directions.emplace(surface, wo, guide,
                         guide.place(hit->position, surface.frame.z, view.tile_reach(travelled)));
    const DirectLight<N> direct = direct_light(
        view, surface, wo, directions ? &*directions : nullptr, Lobes::Counted, sampler, counters);
    add(depth, Term::DirectReflection, direct.reflected);
    add(depth, Term::DirectTransmission, direct.transmitted);
    add_class(LightClass::LDE, direct.reflected + direct.transmitted - direct.lobe);
    if (view.options.classes)
      out.light_class[static_cast<std::size_t>(LightClass::LSE)] += beta * direct.lobe;
    if (depth == 0) {
      out.position = hit->position;
      out.body_albedo = surface.bsdf.diffuse_reflectance(wo);
      out.body_direct = direct.body;
    }
    if (has_field && surface.bsdf.has(kDiffuseEvents)) {
      const FieldRadiance<N> r = field_radiance(view, surface, wo, {false, true, !gathers});
      add(depth, Term::IndirectReflection, r.reflected);
      add(depth, Term::IndirectTransmission, r.transmitted);
      add_class(LightClass::LSDE, r.reflected + r.transmitted);
      // What the field knows needs no sharing: what samples find beside it has less shape.
      if (depth == 0 && gathers && view.options.share_samples)
        out.body_indirect -= field_radiance(view, surface, wo, {false, false, true}).reflected;
      const auto take = [&](const Gathered<N>& g) {
        add(depth, g.reflected ? Term::DirectReflection : Term::DirectTransmission, g.straight);
        add(depth, g.reflected ? Term::IndirectReflection : Term::IndirectTransmission, g.indirect);
        add_class(LightClass::LDE, g.straight);
        add_class(LightClass::LDDE, g.once);
        add_class(LightClass::LSDDE, g.caustic);
        add_class(LightClass::LDDDE, g.indirect - g.once - g.caustic);
        if (depth == 0 && g.reflected) {
          out.body_direct += g.straight;
          out.body_indirect += g.indirect;
        }
      };
      if (directions) take(gather(view, surface, *directions, guide, sampler, counters));
      if (directions && !view.bright.empty())
        take(look_at_bright(view, surface, wo, *directions, sampler, counters));
    }
    if (!specular_step(surface, wo, depth, ray, beta, vertex, last, sampler)) break;
    if (depth == 0) first = last;
    if (last != kPaneStraight) ++scattered;
    kind = Counter::RaysSpecular;
  }
  return out;
}

template PixelSample<1> trace_hybrid<1>(const View<1>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Counters&);
template PixelSample<3> trace_hybrid<3>(const View<3>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Counters&);
template PixelSample<4> trace_hybrid<4>(const View<4>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Counters&);
template PixelSample<8> trace_hybrid<8>(const View<8>&, const scene::Ray&, GatherGuide&,
                                        scene::Sampler&, scene::Counters&);

}  // namespace atrium::trace
