#include "gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "import_util.h"
#include "material/error.h"

namespace atrium::scene {
namespace {

using material::Material;
using material::SpectralValue;
using material::TextureSlot;

// ---- values out of extensions ----

const tinygltf::Value* extension(const tinygltf::ExtensionMap& map, const std::string& name) {
  const auto it = map.find(name);
  return it == map.end() ? nullptr : &it->second;
}

double number(const tinygltf::Value* object, const std::string& key, double otherwise) {
  if (object == nullptr || !object->IsObject() || !object->Has(key)) return otherwise;
  const tinygltf::Value& value = object->Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

Rgb color(const tinygltf::Value* object, const std::string& key, const Rgb& otherwise) {
  if (object == nullptr || !object->IsObject() || !object->Has(key)) return otherwise;
  const tinygltf::Value& value = object->Get(key);
  if (!value.IsArray() || value.ArrayLen() < 3) return otherwise;
  return Rgb::generate([&](int i) { return value.Get(i).GetNumberAsDouble(); });
}

Rgb rgb_of(const std::vector<double>& v, double otherwise) {
  return Rgb::generate([&](int i) {
    return static_cast<std::size_t>(i) < v.size() ? v[static_cast<std::size_t>(i)] : otherwise;
  });
}

// ---- the parameters of a glTF material, in range ----

struct Parameters {
  Rgb base{1.0f};
  double alpha = 1.0;
  double metallic = 1.0;
  double roughness = 1.0;
  double specular = 1.0;  ///< KHR_materials_specular, factor times the mean of its colour
  double ior = 1.5;
  double transmission = 0.0;
  double thickness = 0.0;
  Rgb attenuation_color{1.0f};
  double attenuation_distance = std::numeric_limits<double>::infinity();
  bool unlit = false;
};

class Mapper {
 public:
  Mapper(const GltfDocument& document, int index, const GltfTextures& textures,
         const ReadOptions& options, Model& model)
      : document_(document),
        source_(document.model.materials[static_cast<std::size_t>(index)]),
        textures_(textures),
        options_(options),
        model_(model) {
    name_ = source_.name.empty() ? "material " + std::to_string(index) : source_.name;
  }

  Material map();

 private:
  void read_parameters();
  void read_metallic_texture();
  void map_surface(Material& m);
  void map_transmission(Material& m);
  void map_thin_transmission(Material& m);
  void map_dielectric(Material& m);
  void map_mixed_metal(Material& m);
  void map_unlit(Material& m);
  void map_alpha(Material& m);
  void map_blend(Material& m);
  void map_emission(Material& m);
  void set_mix(Material& m, double transmitted);
  [[nodiscard]] bool base_texture_has_alpha() const;
  template <class Info>
  [[nodiscard]] TextureSlot slot(const Info& info, bool srgb, int channel = 0) const;
  void warn(const std::string& what) {
    model_.warnings.push_back(document_.at("material '" + name_ + "': " + what));
  }

  const GltfDocument& document_;
  const tinygltf::Material& source_;
  const GltfTextures& textures_;
  const ReadOptions& options_;
  Model& model_;
  std::string name_;
  Parameters p_;
};

void Mapper::read_parameters() {
  const auto& pbr = source_.pbrMetallicRoughness;
  const Rgb given = rgb_of(pbr.baseColorFactor, 1.0);
  p_.base = unit_range(given);
  if (!(p_.base == given)) warn("baseColorFactor was limited to [0, 1]");
  p_.alpha = pbr.baseColorFactor.size() > 3 ? unit_range(pbr.baseColorFactor[3]) : 1.0;
  p_.metallic = unit_range(pbr.metallicFactor);
  p_.roughness = unit_range(pbr.roughnessFactor);

  const auto& ext = source_.extensions;
  p_.unlit = ext.contains("KHR_materials_unlit");
  const tinygltf::Value* specular = extension(ext, "KHR_materials_specular");
  const Rgb tint = color(specular, "specularColorFactor", Rgb(1.0f));
  p_.specular =
      unit_range(number(specular, "specularFactor", 1.0) * static_cast<double>(tint.mean()));
  p_.ior = number(extension(ext, "KHR_materials_ior"), "ior", 1.5);
  if (!(p_.ior >= 1.0 && p_.ior < 100.0)) {
    warn("ior " + std::to_string(p_.ior) + " is out of range, 1.5 taken");
    p_.ior = 1.5;
  }
  p_.transmission =
      unit_range(number(extension(ext, "KHR_materials_transmission"), "transmissionFactor", 0.0));
  const tinygltf::Value* volume = extension(ext, "KHR_materials_volume");
  p_.thickness = std::max(0.0, number(volume, "thicknessFactor", 0.0));
  p_.attenuation_color = unit_range(color(volume, "attenuationColor", Rgb(1.0f)));
  p_.attenuation_distance = number(volume, "attenuationDistance", p_.attenuation_distance);
  if (p_.transmission > 0.0 &&
      extension(ext, "KHR_materials_transmission")->Has("transmissionTexture")) {
    warn("transmissionTexture is not read, the factor holds everywhere");
  }
  read_metallic_texture();
}

/// A material has one metallic value here: the factor times the mean of the texture's blue channel.
void Mapper::read_metallic_texture() {
  const material::TextureId id =
      textures_.find(source_.pbrMetallicRoughness.metallicRoughnessTexture.index, false);
  if (!id.valid() || p_.metallic == 0.0) return;
  const material::Texture& texture = model_.textures[id.value];
  if (texture.channels < 3) return;
  double sum = 0.0;
  double squares = 0.0;
  const auto channels = static_cast<std::size_t>(texture.channels);
  const std::size_t pixels = texture.pixels.size() / channels;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double v = texture.pixels[i * channels + 2] / 255.0;
    sum += v;
    squares += v * v;
  }
  if (pixels == 0) return;
  const double mean = sum / static_cast<double>(pixels);
  const double variance = squares / static_cast<double>(pixels) - mean * mean;
  if (variance > 0.01) warn("metallic varies over the texture, its mean is taken");
  p_.metallic *= mean;
  if (p_.metallic < 0.02) p_.metallic = 0.0;
  if (p_.metallic > 0.98) p_.metallic = 1.0;
}

template <class Info>
TextureSlot Mapper::slot(const Info& info, bool srgb, int channel) const {
  TextureSlot out;
  out.texture = textures_.find(info.index, srgb);
  out.channel = channel;
  const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform");
  if (transform == nullptr || !transform->IsObject()) return out;
  const auto pair = [&](const char* key, const Vec2f& otherwise) {
    if (!transform->Has(key) || transform->Get(key).ArrayLen() < 2) return otherwise;
    const tinygltf::Value& v = transform->Get(key);
    return Vec2f(static_cast<float>(v.Get(0).GetNumberAsDouble()),
                 static_cast<float>(v.Get(1).GetNumberAsDouble()));
  };
  out.scale = pair("scale", out.scale);
  out.offset = pair("offset", out.offset);
  out.rotation = static_cast<float>(number(transform, "rotation", 0.0));
  return out;
}

Material Mapper::map() {
  read_parameters();
  Material m;
  m.name = name_;
  if (p_.unlit) {
    map_unlit(m);
  } else {
    map_surface(m);
    map_emission(m);
  }
  map_alpha(m);
  if (source_.normalTexture.index >= 0 && !p_.unlit) {
    m.normal_texture = slot(source_.normalTexture, false);
    m.normal_scale = static_cast<float>(source_.normalTexture.scale);
  }
  return m;
}

void Mapper::map_surface(Material& m) {
  const auto& pbr = source_.pbrMetallicRoughness;
  const bool metal = p_.metallic >= 1.0;
  m.c = roughness_to_c(p_.roughness);
  if (metal) {
    set_metal(m, p_.base);
    m.reflectance_texture = slot(pbr.baseColorTexture, true);
  } else if (p_.transmission > 0.0) {
    map_transmission(m);
  } else if (p_.metallic > 0.0) {
    map_mixed_metal(m);
  } else {
    map_dielectric(m);
  }
  const bool lobe = m.k_rg > 0.0 && !m.smooth();
  if (lobe && pbr.metallicRoughnessTexture.index >= 0) {
    m.roughness_texture = slot(pbr.metallicRoughnessTexture, false, 1);
  }
}

/// Lambert without an interface if specular is off, else a body under a Fresnel interface.
void Mapper::map_dielectric(Material& m) {
  m.body_reflectance = spectral(p_.base);
  m.body_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true);
  m.n = p_.ior;
  m.k_df = 1.0;
  m.k_rg = p_.specular;
  if (p_.specular > 0.0) {
    m.combination = Material::Combination::Coupled;
  } else {
    m.c = std::numeric_limits<double>::infinity();
  }
}

/// 0 < metallic < 1: F(0) is glTF's mix of dielectric and metal, kept by a real n per channel; the
/// body below keeps the dielectric's share.
void Mapper::map_mixed_metal(Material& m) {
  const double f = (p_.ior - 1.0) / (p_.ior + 1.0);
  m.n = spectral(Rgb::generate([&](int i) {
    const double f0 =
        (1.0 - p_.metallic) * p_.specular * f * f + p_.metallic * static_cast<double>(p_.base[i]);
    const double root = std::sqrt(std::min(f0, 0.999));
    return (1.0 + root) / (1.0 - root);
  }));
  m.combination = Material::Combination::Coupled;
  m.k_rg = 1.0;
  m.k_df = 1.0;
  m.body_reflectance = spectral(p_.base * static_cast<float>(1.0 - p_.metallic));
  m.body_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true);
}

/// The linear mix of a transmitting interface (weight t) and a Lambertian body (1 - t).
void Mapper::set_mix(Material& m, double t) {
  m.combination = Material::Combination::Convex;
  m.k_rg = t;
  m.k_tp_rg = t;
  m.k_df = 1.0 - t;
  m.k_tp_df = 1.0 - t;
  m.body_transmittance = 0.0;
  if (t < 1.0) {
    m.body_reflectance = spectral(p_.base);
    m.body_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true);
  } else {
    m.body_reflectance = 0.0;
  }
}

void Mapper::map_transmission(Material& m) {
  if (p_.metallic > 0.0) warn("metallic is ignored beside transmission");
  if (!(p_.thickness > 0.0)) return map_thin_transmission(m);
  m.medium = Material::Medium::Solid;
  m.n = p_.ior;
  set_mix(m, p_.transmission);
  // glTF tints with the base colour once for the visible surface; light passes two of a body's.
  m.transmission_tint =
      spectral(Rgb::generate([&](int i) { return std::sqrt(static_cast<double>(p_.base[i])); }));
  if (!std::isfinite(p_.attenuation_distance) || !(p_.attenuation_distance > 0.0)) return;
  m.extinction = spectral(Rgb::generate([&](int i) {
    const double share = std::max(static_cast<double>(p_.attenuation_color[i]), 1e-6);
    return -std::log(share) / p_.attenuation_distance;
  }));
}

void Mapper::map_thin_transmission(Material& m) {
  if (!m.smooth()) warn("a rough thin sheet is passed straight, its roughness is left out");
  if (p_.transmission < 1.0) warn("a thin sheet that transmits in part is simplified");
  m.body_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true);
  set_thin_sheet(m, p_.transmission, p_.base, p_.base, p_.ior);
  if (source_.pbrMetallicRoughness.baseColorTexture.index >= 0 &&
      m.medium == Material::Medium::Pane) {
    warn("the texture of a pane is left out, the factor holds everywhere");
  }
}

/// KHR_materials_unlit shows a colour that no light changes: it emits it and reflects nothing.
/// Vertex colours multiply it (vertex_colors_emit()).
void Mapper::map_unlit(Material& m) {
  m.k_df = 0.0;
  m.k_rg = 0.0;
  m.body_reflectance = 0.0;
  m.emission = spectral(p_.base * static_cast<float>(options_.emissive_nits_per_unit));
  m.emission_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true);
  m.emits_both_sides = source_.doubleSided;
}

bool Mapper::base_texture_has_alpha() const {
  const material::TextureId id =
      textures_.find(source_.pbrMetallicRoughness.baseColorTexture.index, true);
  if (!id.valid()) return false;
  const material::Texture& texture = model_.textures[id.value];
  if (texture.channels != 4 && texture.channels != 2) return false;
  const auto channels = static_cast<std::size_t>(texture.channels);
  for (std::size_t i = channels - 1; i < texture.pixels.size(); i += channels) {
    if (texture.pixels[i] != 255) return true;
  }
  return false;
}

void Mapper::map_alpha(Material& m) {
  if (source_.alphaMode == "BLEND") return map_blend(m);
  if (source_.alphaMode != "MASK") return;
  const double cutoff = source_.alphaCutoff;
  if (!(cutoff > 0.0)) return;
  if (!base_texture_has_alpha() && p_.alpha >= cutoff) return;
  m.alpha_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true, 3);
  m.alpha_cutoff = static_cast<float>(cutoff);
  m.alpha_factor = static_cast<float>(p_.alpha);
}

/// BLEND with an alpha texture is cut at one half; with a constant alpha it is a clear sheet that
/// passes 1 - alpha.
void Mapper::map_blend(Material& m) {
  if (base_texture_has_alpha()) {
    warn("alphaMode BLEND with a texture is treated as MASK at 0.5");
    m.alpha_texture = slot(source_.pbrMetallicRoughness.baseColorTexture, true, 3);
    m.alpha_cutoff = 0.5f;
    m.alpha_factor = static_cast<float>(p_.alpha);
    return;
  }
  if (p_.alpha >= 1.0 || p_.transmission > 0.0 || p_.unlit) return;
  warn("alphaMode BLEND with alpha " + std::to_string(p_.alpha) + " is treated as a thin sheet");
  set_thin_sheet(m, 1.0 - p_.alpha, Rgb(1.0f), p_.base, p_.ior);
}

void Mapper::map_emission(Material& m) {
  const double strength = number(extension(source_.extensions, "KHR_materials_emissive_strength"),
                                 "emissiveStrength", 1.0);
  const Rgb factor = rgb_of(source_.emissiveFactor, 0.0);
  const double scale = strength * options_.emissive_nits_per_unit;
  const Rgb emission = Rgb::generate([&](int i) { return static_cast<double>(factor[i]) * scale; });
  if (!emission.is_finite() || emission.min() < 0.0f) {
    throw Error(
        document_.at("material '" + name_ + "': emissive values must be finite and not negative"));
  }
  if (emission.is_zero()) return;
  m.emission = spectral(emission);
  m.emission_texture = slot(source_.emissiveTexture, true);
  m.emits_both_sides = source_.doubleSided;
}

}  // namespace

material::Material gltf_material(const GltfDocument& document, int index,
                                 const GltfTextures& textures, const ReadOptions& options,
                                 Model& model) {
  return Mapper(document, index, textures, options, model).map();
}

int gltf_uv_set(const GltfDocument& document, int material) {
  if (material < 0) return 0;
  const tinygltf::Material& m = document.model.materials[static_cast<std::size_t>(material)];
  const auto set_of = [](const auto& info) {
    const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform");
    return static_cast<int>(number(transform, "texCoord", info.texCoord));
  };
  if (m.pbrMetallicRoughness.baseColorTexture.index >= 0)
    return set_of(m.pbrMetallicRoughness.baseColorTexture);
  if (m.emissiveTexture.index >= 0) return set_of(m.emissiveTexture);
  if (m.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0) {
    return set_of(m.pbrMetallicRoughness.metallicRoughnessTexture);
  }
  return m.normalTexture.index >= 0 ? set_of(m.normalTexture) : 0;
}

}  // namespace atrium::scene
