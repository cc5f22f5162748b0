#include "light_path.h"

#include "scene/roulette.h"

namespace atrium::trace {

using scene::Counter;
using namespace material;

namespace {

constexpr int kRouletteDepth = 3;

/// Where a path from a light starts.
template <int N>
struct LightStart {
  scene::EmissionSample<N> sample;
  Spectrum<N> flux;

  [[nodiscard]] bool far_away() const { return sample.number == scene::LightSample<N>::kFarAway; }
  /// LightSampler::emission_density() at a distance.
  [[nodiscard]] float density(const scene::LightSampler<N>& lights, float distance) const {
    scene::LightSample<N> seen;
    seen.wi = -sample.direction;
    seen.distance = distance;
    seen.dirac = sample.dirac;
    seen.source = sample.source;
    seen.number = sample.number;
    return lights.emission_density(seen);
  }
};

template <int N>
std::optional<LightStart<N>> start_at_light(const scene::LightSampler<N>& lights,
                                            scene::Sampler& sampler) {
  const float u_choice = sampler.next_1d();
  const Vec2f u_position = sampler.next_2d();
  const auto sample = lights.sample_emission(u_choice, u_position, sampler.next_2d());
  if (!sample) return std::nullopt;
  LightStart<N> start{*sample, sample->weight};
  // The sky's parts overlap: a path carries the light of all that are in its direction.
  if (start.far_away() && !sample->dirac)
    start.flux = lights.environment(-sample->direction) / start.density(lights, 0.0f);
  if (start.flux.is_zero() || !start.flux.is_finite()) return std::nullopt;
  return start;
}

/// Weights at the first surface: against sampling the light from there, and against hitting it.
template <int N>
PathWeights first_weights(const scene::LightSampler<N>& lights, const LightStart<N>& start,
                          const scene::Interaction<N>& surface, float distance, float cosine) {
  PathWeights w;
  const double density =
      static_cast<double>(start.density(lights, distance)) * static_cast<double>(cosine);
  if (!(density > 0.0)) return w;
  if (surface.bsdf.has(kDiffuseEvents | kLobeEvents)) {
    const float pdf =
        lights.pdf(surface.point.position, light_normal(surface), start.sample, distance);
    w.connected = PathWeights::power(static_cast<double>(pdf) / density);
  }
  if (!start.sample.dirac) w.traced = PathWeights::power(1.0 / density);
  return w;
}

/// One event of a path from a light. \return false: the path ends.
template <int N>
bool scatter(const View<N>& view, const scene::Interaction<N>& surface, const BsdfSample<N>& s,
             const Vec3f& to_light, const Vec3f& to_eye, Spectrum<N>& flux, PathWeights& weights,
             std::optional<LightShares<N>>& classes) {
  const float in = std::abs(to_light.dot(surface.ng)), out = std::abs(to_eye.dot(surface.ng));
  if (s.dirac()) {
    // A camera would have taken this way back only if it sees the same shading normal.
    if (!reversible(view.shading, surface, to_eye)) return false;
    const float shaded_in = std::abs(to_light.dot(surface.frame.z));
    flux *= s.weight * (shaded_in * out / (std::abs(s.wi.z()) * in));
    weights.pass_dirac(static_cast<double>(out));
    if (classes) classes->scatter_specular();
    return true;
  }
  const auto at = scattering(view.shading, surface, to_eye, to_light);
  if (!at || !(at->pdf_to_eye > 0.0f)) return false;
  // Veach 1997, Eq. 5.19: light is weighed by the shading normal where it arrives.
  flux *= at->f.sum() * (at->cosine * out / (in * at->pdf_to_eye));
  weights.scatter(static_cast<double>(out), static_cast<double>(at->pdf_to_eye),
                  static_cast<double>(at->pdf_to_light));
  if (classes) classes->scatter(share_of_body(at->f));
  return true;
}

}  // namespace

template <int N>
std::optional<Scattering<N>> scattering(const scene::Shading<N>& shading,
                                        const scene::Interaction<N>& surface, const Vec3f& to_eye,
                                        const Vec3f& to_light) {
  const SeenFrom<N> eye(shading, surface, to_eye);
  const Vec3f wo = eye->to_local(to_eye), wi = eye->to_local(to_light);
  if (!(wo.z() > 0.0f) || (wi.z() > 0.0f) != (to_light.dot(eye->ng) > 0.0f)) return std::nullopt;
  Scattering<N> s;
  s.f = eye->bsdf.eval(wo, wi);
  if (s.f.sum().is_zero()) return std::nullopt;
  s.cosine = std::abs(wi.z());
  s.reflected = wi.z() > 0.0f;
  s.pdf_to_light = eye->bsdf.pdf(wo, wi);
  const SeenFrom<N> light(shading, surface, to_light);
  s.pdf_to_eye = density(*light, to_light, to_eye);
  return s;
}

template <int N>
void trace_light_path(const View<N>& view, scene::Sampler& sampler, LightPath<N>& path,
                      scene::Counters& counters) {
  path.clear();
  const scene::Shading<N>& shading = view.shading;
  const auto start = start_at_light(shading.lights(), sampler);
  if (!start) return;
  scene::Ray ray{start->sample.origin, start->sample.direction};
  Spectrum<N> flux = start->flux;
  PathWeights weights;
  std::optional<LightShares<N>> classes;
  if (view.options.classes) classes.emplace();
  scene::MediumStack media;
  int scattered = 0;       // events, panes passed straight apart
  float travelled = 0.0f;  // since the last vertex, through panes

  for (int depth = 0;; ++depth) {
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, Counter::RaysPhoton, &distance);
    if (!hit) break;
    const Vec3f to_light = -ray.direction;
    const scene::Interaction<N> surface = shading.interact(*hit, to_light);
    flux *= segment_transmittance(shading, media, surface, ray, distance);
    travelled += distance;
    const float cosine = std::abs(to_light.dot(surface.ng));
    if (!(cosine > 0.0f) || flux.is_zero()) break;

    PathWeights here = weights;
    if (scattered == 0)
      here = first_weights(shading.lights(), *start, surface, travelled, cosine);
    else
      here.arrive(static_cast<double>(travelled), static_cast<double>(cosine));
    if (surface.bsdf.has(kDiffuseEvents | kLobeEvents))
      path.push_back({surface, to_light, flux, here, scattered == 0, classes});

    const float u_choice = sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    const auto s =
        surface.bsdf.sample(surface.to_local(to_light), u_choice, u, kAllEvents, Transport::Flux);
    if (!s) break;
    const Vec3f to_eye = surface.to_world(s->wi);
    if ((s->wi.z() > 0.0f) != (to_eye.dot(surface.ng) > 0.0f)) break;
    pass_surface(media, surface, s->event);
    if (s->event == kPaneStraight) {
      flux *= s->weight;
    } else {
      weights = here;
      if (!scatter(view, surface, *s, to_light, to_eye, flux, weights, classes)) break;
      ++scattered;
      travelled = 0.0f;
    }
    if (depth >= kRouletteDepth) {
      const float survive =
          std::min(scene::long_path_survival(scattered), flux.max() / start->flux.max());
      if (!(sampler.next_1d() < survive)) break;
      flux /= survive;
    }
    ray = {scene::offset_origin(*hit, to_eye), to_eye};
  }
}

#define ATRIUM_INSTANTIATE(N)                                                              \
  template std::optional<Scattering<N>> scattering(                                        \
      const scene::Shading<N>&, const scene::Interaction<N>&, const Vec3f&, const Vec3f&); \
  template void trace_light_path(const View<N>&, scene::Sampler&, LightPath<N>&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::trace
