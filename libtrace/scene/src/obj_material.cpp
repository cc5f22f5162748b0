#include "obj_material.h"

#include <algorithm>
#include <cmath>

#include "import_util.h"
#include "material/error.h"

namespace atrium::scene {
namespace {

using material::Material;

material::TextureSlot slot(const MtlMaterial::Map& map, const std::filesystem::path& file,
                           bool srgb, Model& model, ModelBudget& budget) {
  material::TextureSlot out;
  if (map.file.empty()) return out;
  out.texture = add_texture_file(model, budget, file, map.file, srgb);
  if (!out.texture.valid()) return out;
  // -s and -o act on (u, v) with v upwards; our v runs downwards: v' = 1 - (s (1 - v) + o).
  out.scale = Vec2f(static_cast<float>(map.scale[0]), static_cast<float>(map.scale[1]));
  out.offset = Vec2f(static_cast<float>(map.offset[0]),
                     static_cast<float>(1.0 - map.scale[1] - map.offset[1]));
  if (map.clamp) {
    model.textures[out.texture.value].wrap_u = material::Texture::Wrap::Clamp;
    model.textures[out.texture.value].wrap_v = material::Texture::Wrap::Clamp;
  }
  return out;
}

/// Blinn-Phong exponent to Beckmann slope: m^2 = 2 / (Ns + 2) matches the width of the lobes.
double c_of_exponent(double ns) {
  if (!(ns > 0.0)) ns = 0.0;
  if (ns >= 1000.0) return std::numeric_limits<double>::infinity();
  return std::sqrt((ns + 2.0) / 2.0);
}

double index_from_f0(double f0) {
  const double root = std::sqrt(std::clamp(f0, 0.0, 0.999));
  return (1.0 + root) / (1.0 - root);
}

/// 4, 6, 7, 9: glass and refraction; or a dissolve below 1.
bool transmits(const MtlMaterial& s) {
  return s.d < 1.0 || s.illum == 4 || s.illum == 6 || s.illum == 7 || s.illum == 9;
}

/// Files mark glass by d or by Tf; where only illum says so, everything passes.
Rgb transmittance(const MtlMaterial& s) {
  if (s.tf.max() > 0.0f && s.tf.min() < 1.0f) return unit_range(s.tf);
  return Rgb(1.0f);
}

void map_thin(const MtlMaterial& s, Material& m) {
  const double share = s.d < 1.0 ? 1.0 - unit_range(s.d) : 1.0;
  set_thin_sheet(m, share, transmittance(s), unit_range(s.kd), s.ni > 1.0 ? s.ni : 1.5);
}

void map_opaque(const MtlMaterial& s, Material& m) {
  const Rgb ks = unit_range(s.ks);
  const bool glossy = s.illum != 0 && s.illum != 1 && ks.max() > 0.0f;
  const bool metal = s.pm >= 0.5 || (glossy && s.illum == 3 && s.kd.is_zero());
  if (metal) {
    set_metal(m, s.pm >= 0.5 ? unit_range(s.kd) : ks);
    m.c = s.pr > 0.0 ? roughness_to_c(s.pr) : c_of_exponent(s.ns);
    if (s.illum == 3 && s.pr == 0.0) m.c = std::numeric_limits<double>::infinity();
    m.reflectance_texture = m.body_texture;
    m.body_texture = {};
    m.body_reflectance.reset();
    return;
  }
  if (!glossy && s.pr == 0.0) return;  // Lambert
  m.combination = Material::Combination::Coupled;
  m.k_df = 1.0;
  m.k_rg = 1.0;
  // Ks is the reflectance at normal incidence where Ni does not say more.
  m.n = s.ni > 1.0 ? s.ni : index_from_f0(static_cast<double>(ks.mean()));
  if (s.ni <= 1.0 && !glossy) m.n = 1.5;
  m.c = s.pr > 0.0 ? roughness_to_c(s.pr) : c_of_exponent(s.ns);
}

}  // namespace

material::Material obj_material(const MtlMaterial& s, const std::filesystem::path& file,
                                const ReadOptions& options, Model& model, ModelBudget& budget) {
  Material m;
  m.name = s.name;
  m.k_df = 1.0;
  m.k_rg = 0.0;
  m.body_reflectance = spectral(unit_range(s.kd));
  m.body_texture = slot(s.map_kd, file, true, model, budget);
  // Kd 0 beside map_Kd is common; the texture alone is meant then.
  if (m.body_texture.texture.valid() && s.kd.is_zero()) m.body_reflectance = 1.0;
  if (transmits(s)) {
    map_thin(s, m);
  } else {
    map_opaque(s, m);
  }
  if (!s.map_d.file.empty()) {
    m.alpha_texture = slot(s.map_d, file, false, model, budget);
    if (m.alpha_texture.texture.valid()) {
      m.alpha_cutoff = 0.5f;
      m.alpha_texture.channel = model.textures[m.alpha_texture.texture.value].channels == 4 ? 3 : 0;
    }
  }
  const Rgb emission = s.ke * static_cast<float>(options.emissive_nits_per_unit);
  if (!(emission.is_finite() && emission.min() >= 0.0f)) {
    throw Error(file.string() + ": material '" + s.name + "': Ke must be finite and not negative");
  }
  if (!emission.is_zero()) {
    m.emission = spectral(emission);
    m.emission_texture = slot(s.map_ke, file, true, model, budget);
    m.emits_both_sides = false;
  }
  return m;
}

}  // namespace atrium::scene
