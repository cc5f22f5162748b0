#pragma once

#include <optional>
#include <span>
#include <vector>

#include "light_tree.h"
#include "material/spectral_basis.h"
#include "scene/light_sampler.h"

namespace atrium::scene {

/// Lights at a place: points, spots, luminaires, and the triangles that emit.
template <int N>
class FiniteLights {
 public:
  FiniteLights(const Scene& scene, const material::SpectralBasis& basis);

  [[nodiscard]] bool empty() const { return tree_.empty(); }
  /// As LightSampler::sample, without the choice of a group in the density.
  [[nodiscard]] std::optional<LightSample<N>> sample(const Vec3f& p, const Vec3f& normal,
                                                     float u_choice, const Vec2f& u) const;
  /// One light, as LightSampler::sample_light, and the probability that sample() chooses it.
  [[nodiscard]] std::optional<LightSample<N>> sample_light(std::size_t number, const Vec3f& p,
                                                           const Vec2f& u) const;
  [[nodiscard]] float choice_probability(const Vec3f& p, const Vec3f& normal,
                                         std::size_t number) const {
    return tree_.probability(p, normal, static_cast<std::uint32_t>(number));
  }
  /// Density [1/sr] of that for the emissive point that a ray from p hits.
  [[nodiscard]] float pdf(const Vec3f& p, const Vec3f& normal, const SurfacePoint& hit,
                          float distance) const;
  /// All triangles that emit; triangle i is LightSample::light - (number of the scene's lights).
  [[nodiscard]] std::span<const EmissiveTriangle> surfaces() const { return triangles_; }
  [[nodiscard]] std::size_t positional_count() const { return positional_.size(); }
  /// One of the lights without extent; pdf is 1. nullopt: p is its place.
  [[nodiscard]] std::optional<LightSample<N>> positional(std::size_t i, const Vec3f& p) const;
  [[nodiscard]] Spectrum<N> emitted(const SurfacePoint& point, const Vec3f& wo) const;

  /// Flux of each light, and a ray of one of them that carries it.
  [[nodiscard]] std::vector<Spectrum<N>> fluxes() const;
  [[nodiscard]] EmissionSample<N> sample_emission(std::size_t light, const Vec2f& u_position,
                                                  const Vec2f& u_direction) const;
  /// Density of that: of lights without extent [1/sr] in a direction, of triangles
  /// [1/(m^2 sr)] by projected solid angle.
  [[nodiscard]] float emission_density(std::size_t light, const Vec3f& direction) const;
  [[nodiscard]] bool is_positional(std::size_t light) const { return light < positional_.size(); }
  /// Number of the triangle of an emissive surface; nullopt: of another.
  [[nodiscard]] std::optional<std::size_t> number_of(const SurfacePoint& point) const;

 private:
  struct Positional {  // point, spot, profile
    std::uint32_t index;
    Vec3f position;
    Eigen::Matrix3f to_local;  // rotation
    Spectrum<N> intensity;
  };
  struct Place {
    SurfacePoint point;
    Vec3f wi;
    float distance, pdf;
  };
  static constexpr std::uint32_t kNone = 0xffffffffU;

  void collect_lights();
  void collect_surfaces();
  void build_tree();
  [[nodiscard]] LightBounds bounds_of(const Positional& p) const;
  [[nodiscard]] LightBounds bounds_of(const EmissiveTriangle& t) const;
  [[nodiscard]] Spectrum<N> flux_of(const Positional& p) const;
  [[nodiscard]] Spectrum<N> flux_of(const EmissiveTriangle& t) const;
  [[nodiscard]] Spectrum<N> triangle_radiance(const EmissiveTriangle& t) const;
  [[nodiscard]] bool two_sided(const EmissiveTriangle& t) const;
  [[nodiscard]] Spectrum<N> intensity_towards(const Positional& p, const Vec3f& direction) const;
  [[nodiscard]] Spectrum<N> radiance_at(const SurfacePoint& point) const;
  [[nodiscard]] float emission_cosine(const EmissiveTriangle& t, const Vec3f& ng,
                                      const Vec3f& wi) const;
  [[nodiscard]] std::optional<Place> place_on(const EmissiveTriangle& t, const Vec3f& p,
                                              const Vec2f& u) const;
  [[nodiscard]] float cone_of(const Positional& light) const;
  [[nodiscard]] EmissionSample<N> emission_of(const Positional& light, const Vec2f& u) const;
  [[nodiscard]] EmissionSample<N> emission_of(const EmissiveTriangle& t, const Vec2f& u_position,
                                              const Vec2f& u_direction) const;

  const Scene* scene_;
  material::SpectralBasis basis_;
  std::vector<Positional> positional_;
  std::vector<EmissiveTriangle> triangles_;
  std::vector<std::uint32_t> first_triangle_of_object_;  // into triangles_, or kNone
  std::vector<Spectrum<N>> emission_of_material_;
  LightTree tree_;  // positional_, then triangles_
};

}  // namespace atrium::scene
