#pragma once

#include <optional>
#include <utility>

#include "direct_light.h"
#include "field_light.h"
#include "gather_directions.h"
#include "specular_step.h"

namespace atrium::trace {

/// Light that the body of a surface sends, found by a path instead of the field: what the field
/// would say if it had no error. Only caustics (light that specular events bring to a diffuse
/// surface) are read from the field at every vertex, as paths from the eye may not find their
/// lights.
template <int N>
class BodyPath {
 public:
  BodyPath(const View<N>& view, scene::Sampler& sampler, scene::Counters& counters)
      : view_(view), sampler_(sampler), counters_(counters) {}

  /// \param towards  unit, world. \param media  the bodies that the point is in.
  [[nodiscard]] Spectrum<N> light(const scene::SurfacePoint& point, const Vec3f& towards,
                                  const scene::MediumStack& media) {
    return follow(point, towards, media, true);
  }
  /// The same without what comes straight from lights and without caustics.
  [[nodiscard]] Spectrum<N> indirect_light(const scene::SurfacePoint& point, const Vec3f& towards,
                                           const scene::MediumStack& media) {
    return follow(point, towards, media, false);
  }

 private:
  struct Body {
    scene::Interaction<N> surface;
    Vec3f wo;  // local
  };

  Spectrum<N> follow(const scene::SurfacePoint& point, const Vec3f& towards,
                     const scene::MediumStack& media, bool lights) {
    media_ = media;
    lights_ = lights;
    beta_ = Spectrum<N>::one();
    sum_ = {};
    std::optional<Body> body(make_body(view_.shading.interact(point, towards), towards));
    for (int bounce = 0; body && body->surface.bsdf.has(material::kDiffuseEvents); ++bounce) {
      const GatherDirections<N> directions(body->surface, body->wo, guide_, GatherGuide::kNone);
      if (lights_) add_lights(*body, directions);
      body = next(*body, directions);
      lights_ = true;
      const float survive = std::min(scene::long_path_survival(bounce), beta_.max());
      if (!(sampler_.next_1d() < survive)) break;
      beta_ /= survive;
    }
    return sum_;
  }

  static Body make_body(scene::Interaction<N>&& surface, const Vec3f& towards) {
    const Vec3f wo = surface.to_local(towards);
    return {std::move(surface), wo};
  }

  /// Light that reaches the body from lights, straight and by specular events.
  void add_lights(const Body& body, const GatherDirections<N>& directions) {
    const DirectLight<N> d = direct_light(view_, body.surface, body.wo, &directions,
                                          Lobes::LeftToCaustics, sampler_, counters_);
    sum_ += beta_ * (d.reflected + d.transmitted);
    if (view_.field.irradiance.caustic.empty()) return;
    const FieldRadiance<N> caustic =
        FieldPoint<N>(view_, body.surface).radiance(body.wo, {false, true, false});
    sum_ += beta_ * (caustic.reflected + caustic.transmitted);
  }

  /// The body that a ray from this one meets, if need be by specular events.
  std::optional<Body> next(const Body& from, const GatherDirections<N>& directions) {
    const scene::Shading<N>& shading = view_.shading;
    const float u_choice = sampler_.next_1d();
    const Vec2f u = sampler_.next_2d();
    const auto s = directions.sample(u_choice, u);
    if (!s) return std::nullopt;
    beta_ *= s->weight;
    ScatterVertex vertex{true, from.surface.point.position, light_normal(from.surface), s->pdf};
    scene::Ray ray{scene::offset_origin(from.surface.point, s->wi), s->wi};
    int scattered = 0;  // specular events, straight panes apart
    for (int depth = 0;; ++depth) {
      float distance = 0.0f;
      const auto hit = shading.closest(ray, counters_, scene::Counter::RaysPath, &distance);
      if (!hit) {
        if (lights_ && scattered == 0)
          sum_ += beta_ * sky_radiance(shading, ray) *
                  environment_weight(shading, vertex, ray.direction);
        return std::nullopt;
      }
      Body body = make_body(shading.interact(*hit, -ray.direction), -ray.direction);
      beta_ *= segment_transmittance(shading, media_, body.surface, ray, distance);
      if (lights_ && scattered == 0) {
        const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
        if (!emitted.is_zero()) sum_ += beta_ * emitted * emission_weight(shading, vertex, *hit);
      }
      const auto albedo = [&](int events) {
        return body.surface.bsdf.albedo(body.wo, events).mean();
      };
      const float diffuse = albedo(material::kDiffuseEvents);
      const float specular = albedo(material::kSpecularEvents);
      if (!(diffuse + specular > 0.0f)) return std::nullopt;
      const float to_body = diffuse / (diffuse + specular);
      if (sampler_.next_1d() < to_body) {
        beta_ /= to_body;
        return body;
      }
      beta_ /= 1.0f - to_body;
      material::Event event{};
      if (!specular_step(body.surface, body.wo, depth, scattered, media_, ray, beta_, vertex, event,
                         sampler_))
        return std::nullopt;
    }
  }

  const View<N>& view_;
  scene::Sampler& sampler_;
  scene::Counters& counters_;
  const GatherGuide guide_;  // bends nothing
  scene::MediumStack media_;
  Spectrum<N> beta_, sum_;
  bool lights_ = true;  // of the body where the path is
};

}  // namespace atrium::trace
