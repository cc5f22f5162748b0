#include "surface_reader.h"

#include <algorithm>
#include <numbers>

#include "material/error.h"

namespace atrium::radiosity {

using scene::Grouping;
using scene::Scene;

std::vector<std::uint32_t> emission_groups(const Scene& scene,
                                           std::span<const scene::GroupField> groups) {
  if (groups.empty()) return {};
  for (const Grouping grouping : {Grouping::Declared, Grouping::ByName}) {
    const scene::LightGroups found = scene::find_light_groups(scene, grouping);
    const bool same =
        std::equal(found.names.begin(), found.names.end(), groups.begin(), groups.end(),
                   [](const std::string& name, const auto& group) { return name == group.name; });
    if (!same) continue;
    const auto first = found.group.begin() + static_cast<std::ptrdiff_t>(scene.lights.size());
    return {first, first + static_cast<std::ptrdiff_t>(scene.objects.size() + 1)};
  }
  throw Error("export: the light groups of the solution are not those of the scene");
}

template <int N>
SurfaceReader<N>::SurfaceReader(const Scene& scene, const material::SpectralBasis& basis,
                                std::span<const scene::GroupField> groups)
    : scene_(scene), basis_(basis), group_(emission_groups(scene, groups)) {
  for (const material::Material& m : scene.materials) {
    materials_.push_back(material::resolve_material<N>(m, basis));
    emission_.push_back(m.emission_spectral_watts ? basis.template resolve_emission<N>(m.emission)
                                                  : basis.template resolve<N>(m.emission));
  }
  for (const scene::GroupField& g : groups) factor_.push_back(static_cast<float>(g.factor));
}

template <int N>
Spectrum<N> SurfaceReader<N>::texture(const material::TextureSlot& slot, const Vec2f& uv) const {
  if (!slot.texture.valid()) return Spectrum<N>::one();
  return basis_.template from_rgb<N>(scene_.textures[slot.texture.value].rgb(slot.transform(uv)));
}

template <int N>
Spectrum<N> SurfaceReader<N>::emission(scene::ObjectId object) const {
  const Spectrum<N>& e = emission_[scene_.objects[object.value].material.value];
  return factor_.empty() ? e : e * factor_[group_[object.value]];
}

template <int N>
SideSurface<N> SurfaceReader<N>::side(const scene::SurfacePoint& at, bool front,
                                      const Textures& textures) const {
  const material::ResolvedMaterial<N>& resolved = materials_[at.material.value];
  const material::Material& m = *resolved.source;
  Spectrum<N> body = textures.body ? texture(m.body_texture, at.uv) : Spectrum<N>::one();
  body *= basis_.template from_rgb<N>(make_rgb(at.color.x(), at.color.y(), at.color.z()));
  const material::Bsdf<N> bsdf(resolved, front, body, Spectrum<N>::one(), 1.0f);
  SideSurface<N> s;
  s.reflectance =
      bsdf.coupled() ? bsdf.diffuse_albedo() : bsdf.diffuse_reflectance(Vec3f(0.0f, 0.0f, 1.0f));
  s.transmittance = bsdf.diffuse_transmittance();
  s.coupled = bsdf.coupled();
  if (m.emissive() && (front || m.emits_both_sides)) {
    s.exitance = emission(at.object) * std::numbers::pi_v<float>;
    if (textures.emission) s.exitance *= texture(m.emission_texture, at.uv);
  }
  return s;
}

template class SurfaceReader<1>;
template class SurfaceReader<3>;
template class SurfaceReader<4>;
template class SurfaceReader<8>;

}  // namespace atrium::radiosity
