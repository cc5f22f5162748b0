#pragma once

#include "baked_looks.h"
#include "surface_reader.h"

namespace atrium::radiosity {

/// Surfaces without elements: lamps that reflect nothing, black things, mirrors, metals, glass.
template <int N>
class PlainBaker {
 public:
  using Primitive = scene::BakedModel::Primitive;
  PlainBaker(const scene::Scene& scene, const material::SpectralBasis& basis,
             const SurfaceReader<N>& surfaces, BakedLooks& looks, std::size_t group_count);

  /// \param merged  looks that do not depend on the object are one material, "plain".
  [[nodiscard]] Primitive bake(scene::ObjectId object, bool merged) const;
  /// What is left out of a surface that is diffuse, too: reflectance and roughness.
  void set_gloss(scene::ObjectId object, scene::BakedModel::Material& look) const;
  /// A sphere round the scene that shows the environment from inside, dimmed as its group is.
  [[nodiscard]] Primitive bake_sky(std::span<const scene::GroupField> groups) const;

 private:
  void set_light(Primitive& p, scene::ObjectId object, const KeptPicture& picture) const;
  [[nodiscard]] scene::BakedModel::Material look(scene::ObjectId object) const;

  const scene::Scene& scene_;
  const material::SpectralBasis& basis_;
  const SurfaceReader<N>& surfaces_;
  BakedLooks& looks_;
  std::size_t group_count_;  // that vertices carry light of; 0: none
};

}  // namespace atrium::radiosity
