#pragma once

#include <span>
#include <string>
#include <vector>

#include "material/bsdf.h"
#include "scene/light_groups.h"
#include "scene/ray_query.h"
#include "scene/scene.h"

namespace atrium::radiosity {

/// Diffuse properties of one side at a point.
template <int N>
struct SideSurface {
  Spectrum<N> reflectance, transmittance, exitance;
  bool coupled = false;  ///< reflects E_B instead of E
};

/// The group that each object's emission is in, by object, and last that of the environment; empty
/// without groups.
/// \throws Error  if the scene's groups have other names.
[[nodiscard]] std::vector<std::uint32_t> emission_groups(const scene::Scene& scene,
                                                         std::span<const scene::GroupField> groups);

/// Looks diffuse materials up, emission as dimmed by the groups' factors.
template <int N>
class SurfaceReader {
 public:
  SurfaceReader(const scene::Scene& scene, const material::SpectralBasis& basis,
                std::span<const scene::GroupField> groups);

  /// What textures multiply: all, or all but the pictures that an export keeps as such.
  struct Textures {
    bool body = true;
    bool emission = true;
  };
  [[nodiscard]] SideSurface<N> side(const scene::SurfacePoint& at, bool front,
                                    const Textures& textures) const;
  [[nodiscard]] SideSurface<N> side(const scene::SurfacePoint& at, bool front) const {
    return side(at, front, Textures{});
  }
  /// Radiance of an object's emission before its texture, as dimmed.
  [[nodiscard]] Spectrum<N> emission(scene::ObjectId object) const;
  [[nodiscard]] const material::ResolvedMaterial<N>& material(scene::MaterialId id) const {
    return materials_[id.value];
  }
  /// 0 without groups.
  [[nodiscard]] std::uint32_t group(scene::ObjectId object) const {
    return group_.empty() ? 0 : group_[object.value];
  }

 private:
  [[nodiscard]] Spectrum<N> texture(const material::TextureSlot& slot, const Vec2f& uv) const;

  const scene::Scene& scene_;
  material::SpectralBasis basis_;
  std::vector<material::ResolvedMaterial<N>> materials_;
  std::vector<Spectrum<N>> emission_;  // by material
  std::vector<std::uint32_t> group_;   // by object
  std::vector<float> factor_;          // by group
};

}  // namespace atrium::radiosity
