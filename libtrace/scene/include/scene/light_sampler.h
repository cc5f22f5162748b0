#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "material/spectral_basis.h"
#include "scene/portal.h"
#include "scene/ray_query.h"
#include "scene/scene.h"

namespace atrium::scene {

/// A light as seen from a point: where to send the shadow ray and what arrives if it is free.
template <int N>
struct LightSample {
  Vec3f wi;                   ///< unit, towards the light
  float distance = 0.0f;      ///< to the sampled point; infinity for sun and environment
  Vec3f end = Vec3f::Zero();  ///< where a shadow ray ends: the point, off an emissive surface;
                              ///< finite lights only
  Spectrum<N> radiance;       ///< radiance of the light towards the point; for Dirac lights the
                              ///< irradiance on a plane facing them
  float pdf = 0.0f;  ///< [1/sr] including the choice of the light; Dirac: probability of the choice
  bool dirac = false;        ///< point, spot, directional: cannot be hit by chance
  std::uint32_t light = 0;   ///< of lights at a place: Scene::lights, then emissive triangles
  std::uint32_t source = 0;  ///< number of light_groups.h; of the sky: see LightSampler::sky_parts
  static constexpr std::uint32_t kFarAway = 0xffffffffU;
  std::uint32_t number = kFarAway;  ///< of LightSampler::sample_light(); kFarAway: sun and sky
};

/// A triangle of a surface that emits.
struct EmissiveTriangle {
  ObjectId object;
  std::uint32_t triangle = 0;  ///< within the object's mesh
  float area = 0.0f;           ///< [m^2]
};

/// Where a photon starts.
template <int N>
struct EmissionSample {
  Vec3f origin;
  Vec3f direction;
  Spectrum<N> weight;        ///< flux carried by this sample: Phi estimate for one sample
  std::uint32_t source = 0;  ///< number of light_groups.h
  std::uint32_t number = LightSample<N>::kFarAway;  ///< of LightSampler::sample_light()
  bool dirac = false;                               ///< of a light without extent: no ray finds it
  SurfacePoint surface;                             ///< where it starts, on emissive surfaces
};

/// Chooses lights for next event estimation and photons: a bounding hierarchy over all lights and
/// emissive triangles with their power, extent and orientation (Conty Estevez & Kulla 2018); sun
/// and sky besides, within rooms mostly through their openings.
template <int N>
class LightSampler {
 public:
  /// \param portals  find_portals(); they change the noise, not the mean.
  LightSampler(const Scene& scene, const material::SpectralBasis& basis,
               std::vector<Portal> portals = {});
  ~LightSampler();
  LightSampler(LightSampler&&) noexcept;

  [[nodiscard]] bool empty() const;
  /// \param normal  of the receiver, zero: none. Lights behind it may still be chosen for surfaces
  /// that transmit; pass zero then. \param u_choice, u  in [0, 1).
  [[nodiscard]] std::optional<LightSample<N>> sample(const Vec3f& p, const Vec3f& normal,
                                                     float u_choice, const Vec2f& u) const;
  /// Density [1/sr] with which sample() finds the emissive point that a ray from p hits.
  [[nodiscard]] float pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& hit,
                          float distance) const;
  /// Same for the environment in a direction.
  [[nodiscard]] float pdf_environment(const Vec3f& p, const Vec3f& normal, const Vec3f& wi) const;

  /// One light at a place, lights without extent first, then emissive triangles: number 0 to
  /// finite_count() - 1. The density is that of the point alone. nullopt: it does not reach p.
  [[nodiscard]] std::size_t finite_count() const;
  [[nodiscard]] std::optional<LightSample<N>> sample_light(std::size_t number, const Vec3f& p,
                                                           const Vec2f& u) const;
  /// Probability that sample() chooses this light.
  [[nodiscard]] float choice_probability(const Vec3f& p, const Vec3f& normal,
                                         std::size_t number) const;
  /// Is there light from far away?
  [[nodiscard]] bool has_sky() const;

  /// Triangle i is LightSample::light - (number of the scene's lights).
  [[nodiscard]] std::span<const EmissiveTriangle> surfaces() const;
  /// Lights without extent, one at a time: 0 to dirac_count() - 1; pdf is 1. nullopt: p is its
  /// place.
  [[nodiscard]] std::size_t dirac_count() const;
  [[nodiscard]] std::optional<LightSample<N>> dirac(std::size_t i, const Vec3f& p) const;
  /// Environment and discs together without other lights. nullopt where there is none.
  [[nodiscard]] std::optional<LightSample<N>> sample_sky(const Vec3f& p, const Vec3f& normal,
                                                         const Vec2f& u) const;

  /// Radiance that a surface emits towards wo (unit, away from the surface).
  [[nodiscard]] Spectrum<N> emitted(const SurfacePoint& point, const Vec3f& wo) const;
  /// Radiance of the environment seen in a direction; zero without one.
  [[nodiscard]] Spectrum<N> environment(const Vec3f& direction) const;

  /// A sample whose source is that of the environment may also show discs that stand before it:
  /// calls part(source, radiance) for each; the parts add up to LightSample::radiance.
  void sky_parts(const LightSample<N>& sample,
                 const std::function<void(std::uint32_t, const Spectrum<N>&)>& part) const;

  /// A starting ray for light tracing, by power.
  [[nodiscard]] std::optional<EmissionSample<N>> sample_emission(float u_choice,
                                                                 const Vec2f& u_position,
                                                                 const Vec2f& u_direction) const;
  /// Density with which sample() at p finds the light that this ray came from, as LightSample::pdf.
  /// \param distance  from the start to p.
  [[nodiscard]] float pdf(const Vec3f& p, const Vec3f& normal, const EmissionSample<N>& start,
                          float distance) const;
  /// Density [1/m^2] of the rays of sample_emission() that arrive at a point, by area that faces
  /// them, if nothing is in their way; times [1/sr] of the lamp's projected solid angle where it
  /// has one. Divided by LightSample::pdf it is the same for all kinds of lights: how often rays
  /// from lights arrive for one time that sample() chooses the light.
  [[nodiscard]] float emission_density(const LightSample<N>& light) const;
  /// The same of an emissive point that a ray hit; 0: emits nothing.
  [[nodiscard]] float emission_density(const SurfacePoint& hit) const;
  /// The same of environment and discs together, in a direction towards them.
  [[nodiscard]] float emission_density(const Vec3f& direction) const;
  /// Total emitted flux by lane (environment: what enters the scene's bounding sphere).
  [[nodiscard]] Spectrum<N> flux() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class LightSampler<1>;
extern template class LightSampler<3>;
extern template class LightSampler<4>;
extern template class LightSampler<8>;

}  // namespace atrium::scene
