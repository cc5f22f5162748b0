#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "material/spectral_basis.h"
#include "scene/ray_query.h"
#include "scene/scene.h"

namespace atrium::scene {

/// A light as seen from a point: where to send the shadow ray and what arrives if it is free.
template <int N>
struct LightSample {
  Vec3f wi;               ///< unit, towards the light
  float distance = 0.0f;  ///< to the sampled point; infinity for sun and environment
  Vec3f end = Vec3f::Zero();  ///< where a shadow ray ends: the point, off an emissive surface; finite lights only
  Spectrum<N> radiance;   ///< radiance of the light towards the point; for Dirac lights the
                          ///< irradiance on a plane facing them
  float pdf = 0.0f;  ///< [1/sr] including the choice of the light; Dirac: probability of the choice
  bool dirac = false;       ///< point, spot, directional: cannot be hit by chance
  std::uint32_t light = 0;  ///< index for light groups: lights first, then emissive triangles
};

/// Where a photon starts.
template <int N>
struct EmissionSample {
  Vec3f origin;
  Vec3f direction;
  Spectrum<N> weight;  ///< flux carried by this sample: Phi estimate for one sample
};

/// Chooses lights for next event estimation and photons: a bounding hierarchy over all lights and
/// emissive triangles with their power, extent and orientation (Conty Estevez & Kulla 2018).
template <int N>
class LightSampler {
 public:
  LightSampler(const Scene& scene, const material::SpectralBasis& basis);
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

  /// Radiance that a surface emits towards wo (unit, away from the surface).
  [[nodiscard]] Spectrum<N> emitted(const SurfacePoint& point, const Vec3f& wo) const;
  /// Radiance of the environment seen in a direction; zero without one.
  [[nodiscard]] Spectrum<N> environment(const Vec3f& direction) const;

  /// A starting ray for light tracing, by power.
  [[nodiscard]] std::optional<EmissionSample<N>> sample_emission(float u_choice,
                                                                 const Vec2f& u_position,
                                                                 const Vec2f& u_direction) const;
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
