#include "closed_bodies.h"

#include "scene/sampler.h"

namespace atrium::radiosity {

template <int N>
std::vector<std::uint8_t> closed_opaque_bodies(const scene::Shading<N>& shading) {
  const scene::Scene& scene = shading.scene();
  std::vector<std::uint8_t> closed(scene.objects.size(), 0);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const material::Material& m = scene.material_of(scene::ObjectId(i));
    const material::MaterialTraits t = material::traits(m);
    closed[i] = scene.mesh_of(scene::ObjectId(i)).closed &&
                m.medium == material::Material::Medium::Opaque && !t.diffuse_transmission &&
                !t.alpha_mask;
  }
  scene::Counters unused;
  std::vector<std::uint32_t> inner(scene.objects.size(), 0);
  constexpr std::uint32_t kProbes = 4096;
  for (std::uint32_t i = 0; i < kProbes && !shading.lights().empty(); ++i) {
    scene::Sampler sampler(0x5eed, 0, i);
    const float choice = sampler.next_1d();
    const Vec2f position = sampler.next_2d();
    const auto e = shading.lights().sample_emission(choice, position, sampler.next_2d());
    if (!e) continue;
    const auto hit = shading.closest({e->origin, e->direction}, unused, scene::Counter::RaysProbe);
    if (hit && hit->ng.dot(e->direction) > 0.0f) ++inner[hit->object.value];
  }
  // A stray ray through a crack makes no room; one in a thousand is a lamp inside.
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (inner[i] > kProbes / 1000) closed[i] = 0;
  return closed;
}

#define ATRIUM_INSTANTIATE(N) \
  template std::vector<std::uint8_t> closed_opaque_bodies(const scene::Shading<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
