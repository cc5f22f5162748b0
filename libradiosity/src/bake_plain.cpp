#include "bake_plain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "radiosity/bake.h"
#include "scene/light_sampler.h"

namespace atrium::radiosity {

using scene::BakedModel;
using scene::ObjectId;
using Kind = BakedModel::Material::Kind;
using material::Material;

namespace {

/// glTF's roughness of a lobe width c [1/rad]: c = 1 / roughness^2.
float roughness_of(const Material& m) {
  return m.smooth() ? 0.0f : static_cast<float>(std::min(1.0, std::sqrt(1.0 / m.c)));
}

Rgb unit_range(const Rgb& c) {
  return Rgb::generate([&](int k) { return std::clamp(c[k], 0.0f, 1.0f); });
}

}  // namespace

template <int N>
PlainBaker<N>::PlainBaker(const scene::Scene& scene, const material::SpectralBasis& basis,
                          const SurfaceReader<N>& surfaces, BakedLooks& looks,
                          std::size_t group_count)
    : scene_(scene), basis_(basis), surfaces_(surfaces), looks_(looks), group_count_(group_count) {}

template <int N>
BakedModel::Material PlainBaker<N>::look(ObjectId object) const {
  const auto& resolved = surfaces_.material(scene_.objects[object.value].material);
  const Material& m = *resolved.source;
  BakedModel::Material look;
  look.name = m.name;
  look.double_sided = true;
  if (m.emissive()) {
    look.double_sided = m.emits_both_sides;
    return look;
  }
  const material::MaterialTraits& t = resolved.traits;
  look.roughness = roughness_of(m);
  const Vec3f normal(0.0f, 0.0f, 1.0f);
  if (t.pane || t.transmits) {
    look.kind = Kind::Glass;
    look.ior = resolved.n_mean;
    const material::Bsdf<N> bsdf(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f);
    // What passes; a viewer takes reflection off by itself, so the tint alone is its colour.
    if (t.pane)
      look.color = unit_range(basis_.to_rgb<N>(bsdf.albedo(normal, material::kPaneStraight)));
    if (m.medium == Material::Medium::Solid) {
      look.color = unit_range(basis_.to_rgb<N>(resolved.transmission_tint));
      look.attenuation = unit_range(basis_.to_rgb<N>(exp_minus(resolved.extinction, 1.0f)));
      look.double_sided = false;  // it has a back of its own
      scene::Bounds box;
      const auto count = static_cast<std::uint32_t>(scene_.mesh_of(object).triangles.size());
      for (std::uint32_t i = 0; i < count; ++i)
        for (const Vec3f& c : scene_.corners(object, i)) box.extend(c.cast<double>());
      look.thickness = std::max(1e-4f, static_cast<float>(box.sizes().minCoeff()));
    }
  } else if (t.mirror || t.rough) {
    look.kind = Kind::Metal;
    look.color =
        unit_range(basis_.to_rgb<N>(resolved.reflectance_zero) * static_cast<float>(m.k_rg));
  }
  return look;
}

template <int N>
void PlainBaker<N>::set_gloss(ObjectId object, BakedModel::Material& look) const {
  const auto& resolved = surfaces_.material(scene_.objects[object.value].material);
  if (!resolved.traits.mirror && !resolved.traits.rough) return;
  const Material& m = *resolved.source;
  look.gloss = unit_range(basis_.to_rgb<N>(resolved.reflectance_zero) * static_cast<float>(m.k_rg));
  look.roughness = roughness_of(m);
}

template <int N>
void PlainBaker<N>::set_light(Primitive& p, ObjectId object, const KeptPicture& picture) const {
  Spectrum<N> emission = surfaces_.emission(object);
  if (picture.of == KeptPicture::Of::Body && picture.mean > 0.0f)
    emission *= 1.0f / picture.mean;  // the picture is not of what is emitted
  const Rgb radiance = basis_.to_rgb<N>(emission);
  p.radiance.assign(p.positions.size(), radiance);
  p.groups.assign(group_count_, std::vector<BakedModel::GroupLight>(p.positions.size()));
  if (group_count_ > 0)
    for (BakedModel::GroupLight& v : p.groups[surfaces_.group(object)]) v.radiance = radiance;
}

template <int N>
BakedModel::Primitive PlainBaker<N>::bake(ObjectId object, bool merged) const {
  const scene::Object& o = scene_.objects[object.value];
  BakedModel::Material material = look(object);
  Primitive p;
  p.name = o.name;
  bool whole_mask = false;
  const KeptPicture picture = kept_picture(scene_, scene_.material_of(object), whole_mask);
  const bool unlit = material.kind == Kind::Unlit;
  if (unlit && picture.of != KeptPicture::Of::Nothing) {
    material.texture = looks_.texture(picture);
    material.alpha_cutoff = picture.cutoff;
  }
  const auto count = static_cast<std::uint32_t>(scene_.mesh_of(object).triangles.size());
  for (std::uint32_t t = 0; t < count; ++t)
    for (const auto& [u, v] : {std::pair(0.0f, 0.0f), {1.0f, 0.0f}, {0.0f, 1.0f}}) {
      const scene::SurfacePoint at = scene::surface_point(scene_, object, t, u, v);
      p.indices.push_back(static_cast<std::uint32_t>(p.positions.size()));
      p.positions.push_back(at.position);
      if (!unlit) p.normals.push_back(at.ns);
      if (material.texture >= 0) p.uvs.push_back(picture.slot.transform(at.uv));
    }
  if (unlit) set_light(p, object, picture);
  if (merged) material.name = "plain";
  p.material = looks_.material(material);
  return p;
}

template <int N>
BakedModel::Primitive PlainBaker<N>::bake_sky(std::span<const scene::GroupField> groups) const {
  const std::vector<std::uint32_t> by_source = emission_groups(scene_, groups);
  const std::uint32_t group = by_source.empty() ? 0 : by_source.back();
  const double factor = groups.empty() ? 1.0 : groups[group].factor;
  constexpr int kRings = 48;
  constexpr int kSegments = 96;
  const scene::LightSampler<N> lights(scene_, basis_, {});
  const auto radius = static_cast<float>(2.0 * scene_.bounds.diagonal().norm() + 1.0);
  Primitive p;
  p.name = "sky";
  p.backdrop = true;
  BakedModel::Material look;
  look.name = "plain";
  p.material = looks_.material(look);
  p.groups.resize(group_count_);
  const Vec3f centre = scene_.bounds.center().template cast<float>();
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j <= kSegments; ++j) {
      const double theta = std::numbers::pi * i / kRings;
      const double phi = 2.0 * std::numbers::pi * j / kSegments;
      const Vec3f d =
          Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi))
              .template cast<float>();
      p.positions.push_back(centre + radius * d);
      const Rgb radiance = basis_.to_rgb<N>(lights.environment(d) * static_cast<float>(factor));
      p.radiance.push_back(radiance);
      for (std::size_t g = 0; g < group_count_; ++g)
        p.groups[g].push_back({g == group ? radiance : Rgb(), 0.0f});
    }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i * (kSegments + 1) + j); };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSegments; ++j) {
      if (i > 0) p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      if (i + 1 < kRings)
        p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
    }
  return p;
}

namespace {

template <int N>
BakedModel bake_plain_lanes(const scene::Scene& scene, const material::SpectralBasis& basis,
                            const std::vector<std::uint8_t>& with_elements,
                            std::span<const scene::GroupField> groups) {
  const SurfaceReader<N> surfaces(scene, basis, groups);
  BakedModel model;
  for (const scene::GroupField& g : groups) model.group_names.push_back(g.name);
  if (groups.empty()) model.group_names = {"all"};
  BakedLooks looks(scene);
  const PlainBaker<N> plain(scene, basis, surfaces, looks, model.group_names.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    if (with_elements[o] == 0) model.primitives.push_back(plain.bake(ObjectId(o), false));
  if (scene.environment) model.primitives.push_back(plain.bake_sky(groups));
  looks.move_to(model);
  model.origin = scene.origin;
  model.unit = scene.unit;
  return model;
}

}  // namespace

BakedModel bake_plain(const scene::Scene& scene, const material::SpectralBasis& basis,
                      const std::vector<std::uint8_t>& with_elements,
                      std::span<const scene::GroupField> groups) {
  if (with_elements.size() != scene.objects.size())
    throw std::invalid_argument("bake_plain: one number per object is needed");
  return with_lanes(basis.lanes(), [&](auto lanes) {
    return bake_plain_lanes<lanes()>(scene, basis, with_elements, groups);
  });
}

template class PlainBaker<1>;
template class PlainBaker<3>;
template class PlainBaker<4>;
template class PlainBaker<8>;

}  // namespace atrium::radiosity
