#include "baked_looks.h"

#include <algorithm>
#include <tuple>

namespace atrium::radiosity {
namespace {

using material::TextureSlot;

bool same_place(const TextureSlot& a, const TextureSlot& b) {
  return a.texture == b.texture && a.scale == b.scale && a.offset == b.offset &&
         a.rotation == b.rotation;
}

auto key(const scene::BakedModel::Material& m) {
  return std::tie(m.name, m.kind, m.texture, m.atlas, m.alpha_cutoff, m.double_sided, m.color.lane,
                  m.roughness, m.gloss.lane, m.ior, m.thickness, m.attenuation.lane);
}

/// White with the alpha of a picture.
material::Texture mask_of(const material::Texture& source) {
  material::Texture mask = source;
  mask.channels = 4;
  mask.pixels.clear();
  const auto channels = static_cast<std::size_t>(source.channels);
  const bool alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < source.pixels.size(); i += channels) {
    mask.pixels.insert(mask.pixels.end(), {255, 255, 255});
    mask.pixels.push_back(alpha ? source.pixels[i + channels - 1] : std::uint8_t{255});
  }
  return mask;
}

}  // namespace

KeptPicture kept_picture(const scene::Scene& scene, const material::Material& m, bool& whole_mask) {
  using Of = KeptPicture::Of;
  KeptPicture picture;
  if (m.emissive() && m.emission_texture.texture.valid()) {
    picture.of = Of::Emission;
    picture.slot = m.emission_texture;
  } else if (m.body_texture.texture.valid()) {
    picture.of = Of::Body;
    picture.slot = m.body_texture;
  }
  if (picture.of != Of::Nothing)
    picture.mean =
        static_cast<float>(luminance(scene.textures[picture.slot.texture.value].mean_rgb()));
  whole_mask = false;
  if (!(m.alpha_cutoff > 0.0f) || !m.alpha_texture.texture.valid()) return picture;
  if (picture.of == Of::Nothing) {
    picture.of = Of::Mask;
    picture.slot = m.alpha_texture;
  }
  whole_mask = !same_place(picture.slot, m.alpha_texture);
  if (!whole_mask && m.alpha_factor > 0.0f) picture.cutoff = m.alpha_cutoff / m.alpha_factor;
  return picture;
}

std::uint32_t BakedLooks::material(const Material& m) {
  const auto same = std::find_if(materials_.begin(), materials_.end(),
                                 [&](const Material& other) { return key(other) == key(m); });
  if (same != materials_.end()) return static_cast<std::uint32_t>(same - materials_.begin());
  materials_.push_back(m);
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

std::int32_t BakedLooks::texture(const KeptPicture& picture) {
  if (picture.of == KeptPicture::Of::Nothing) return scene::BakedModel::kNone;
  const bool mask = picture.of == KeptPicture::Of::Mask;
  const auto [known, added] = known_.emplace(std::pair(picture.slot.texture.value, mask),
                                             static_cast<std::int32_t>(textures_.size()));
  if (added) {
    const material::Texture& source = scene_.textures[picture.slot.texture.value];
    textures_.push_back(mask ? mask_of(source) : source);
  }
  return known->second;
}

void BakedLooks::move_to(scene::BakedModel& model) {
  model.materials = std::move(materials_);
  model.textures = std::move(textures_);
}

}  // namespace atrium::radiosity
