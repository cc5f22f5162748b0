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
  /// A sphere round the scene that shows the environment from inside.
  [[nodiscard]] Primitive bake_sky(double factor, std::uint32_t group) const;

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
