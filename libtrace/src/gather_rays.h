#pragma once

#include "body_path.h"
#include "field_light.h"
#include "gather_directions.h"
#include "scene/segment.h"
#include "specular_step.h"

namespace atrium::trace {

/// Side of a surface that a ray comes from.
inline scene::Side side_towards(const scene::SurfacePoint& point, const Vec3f& direction) {
  return point.ng.dot(direction) <= 0.0f ? scene::Side::Front : scene::Side::Back;
}

/// Density [1/sr] of points on bright surfaces, seen from a point that light reaches straight.
inline float bright_pdf(float pdf_area, const Vec3f& between, float sender_cosine) {
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
  Spectrum<N> missed;         ///< by the field: traced light less `indirect`, if it is checked
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
                   GatherGuide& guide, scene::Sampler& sampler, scene::Sampler* check,
                   scene::Counters& counters) {
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
  scene::Counter kind = scene::Counter::RaysGather;

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
      const SentLight<N> sent = matte_light(view, *hit, side_towards(*hit, ray.direction), place);
      g.take(sent, beta * share);
      if (check != nullptr)
        g.missed +=
            beta * share *
            (BodyPath<N>(view, *check, counters).light(*hit, -ray.direction, media) - sent.all);
      break;
    }
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    const Vec3f wo = surface.to_local(-ray.direction);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    add_emission();
    const SentLight<N> sent = body_light(view, surface, wo, place, sampler, counters);
    g.take(sent, beta * share);
    if (check != nullptr && surface.bsdf.has(material::kDiffuseEvents))
      g.missed +=
          beta * share *
          (BodyPath<N>(view, *check, counters).light(*hit, -ray.direction, media) - sent.all);
    material::Event event{};
    if (!specular_step(surface, wo, depth, scattered, media, ray, beta, vertex, event, sampler))
      break;
    kind = scene::Counter::RaysSpecular;
  }
  const float found = (g.straight + g.indirect).mean() * s->density;
  guide.found(directions.place(), s->where, found, s->density);
  return g;
}

/// A point of the bright surfaces instead of a direction: what gather rays would rarely meet.
template <int N>
Gathered<N> look_at_bright(const View<N>& view, const scene::Interaction<N>& from,
                           const Vec3f& wo_from, const GatherDirections<N>& directions,
                           scene::Sampler& sampler, scene::Sampler* check,
                           scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  Gathered<N> g;
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const auto s = view.bright.sample(from.point.position, light_normal(from), u_choice, u);
  if (!s) return g;
  const Vec3f between = s->point.position - from.point.position;
  const Vec3f w = between.normalized();
  const float sender = w.dot(s->side == scene::Side::Front ? Vec3f(-s->point.ng) : s->point.ng);
  const float pdf = bright_pdf(s->pdf, between, sender);
  if (!(pdf > 0.0f)) return g;
  const Vec3f wi = from.to_local(w);
  if ((wi.z() > 0.0f) != (w.dot(from.ng) > 0.0f)) return g;
  const Spectrum<N> f = from.bsdf.eval(wo_from, wi).diffuse;
  if (f.is_zero()) return g;
  const Spectrum<N> visible = shading.transmittance(scene::segment(from.point, s->point), counters,
                                                    scene::Counter::RaysGather);
  if (visible.is_zero()) return g;
  const Place<N> place(view, s->point, from.point.position, true);
  SentLight<N> sent;
  if (!place.near && shading.is_matte(s->point.material)) {
    sent = matte_light(view, s->point, s->side, place);
  } else {
    const scene::Interaction<N> surface = shading.interact(s->point, -w);
    sent = body_light(view, surface, surface.to_local(-w), place, sampler, counters);
  }
  const Spectrum<N> weight =
      f * visible * (std::abs(wi.z()) / pdf * mis_weight(pdf, directions.pdf(wi)));
  g.reflected = wi.z() > 0.0f;
  g.take(sent, weight);
  if (check != nullptr)
    g.missed = weight * (BodyPath<N>(view, *check, counters).light(s->point, -w, {}) - sent.all);
  return g;
}

}  // namespace atrium::trace
