#pragma once

#include <optional>
#include <vector>

#include "material/bsdf.h"
#include "material/paper.h"
#include "material/spectral_basis.h"
#include "scene/light_sampler.h"
#include "scene/ray_query.h"
#include "scene/surface_field.h"

namespace atrium::scene {

/// A surface point, turned to the side it is looked at from, with its BSDF.
template <int N>
struct Interaction {
  SurfacePoint point;
  Side side = Side::Front;  ///< side of the triangle that wo is on
  Vec3f ng;                 ///< geometric normal on that side
  Frame frame;              ///< shading frame, z on that side
  material::Bsdf<N> bsdf;

  [[nodiscard]] Vec3f to_local(const Vec3f& w) const { return frame.to_local(w); }
  [[nodiscard]] Vec3f to_world(const Vec3f& w) const { return frame.to_world(w); }
};

/// Whose weights light transport uses.
enum class Weights {
  Radiometric,  ///< the materials as they are
  Paper         ///< smooth specular weights and k_df rho_d, k_tp_df tau_d of the paper's equation
};

/// A scene made ready for light transport with N lanes: materials and lights resolved in a basis.
/// The one place where radiosity and ray tracing look materials up. Thread-safe.
template <int N>
class Shading {
 public:
  /// \throws Error  for Weights::Paper, names a material that would return all the light it gets.
  Shading(const RayQuery& query, const material::SpectralBasis& basis,
          Weights weights = Weights::Radiometric);

  [[nodiscard]] const Scene& scene() const { return query_->scene(); }
  [[nodiscard]] const RayQuery& query() const { return *query_; }
  [[nodiscard]] const material::SpectralBasis& basis() const { return basis_; }
  [[nodiscard]] const LightSampler<N>& lights() const { return lights_; }
  [[nodiscard]] const material::ResolvedMaterial<N>& material(MaterialId id) const {
    return materials_[id.value];
  }

  /// Closest surface; points that an alpha mask cuts out are passed.
  [[nodiscard]] std::optional<SurfacePoint> closest(const Ray& ray, Counters& counters,
                                                    Counter kind, float* distance = nullptr) const;
  /// The same as the ray query has it; Hit::t is the distance from the ray's origin.
  [[nodiscard]] std::optional<Hit> closest_hit(const Ray& ray, Counters& counters,
                                               Counter kind) const;
  /// For many rays at once; Hit::none() where there is none.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Counters& counters,
                    Counter kind) const;
  /// \param wo  unit, away from the surface (minus the ray's direction).
  [[nodiscard]] Interaction<N> interact(const SurfacePoint& point, const Vec3f& wo) const;
  /// Does a material reflect diffusely and nothing else, on both sides alike?
  [[nodiscard]] bool is_matte(MaterialId id) const { return matte_[id.value].has_value(); }
  /// Reflectance of such a surface at a point; radiance is that times irradiance over pi.
  [[nodiscard]] Spectrum<N> matte_reflectance(const SurfacePoint& point) const {
    return *matte_[point.material.value] * body_factor(point);
  }
  /// The paper's constants of the same surface.
  [[nodiscard]] material::PaperSurface<N> paper_surface(const Interaction<N>& surface) const;
  /// Share of light that goes straight along the ray: 0 behind opaque things and solids, the
  /// product of the panes' transmittance and that of the air else.
  [[nodiscard]] Spectrum<N> transmittance(const Ray& ray, Counters& counters, Counter kind) const;
  /// The same between a surface point and a light sample taken from it.
  [[nodiscard]] Spectrum<N> visibility(const SurfacePoint& from, const LightSample<N>& light,
                                       Counters& counters, Counter kind) const;
  /// The same from a point off all surfaces by more than the error of its position.
  [[nodiscard]] Spectrum<N> visibility(const Vec3f& origin, const LightSample<N>& light,
                                       Counters& counters, Counter kind) const;

  /// Does the air absorb? If not, through_medium() need not be asked.
  [[nodiscard]] bool has_medium() const { return has_medium_; }
  /// Transmittance of the air along a ray up to a distance [m], which may be infinite.
  [[nodiscard]] Spectrum<N> through_medium(const Ray& ray, float distance) const;

 private:
  const RayQuery* query_;
  material::SpectralBasis basis_;
  LightSampler<N> lights_;
  Spectrum<N> medium_;  // K of the air
  bool has_medium_;
  std::vector<material::Material> sources_;  // what materials_ point to, for Weights::Paper
  std::vector<material::ResolvedMaterial<N>> materials_;
  std::vector<std::optional<Spectrum<N>>> matte_;  // by material: reflectance before textures

  /// What textures and vertex colours multiply at a point.
  struct Factors {
    Spectrum<N> body = Spectrum<N>::one();
    Spectrum<N> reflectance = Spectrum<N>::one();
    float roughness = 1.0f;
  };
  [[nodiscard]] Factors factors(const SurfacePoint& point) const;
  [[nodiscard]] Spectrum<N> body_factor(const SurfacePoint& point) const;
  [[nodiscard]] bool cut_out(const SurfacePoint& point) const;
};

extern template class Shading<1>;
extern template class Shading<3>;
extern template class Shading<4>;
extern template class Shading<8>;

}  // namespace atrium::scene
