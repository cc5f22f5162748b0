#include "bidirectional.h"

#include "attribution.h"
#include "scene/camera_film.h"
#include "scene/roulette.h"
#include "scene/segment.h"

namespace atrium::trace {

using scene::Counter;
using namespace material;

namespace {

constexpr int kRouletteDepth = 6;

double pixels_of(const Eye& eye) {
  return static_cast<double>(eye.width) * static_cast<double>(eye.height);
}
/// Paths from lights for one camera ray through every pixel of the film.
double light_paths(const Eye& eye) {
  return static_cast<double>(eye.window.width) * static_cast<double>(eye.window.height);
}

/// Weights at the first surface that a camera ray meets: against seeing it from a path of a light.
PathWeights eye_weights(const Eye& eye, const Vec3f& point, float cosine) {
  PathWeights w;
  if (const auto place = scene::film_place(eye.camera, point, eye.aspect))
    w.connected = PathWeights::power(
        light_paths(eye) / (place->density * pixels_of(eye) * static_cast<double>(cosine)));
  return w;
}

/// Where a path from the eye is.
template <int N>
struct EyeVertex {
  const scene::Interaction<N>& surface;
  Vec3f to_eye;
  const Spectrum<N>& beta;
  PathWeights weights;
  const Attribution<N>& attribution;
};

/// What of the light passes between two surfaces; `far` is seen from the near one.
template <int N>
Spectrum<N> between(const scene::Shading<N>& shading, const scene::SurfacePoint& near,
                    const scene::Interaction<N>& far, scene::Counters& counters) {
  const scene::Ray ray = scene::segment(near, far.point);
  if (!(ray.tmax > 0.0f)) return Spectrum<N>::one();
  Spectrum<N> t = shading.transmittance(ray, counters, Counter::RaysShadow);
  const bool inside =
      far.side == scene::Side::Back &&
      shading.material(far.point.material).source->medium == Material::Medium::Solid;
  if (!inside || t.is_zero()) return t;
  // Not the air is between them but the body.
  if (shading.has_medium()) {
    const Spectrum<N> air = shading.through_medium(ray, ray.tmax);
    t = Spectrum<N>::generate([&](int i) { return air[i] > 0.0f ? t[i] / air[i] : 0.0f; });
  }
  return t * exp_minus(far.bsdf.extinction(), ray.tmax);
}

/// Light from a sampled light at a vertex of the path.
template <int N>
void sample_light(const View<N>& view, const EyeVertex<N>& at, PixelSample<N>& out,
                  scene::Sampler& sampler, scene::Counters& counters) {
  const float u_choice = sampler.next_1d();
  const Vec2f u = sampler.next_2d();
  const scene::Interaction<N>& surface = at.surface;
  if (!surface.bsdf.has(kDiffuseEvents | kLobeEvents)) return;
  const auto& lights = view.shading.lights();
  const auto light = lights.sample(surface.point.position, light_normal(surface), u_choice, u);
  if (!light) return;
  const auto s = scattering(view.shading, surface, at.to_eye, light->wi);
  if (!s) return;
  Spectrum<N> radiance = s->f.sum() * light->radiance * at.beta * (s->cosine / light->pdf);
  if (radiance.is_zero()) return;
  radiance *= view.shading.visibility(surface.point, *light, counters, Counter::RaysShadow);
  if (radiance.is_zero()) return;
  const auto pdf = static_cast<double>(light->pdf);
  double others =
      PathWeights::power(static_cast<double>(lights.emission_density(*light)) *
                         static_cast<double>(std::abs(light->wi.dot(surface.ng))) / pdf) *
      (at.weights.connected +
       at.weights.traced * PathWeights::power(static_cast<double>(s->pdf_to_eye)));
  if (!light->dirac) others += PathWeights::power(static_cast<double>(s->pdf_to_light) / pdf);
  at.attribution.add_direct(out, s->f, s->reflected,
                            radiance * static_cast<float>(1.0 / (1.0 + others)));
}

/// Light that a vertex of a path from a light sends to a vertex of the path from the eye.
template <int N>
void connect(const View<N>& view, const EyeVertex<N>& at, const LightVertex<N>& light,
             PixelSample<N>& out, scene::Counters& counters) {
  const scene::Interaction<N>& surface = at.surface;
  const Vec3f d = light.surface.point.position - surface.point.position;
  const float distance2 = d.squaredNorm();
  if (!(distance2 > 0.0f)) return;
  const Vec3f w = d / std::sqrt(distance2);
  const float cos_eye = std::abs(w.dot(surface.ng)), cos_light = std::abs(w.dot(light.surface.ng));
  if (!(cos_eye > 0.0f && cos_light > 0.0f)) return;
  const auto here = scattering(view.shading, surface, at.to_eye, w);
  if (!here) return;
  const auto there = scattering<N>(view.shading, light.surface, -w, light.to_light);
  if (!there) return;
  const float arriving = std::abs(light.to_light.dot(light.surface.ng));
  Spectrum<N> radiance = at.beta * here->f.sum() * there->f.sum() * light.flux *
                         (here->cosine * there->cosine * cos_light / (arriving * distance2));
  if (radiance.is_zero()) return;
  const SeenFrom<N> far(view.shading, light.surface, -w);
  radiance *= between(view.shading, surface.point, *far, counters);
  if (radiance.is_zero()) return;

  const auto area = [&](float pdf, float cosine) {
    return PathWeights::power(static_cast<double>(pdf * cosine / distance2));
  };
  const double by_light =
      area(here->pdf_to_light, cos_light) *
      (light.weights.connected +
       light.weights.traced * PathWeights::power(static_cast<double>(there->pdf_to_light)));
  const double by_eye =
      area(there->pdf_to_eye, cos_eye) *
      (at.weights.connected +
       at.weights.traced * PathWeights::power(static_cast<double>(here->pdf_to_eye)));
  std::optional<LightShares<N>> classes = light.classes;
  if (classes) classes->scatter(share_of_body(there->f));
  at.attribution.add_joined(out, here->f, here->reflected,
                            radiance * static_cast<float>(1.0 / (1.0 + by_light + by_eye)),
                            classes ? &*classes : nullptr);
}

/// Term that light goes to which a surface scatters to the eye: parts of body and lobe.
template <int N>
void add_terms(const Scattering<N>& s, bool straight, bool through_pane,
               const Spectrum<N>& radiance, PixelSample<N>& out) {
  if (through_pane) {
    out[Term::SpecularTransmission] += radiance;
  } else if (straight) {
    out[s.reflected ? Term::DirectReflection : Term::DirectTransmission] += radiance;
  } else {
    const Spectrum<N> body = radiance * share_of_body(s.f);
    out[s.reflected ? Term::IndirectReflection : Term::IndirectTransmission] += body;
    out[s.reflected ? Term::SpecularReflection : Term::SpecularTransmission] += radiance - body;
  }
}

template <int N>
void splat_vertex(const View<N>& view, const Eye& eye, const LightVertex<N>& v,
                  std::uint16_t replicate, Splats& splats, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  const scene::SurfacePoint& point = v.surface.point;
  const auto place = scene::film_place(eye.camera, point.position, eye.aspect);
  if (!place) return;
  const int x = static_cast<int>(place->film.x() * eye.width) - eye.window.x0;
  const int y = static_cast<int>(place->film.y() * eye.height) - eye.window.y0;
  if (x < 0 || y < 0 || x >= eye.window.width || y >= eye.window.height) return;
  const auto s = scattering(shading, v.surface, place->direction, v.to_light);
  if (!s) return;
  const double density = place->density * pixels_of(eye) *
                         static_cast<double>(std::abs(place->direction.dot(v.surface.ng)));
  const float arriving = std::abs(v.to_light.dot(v.surface.ng));
  Spectrum<N> radiance = v.flux * s->f.sum() * (s->cosine / arriving * static_cast<float>(density));
  const Vec3f origin = scene::offset_origin(point, place->direction);
  const Vec3f d = place->eye - origin;
  const float length = d.norm();
  if (radiance.is_zero() || !(d.dot(place->direction) > 0.0f)) return;
  const scene::Ray ray{origin, d / length, 0.0f, length};
  radiance *= shading.transmittance(ray, counters, Counter::RaysShadow);
  if (radiance.is_zero()) return;
  const double by_light =
      PathWeights::power(density / light_paths(eye)) *
      (v.weights.connected +
       v.weights.traced * PathWeights::power(static_cast<double>(s->pdf_to_light)));
  radiance *= static_cast<float>(1.0 / (1.0 + by_light));
  if (!radiance.is_finite()) {
    ++counters[Counter::SamplesDropped];
    return;
  }

  const auto pixel = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(eye.window.width) +
                     static_cast<std::uint32_t>(x);
  const auto put = [&](std::uint16_t layer, const Spectrum<N>& r) {
    splats.push_back({pixel, replicate, layer, shading.basis().to_rgb(r)});
  };
  put(kPictureLayer, radiance);
  if (view.options.components) {
    const bool pane = shading.query().has(scene::kPane) &&
                      shading.query().occluded(ray, counters, Counter::RaysShadow, scene::kPane);
    PixelSample<N> terms;
    add_terms(*s, v.straight, pane, radiance, terms);
    for (std::size_t t = 0; t < kTerms; ++t)
      if (!terms.term[t].is_zero()) put(layer_of(static_cast<Term>(t)), terms.term[t]);
  }
  if (v.classes) {
    LightShares<N> classes = *v.classes;
    classes.scatter(share_of_body(s->f));
    classes.visit([&](LightState l, const Spectrum<N>& share) {
      put(layer_of(joined(EyeState{}, l)), radiance * share);
    });
  }
}

}  // namespace

template <int N>
void splat_light_path(const View<N>& view, const Eye& eye, const LightPath<N>& path,
                      std::uint16_t replicate, Splats& splats, scene::Counters& counters) {
  for (const LightVertex<N>& v : path) splat_vertex(view, eye, v, replicate, splats, counters);
}

template <int N>
PixelSample<N> trace_bidirectional(const View<N>& view, const Eye& eye,
                                   const scene::Ray& camera_ray, const LightPath<N>& lights,
                                   scene::Sampler& sampler, scene::Counters& counters) {
  const scene::Shading<N>& shading = view.shading;
  PixelSample<N> out;
  Attribution<N> attribution(view.options.classes);
  PathWeights weights;
  Vec3f vertex = camera_ray.origin;  // the last one
  Vec3f vertex_normal = Vec3f::Zero();
  Spectrum<N> beta = Spectrum<N>::one();
  scene::Ray ray = camera_ray;
  Counter kind = Counter::RaysPrimary;
  scene::MediumStack media;
  float eta_scale = 1.0f;
  float travelled = 0.0f;  // since the last vertex, through panes
  int scattered = 0;

  // Share of emission met now that belongs to this way of finding it.
  const auto hit_weight = [&](const auto& pdf, float density) {
    if (scattered == 0) return 1.0f;
    double others = weights.traced * PathWeights::power(static_cast<double>(density));
    if (weights.connected > 0.0)
      others += weights.connected * PathWeights::power(static_cast<double>(pdf()));
    return static_cast<float>(1.0 / (1.0 + others));
  };
  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, kind, &distance);
    if (!hit) {
      const Spectrum<N> sky = sky_radiance(shading, ray);
      if (!sky.is_zero())
        attribution.add(out,
                        beta * sky *
                            hit_weight(
                                [&] {
                                  return shading.lights().pdf_environment(vertex, vertex_normal,
                                                                          ray.direction);
                                },
                                shading.lights().emission_density(ray.direction)),
                        scattered == 1);
      break;
    }
    const Vec3f to_eye = -ray.direction;
    const scene::Interaction<N> surface = shading.interact(*hit, to_eye);
    const Vec3f wo = surface.to_local(to_eye);
    beta *= segment_transmittance(shading, media, surface, ray, distance);
    travelled += distance;
    if (depth == 0) {
      out.depth = distance;
      out.normal = surface.frame.z;
      out.albedo = surface.bsdf.albedo(wo, kAllEvents);
    }
    const Spectrum<N> emitted = shading.lights().emitted(*hit, to_eye);
    if (!emitted.is_zero()) {
      const float length = (hit->position - vertex).norm();
      attribution.add(
          out,
          beta * emitted *
              hit_weight([&] { return shading.lights().pdf(vertex, vertex_normal, *hit, length); },
                         shading.lights().emission_density(*hit)),
          scattered == 1);
    }
    const float cosine = std::abs(to_eye.dot(surface.ng));
    if (!(cosine > 0.0f)) break;
    PathWeights here = weights;
    if (scattered == 0)
      here = eye_weights(eye, hit->position, cosine);
    else
      here.arrive(static_cast<double>(travelled), static_cast<double>(cosine));
    const EyeVertex<N> at{surface, to_eye, beta, here, attribution};
    sample_light(view, at, out, sampler, counters);
    if (surface.bsdf.has(kDiffuseEvents | kLobeEvents))
      for (const LightVertex<N>& light : lights) connect(view, at, light, out, counters);

    const float u_choice = sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    const auto s = surface.bsdf.sample(wo, u_choice, u);
    if (!s) break;
    const Vec3f wi = surface.to_world(s->wi);
    if ((s->wi.z() > 0.0f) != (wi.dot(surface.ng) > 0.0f)) break;
    if (s->dirac())
      attribution.pass(s->event);
    else if (attribution.open())
      attribution.scatter(s->event, surface.bsdf.eval(wo, s->wi));
    beta *= s->weight;
    pass_surface(media, surface, s->event);
    if ((s->event & (kRefraction | kLobeTransmission)) != 0)
      eta_scale *= surface.bsdf.eta() * surface.bsdf.eta();
    if (s->event != kPaneStraight) {
      const auto out_cosine = static_cast<double>(std::abs(wi.dot(surface.ng)));
      weights = here;
      if (!s->dirac()) {
        const SeenFrom<N> light(shading, surface, wi);
        weights.scatter(out_cosine, static_cast<double>(s->pdf),
                        static_cast<double>(density(*light, wi, to_eye)));
      } else if (reversible(shading, surface, wi)) {
        weights.pass_dirac(out_cosine);
      } else {
        weights = {};
      }
      ++scattered;
      vertex = hit->position;
      vertex_normal = light_normal(surface);
      travelled = 0.0f;
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

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template void splat_light_path(const View<N>&, const Eye&, const LightPath<N>&, std::uint16_t, \
                                 Splats&, scene::Counters&);                                     \
  template PixelSample<N> trace_bidirectional(const View<N>&, const Eye&, const scene::Ray&,     \
                                              const LightPath<N>&, scene::Sampler&,              \
                                              scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::trace
