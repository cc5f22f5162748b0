#pragma once

#include <algorithm>
#include <vector>

#include "gather_guide.h"
#include "pixel_sample.h"
#include "scene/bright_surfaces.h"
#include "scene/camera.h"
#include "scene/medium_stack.h"
#include "scene/sampler.h"
#include "scene/shading.h"
#include "trace/render.h"

namespace atrium::trace {

/// Everything an integrator reads; one per rendering, shared by all threads.
template <int N>
struct View {
  const scene::Shading<N>& shading;
  const scene::SurfaceField& field;
  const RenderOptions& options;
  const scene::BrightSurfaces& bright;  ///< of the field, if gather rays look for its light
  float tile_near, tile_angle;  ///< edge of a tile of the picture at the camera [m] and its growth

  /// Edge of a tile [m] as seen after so many metres.
  [[nodiscard]] float tile_reach(float distance) const { return tile_near + tile_angle * distance; }
  std::vector<float> arriving = whole(field.irradiance);  ///< direct, caustic and indirect together

 private:
  static std::vector<float> whole(const scene::SurfaceField::Quantities& q) {
    std::vector<float> sum = q.direct;
    for (const std::vector<float>* part : {&q.caustic, &q.indirect}) {
      sum.resize(std::max(sum.size(), part->size()));
      for (std::size_t i = 0; i < part->size(); ++i) sum[i] += (*part)[i];
    }
    return sum;
  }
};

/// Unbiased path tracing with next event estimation and multiple importance sampling.
template <int N>
[[nodiscard]] PixelSample<N> trace_path(const View<N>& view, const scene::Ray& ray,
                                        scene::Sampler& sampler, scene::Counters& counters);
/// Direct light and specular paths; diffuse inter-reflection from the field (Method::Hybrid) or
/// not at all (Method::Direct).
/// \param guide  of the ray's tile. \param check  null, or numbers to find out by paths what the
/// field misses.
template <int N>
[[nodiscard]] PixelSample<N> trace_hybrid(const View<N>& view, const scene::Ray& ray,
                                          GatherGuide& guide, scene::Sampler& sampler,
                                          scene::Sampler* check, scene::Counters& counters);
/// The paper's equation, literally.
template <int N>
[[nodiscard]] PixelSample<N> trace_paper(const View<N>& view, const scene::Ray& ray,
                                         scene::Sampler& sampler, scene::Counters& counters);

/// Weight of a sample of density a where another strategy has density b (power heuristic, Veach
/// 1997).
[[nodiscard]] inline float mis_weight(float a, float b) {
  if (!(a < 1e18f)) return 1.0f;  // a Dirac sample has no rival
  return a > 0.0f ? a * a / (a * a + b * b) : 0.0f;
}

/// The last surface that scattered a path with a finite density: emission that the path then meets
/// was also reachable by sampling a light from there.
struct ScatterVertex {
  bool present = false;  ///< false: camera or Dirac event, emission counts in full
  Vec3f position;
  Vec3f normal;      ///< as given to the light sampler
  float pdf = 0.0f;  ///< [1/sr] of the direction taken
};

/// Normal for LightSampler::sample: zero where lights behind the surface matter too.
template <int N>
[[nodiscard]] Vec3f light_normal(const scene::Interaction<N>& surface) {
  using namespace material;
  return surface.bsdf.has(kDiffuseTransmission | kLobeTransmission) ? Vec3f(Vec3f::Zero())
                                                                    : surface.ng;
}

/// Share of emission met after a vertex that belongs to scattering (the rest to light sampling).
template <int N>
[[nodiscard]] float emission_weight(const scene::Shading<N>& shading, const ScatterVertex& v,
                                    const scene::SurfacePoint& hit) {
  if (!v.present) return 1.0f;
  const float distance = (hit.position - v.position).norm();
  return mis_weight(v.pdf, shading.lights().pdf(v.position, v.normal, hit, distance));
}
/// Radiance that a ray brings which meets nothing.
template <int N>
[[nodiscard]] Spectrum<N> sky_radiance(const scene::Shading<N>& shading, const scene::Ray& ray) {
  const Spectrum<N> sky = shading.lights().environment(ray.direction);
  return shading.has_medium() && !sky.is_zero() ? sky * shading.through_medium(ray, ray.tmax) : sky;
}
template <int N>
[[nodiscard]] float environment_weight(const scene::Shading<N>& shading, const ScatterVertex& v,
                                       const Vec3f& direction) {
  if (!v.present) return 1.0f;
  return mis_weight(v.pdf, shading.lights().pdf_environment(v.position, v.normal, direction));
}

/// Transmittance of a segment through the innermost of the bodies that the path is known to be in,
/// or through the air.
template <int N>
[[nodiscard]] Spectrum<N> body_transmittance(const scene::Shading<N>& shading,
                                             const scene::MediumStack& media, const scene::Ray& ray,
                                             float distance) {
  if (media.empty()) return shading.through_medium(ray, distance);
  return exp_minus(shading.material(media.current()).extinction, distance);
}

/// The same of the segment that ends at this surface: a path that began in a solid learns of it
/// where it is hit from the inside.
template <int N>
[[nodiscard]] Spectrum<N> segment_transmittance(const scene::Shading<N>& shading,
                                                const scene::MediumStack& media,
                                                const scene::Interaction<N>& surface,
                                                const scene::Ray& ray, float distance) {
  const material::Material& m = *shading.material(surface.point.material).source;
  if (!media.empty() || surface.side == scene::Side::Front ||
      m.medium != material::Material::Medium::Solid)
    return body_transmittance(shading, media, ray, distance);
  if (surface.bsdf.extinction().is_zero()) return Spectrum<N>::one();
  return exp_minus(surface.bsdf.extinction(), distance);
}

/// Keeps count of the bodies where an event at the surface leads into or out of one.
template <int N>
void pass_surface(scene::MediumStack& media, const scene::Interaction<N>& surface,
                  material::Event event) {
  if ((event & (material::kRefraction | material::kLobeTransmission)) == 0) return;
  if (surface.side == scene::Side::Front)
    media.enter(surface.point.material);
  else
    media.leave(surface.point.material);
}

}  // namespace atrium::trace
