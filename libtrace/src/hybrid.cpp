#include <numbers>

#include "gather_directions.h"
#include "integrator.h"
#include "scene/roulette.h"
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

/// Radiance towards the viewer that the field gives at a point, by reflection and by transmission
/// of what arrives on the other side.
template <int N>
struct FieldRadiance {
  Spectrum<N> reflected, transmitted;
};

/// What the field knows at a point of a surface: looked for once, summed as often as needed.
template <int N>
class FieldPoint {
 public:
  /// The field must not be empty.
  FieldPoint(const View<N>& view, const scene::Interaction<N>& surface)
      : FieldPoint(view, surface,
                   view.field.spot(view.shading.scene(), surface.point.object,
                                   surface.point.triangle, surface.point.position)) {}
  FieldPoint(const View<N>& view, const scene::Interaction<N>& surface,
             const SurfaceField::Spot& spot)
      : view_(view),
        surface_(surface),
        spot_(spot),
        here_(view.field.stencil(spot, surface.side)) {}

  /// Of everything on the viewer's side.
  [[nodiscard]] Spectrum<N> irradiance() const {
    return view_.field.template interpolate<N>(view_.arriving, here_, surface_.side);
  }
  [[nodiscard]] Spectrum<N> reflected(const Vec3f& wo, Parts parts) const {
    if (!surface_.bsdf.has(kDiffuseReflection)) return {};
    const auto& q = surface_.bsdf.coupled() ? view_.field.body_irradiance : view_.field.irradiance;
    return surface_.bsdf.diffuse_reflectance(wo) * sum(q, here_, surface_.side, parts) * kInvPi;
  }
  [[nodiscard]] Spectrum<N> transmitted(Parts parts) const {
    if (!surface_.bsdf.has(kDiffuseTransmission)) return {};
    const Side side = other(surface_.side);
    return surface_.bsdf.diffuse_transmittance() *
           sum(view_.field.irradiance, view_.field.stencil(spot_, side), side, parts) * kInvPi;
  }
  [[nodiscard]] FieldRadiance<N> radiance(const Vec3f& wo, Parts parts) const {
    return {reflected(wo, parts), transmitted(parts)};
  }

 private:
  Spectrum<N> sum(const SurfaceField::Quantities& q, const SurfaceField::Stencil& s, Side side,
                  Parts parts) const {
    Spectrum<N> e;
    if (parts.direct) e += view_.field.template interpolate<N>(q.direct, s, side);
    if (parts.caustic) e += view_.field.template interpolate<N>(q.caustic, s, side);
    if (parts.indirect) e += view_.field.template interpolate<N>(q.indirect, s, side);
    return e;
  }

  const View<N>& view_;
  const scene::Interaction<N>& surface_;
  SurfaceField::Spot spot_;
  SurfaceField::Stencil here_;
};

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
/// `scattered` counts those that are no straight passages through panes.
template <int N>
bool specular_step(const scene::Interaction<N>& surface, const Vec3f& wo, int depth, int& scattered,
                   scene::MediumStack& media, scene::Ray& ray, Spectrum<N>& beta,
                   ScatterVertex& vertex, Event& event, scene::Sampler& sampler) {
  if (!surface.bsdf.has(kSpecularEvents)) return false;
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

/// What the body of a surface sends on: all, and of that the first reflections of lights and of
/// caustics, for classes of light.
template <int N>
struct SentLight {
  Spectrum<N> all, once, caustic;
};
/// Irradiance at the end of a ray [as the field]. From afar one ray of many sees an element as a
/// whole, whose own value is its mean; close by it is interpolated. \param part  of the field.
template <int N>
Spectrum<N> irradiance_seen(const View<N>& view, const std::vector<float>& part,
                            const SurfaceField::Spot& spot, Side side, float distance) {
  constexpr float kFar = 4.0f;  // element edges
  const SurfaceField& field = view.field;
  if (spot.element == SurfaceField::kNone || part.empty()) return {};
  const std::size_t i = std::size_t{spot.element} * 2 + static_cast<std::size_t>(side);
  if (field.valid[i] != 0 && distance > kFar * field.element_size(spot.element))
    return field.value<N>(part, spot.element, side);
  return field.interpolate<N>(part, field.stencil(spot, side), side);
}

/// A place that gather rays end at, as the field has it.
template <int N>
struct Place {
  /// \param straight  nothing but panes lies before it.
  Place(const View<N>& view, const scene::SurfacePoint& point, const Vec3f& receiver, bool straight)
      : spot(view.field.spot(view.shading.scene(), point.object, point.triangle, point.position)),
        distance((point.position - receiver).norm()),
        near(straight && spot.element != SurfaceField::kNone &&
             distance < view.field.element_size(spot.element)) {}

  SurfaceField::Spot spot;
  float distance;
  bool near;  ///< closer than an element, whose mean direct light is too coarse then
};

/// Light from a surface that is the same in all directions and does nothing else, not near.
template <int N>
SentLight<N> matte_light(const View<N>& view, const scene::SurfacePoint& point, Side side,
                         const Place<N>& place) {
  const Spectrum<N> factor = view.shading.matte_reflectance(point) * kInvPi;
  const auto of = [&](const std::vector<float>& part) {
    return factor * irradiance_seen(view, part, place.spot, side, place.distance);
  };
  SentLight<N> sent{of(view.arriving), {}, {}};
  if (!view.options.classes) return sent;
  sent.once = of(view.field.irradiance.direct);
  sent.caustic = of(view.field.irradiance.caustic);
  return sent;
}

/// Light from the body of any surface; near by the lights are looked at again.
template <int N>
SentLight<N> body_light(const View<N>& view, const scene::Interaction<N>& surface, const Vec3f& wo,
                        const Place<N>& place, scene::Sampler& sampler, scene::Counters& counters) {
  SentLight<N> sent;
  if (!surface.bsdf.has(kDiffuseEvents)) return sent;
  const FieldPoint<N> field(view, surface, place.spot);
  const auto of = [&](Parts parts) {
    const FieldRadiance<N> r = field.radiance(wo, parts);
    return r.reflected + r.transmitted;
  };
  sent.all = of({!place.near, true, true});
  if (view.options.classes) {
    sent.once = of({!place.near, false, false});
    sent.caustic = of({false, true, false});
  }
  if (place.near) {
    const DirectLight<N> d =
        direct_light<N>(view, surface, wo, nullptr, Lobes::LeftToCaustics, sampler, counters);
    sent.all += d.reflected + d.transmitted;
    sent.once += d.reflected + d.transmitted;
  }
  return sent;
}

/// Side of a surface that a ray comes from.
Side side_towards(const scene::SurfacePoint& point, const Vec3f& direction) {
  return point.ng.dot(direction) <= 0.0f ? Side::Front : Side::Back;
}

/// Density [1/sr] of points on bright surfaces, seen from a point that light reaches straight.
float bright_pdf(float pdf_area, const Vec3f& between, float sender_cosine) {
  return sender_cosine > 0.0f ? pdf_area * between.squaredNorm() / sender_cosine : 0.0f;
}

/// The part of a bright surface's light that a gather ray accounts for which met it by chance.
/// \param direction  of the ray.
template <int N>
float share_of_chance(const View<N>& view, const ScatterVertex& from,
                      const scene::SurfacePoint& point, const Vec3f& direction) {
  if (view.bright.empty()) return 1.0f;
  const float pdf_area =
      view.bright.pdf(from.position, from.normal, point, side_towards(point, direction));
  if (!(pdf_area > 0.0f)) return 1.0f;
  const Vec3f between = point.position - from.position;
  return mis_weight(from.pdf, bright_pdf(pdf_area, between, std::abs(direction.dot(point.ng))));
}

/// One ray from a diffuse point into its hemisphere (or through the sheet): radiance that arrives,
/// times f cos / pdf. `straight` gets the share that comes directly from a light. `media`: the
/// bodies that the point is in.
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
                   const GatherDirections<N>& directions, scene::MediumStack media,
                   GatherGuide& guide, scene::Sampler& sampler, scene::Counters& counters) {
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
  const bool rivals = media.empty();  // bright surfaces are not sought from within bodies
  int scattered = 0;                  // specular events, straight panes apart
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
    const auto add_emission = [&] {
      if (scattered > 0) return;
      const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
      if (!emitted.is_zero()) g.straight += beta * emitted * emission_weight(shading, vertex, *hit);
    };
    const Place<N> place(view, *hit, from.point.position, scattered == 0);
    const float share =
        rivals && scattered == 0 ? share_of_chance(view, vertex, *hit, ray.direction) : 1.0f;
    if (!place.near && shading.is_matte(hit->material)) {  // where most rays end
      beta *= body_transmittance(shading, media, ray, distance);
      add_emission();
      g.take(matte_light(view, *hit, side_towards(*hit, ray.direction), place), beta * share);
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    add_emission();
    g.take(body_light(view, surface, wo, place, sampler, counters), beta * share);
    Event event{};
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, event, sampler))
      break;
    kind = Counter::RaysSpecular;
  }
  const float found = (g.straight + g.indirect).mean() * s->density;
  guide.found(directions.place(), s->where, found, s->density);
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
  const Place<N> place(view, s->point, from.point.position, true);
  SentLight<N> sent;
  if (!place.near && shading.is_matte(s->point.material)) {
    sent = matte_light(view, s->point, s->side, place);
  } else {
    const scene::Interaction<N> surface = shading.interact(s->point, -w);
    sent = body_light(view, surface, surface.to_local(-w), place, sampler, counters);
  }
  g.reflected = wi.z() > 0.0f;
  g.take(sent, f * visible * (std::abs(wi.z()) / pdf * mis_weight(pdf, directions.pdf(wi))));
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
  scene::MediumStack media;
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

  for (int depth = 0;; ++depth) {
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
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
      if (has_field && !surface.bsdf.has(kDiffuseEvents))
        out.irradiance = FieldPoint(view, surface).irradiance();
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
      const FieldPoint<N> field(view, surface);
      if (depth == 0) out.irradiance = field.irradiance();
      const FieldRadiance<N> r = field.radiance(wo, {false, true, !gathers});
      add(depth, Term::IndirectReflection, r.reflected);
      add(depth, Term::IndirectTransmission, r.transmitted);
      add_class(LightClass::LSDE, r.reflected + r.transmitted);
      // What the field knows needs no sharing: what samples find beside it has less shape.
      if (depth == 0 && gathers && view.options.share_samples)
        out.body_indirect -= field.reflected(wo, {false, false, true});
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
      if (directions) take(gather(view, surface, *directions, media, guide, sampler, counters));
      if (directions && media.empty() && !view.bright.empty())
        take(look_at_bright(view, surface, wo, *directions, sampler, counters));
    }
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, last, sampler))
      break;
    if (depth == 0) first = last;
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
