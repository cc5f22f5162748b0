#include <numbers>

#include "integrator.h"

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

/// Irradiance at the end of a ray [as the field]. From afar one ray of many sees an element as a
/// whole, whose own value is its mean; close by it is interpolated.
template <int N>
Spectrum<N> irradiance_seen(const View<N>& view, const SurfaceField::Spot& spot, Side side,
                            float distance) {
  constexpr float kFar = 4.0f;  // element edges
  const SurfaceField& field = view.field;
  if (spot.element == SurfaceField::kNone) return {};
  const std::size_t i = std::size_t{spot.element} * 2 + static_cast<std::size_t>(side);
  if (field.valid[i] != 0 && distance > kFar * field.element_size(spot.element))
    return field.value<N>(view.arriving, spot.element, side);
  return field.interpolate<N>(view.arriving, field.stencil(spot, side), side);
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
template <int N>
bool specular_step(const scene::Interaction<N>& surface, const Vec3f& wo, int depth,
                   scene::Ray& ray, Spectrum<N>& beta, ScatterVertex& vertex, Event& event,
                   scene::Sampler& sampler) {
  if (!surface.bsdf.has(kSpecularEvents)) return false;
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

/// One ray from a diffuse point into its hemisphere (or through the sheet): radiance that arrives,
/// times f cos / pdf. `straight` gets the share that comes directly from a light.
template <int N>
struct Gathered {
  Spectrum<N> straight, indirect;
  bool reflected = true;
};
template <int N>
Gathered<N> gather(const View<N>& view, const scene::Interaction<N>& from, const Vec3f& wo_from,
                   scene::Sampler& sampler, scene::Counters& counters) {
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
    const auto add_emission = [&] {
      if (!straight) return;
      const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
      if (!emitted.is_zero()) g.straight += beta * emitted * emission_weight(shading, vertex, *hit);
    };
    const SurfaceField::Spot spot =
        view.field.spot(shading.scene(), hit->object, hit->triangle, hit->position);
    // Closer than an element, its mean direct light is too coarse: look at the lights again.
    const bool near = depth == 0 && spot.element != SurfaceField::kNone &&
                      distance < view.field.element_size(spot.element);
    if (!near && shading.is_matte(hit->material)) {  // where most rays end
      beta *= shading.through_medium(ray, distance);
      add_emission();
      const Side side = hit->ng.dot(ray.direction) <= 0.0f ? Side::Front : Side::Back;
      g.indirect += beta * shading.matte_reflectance(*hit) *
                    irradiance_seen(view, spot, side, distance) * kInvPi;
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, surface, ray, distance);
    add_emission();
    if (surface.bsdf.has(kDiffuseEvents)) {
      const FieldRadiance<N> r = FieldPoint(view, surface, spot).radiance(wo, {!near, true, true});
      g.indirect += beta * (r.reflected + r.transmitted);
      if (near) {
        const DirectLight<N> d =
            direct_light(view, surface, wo, false, Lobes::LeftToCaustics, sampler, counters);
        g.indirect += beta * (d.reflected + d.transmitted);
      }
    }
    Event event{};
    if (!specular_step(surface, wo, depth, ray, beta, vertex, event, sampler)) break;
    straight &= event == kPaneStraight;
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

  for (int depth = 0; depth < view.options.max_specular_depth; ++depth) {
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
    beta *= segment_transmittance(shading, surface, ray, distance);
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
      if (has_field && !surface.bsdf.has(kDiffuseEvents))
        out.irradiance = FieldPoint(view, surface).irradiance();
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
      const FieldPoint<N> field(view, surface);
      if (depth == 0) out.irradiance = field.irradiance();
      const FieldRadiance<N> r = field.radiance(wo, {false, true, !gathers});
      add(depth, Term::IndirectReflection, r.reflected);
      add(depth, Term::IndirectTransmission, r.transmitted);
      // What the field knows needs no sharing: what samples find beside it has less shape.
      if (depth == 0 && gathers && view.options.share_samples)
        out.body_indirect -= field.reflected(wo, {false, false, true});
      if (gathers) {
        const Gathered<N> g = gather(view, surface, wo, sampler, counters);
        add(depth, g.reflected ? Term::DirectReflection : Term::DirectTransmission, g.straight);
        add(depth, g.reflected ? Term::IndirectReflection : Term::IndirectTransmission, g.indirect);
        if (depth == 0 && g.reflected) {
          out.body_direct += g.straight;
          out.body_indirect += g.indirect;
        }
      }
    }
    if (!specular_step(surface, wo, depth, ray, beta, vertex, last, sampler)) break;
    if (depth == 0) first = last;
    if (last != kPaneStraight) ++scattered;
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
