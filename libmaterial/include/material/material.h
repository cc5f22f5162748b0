#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "material/lobe_model.h"
#include "material/rough_interface.h"
#include "material/spectral_basis.h"
#include "material/spectral_value.h"
#include "material/texture.h"

namespace atrium::material {

/// Index into the scene's textures; the material library itself never owns an image.
struct TextureId {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();
  [[nodiscard]] bool valid() const { return value != std::numeric_limits<std::uint32_t>::max(); }
  friend bool operator==(TextureId, TextureId) = default;
};

/// A texture that multiplies (or replaces) a parameter. uv' = offset + rotate(scale * uv).
struct TextureSlot {
  TextureId texture;
  Vec2f scale = Vec2f::Ones();
  Vec2f offset = Vec2f::Zero();
  float rotation = 0.0f;  ///< [rad], counter-clockwise with v down, as KHR_texture_transform
  int channel = 0;        ///< for scalar parameters
  [[nodiscard]] Vec2f transform(const Vec2f& uv) const;
};

/// A surface in the paper's terms (Hansmann & Warncke 1998), as a user describes it. Numbers at a
/// point and for the lanes of a scene are a Bsdf; see resolve_material() and make_bsdf() in bsdf.h.
///
/// Reflection off the interface (k_rg: mirror and lobe), diffuse body reflection (k_df), directed
/// transmission (k_tp_rg) and diffuse transmission (k_tp_df).
struct Material {
  /// What lies behind the surface.
  enum class Medium {
    Opaque,  ///< nothing is transmitted but k_tp_df (a translucent sheet)
    Solid,   ///< a body of index n, kappa: rays refract into it; needs closed geometry
    Pane     ///< a thin sheet of index n and thickness d, passed straight (MATERIAL_MODEL 5.6)
  };
  /// How interface and body share the light.
  enum class Combination {
    Convex,  ///< k_df + k_rg = 1, k_tp_df + k_tp_rg = 1: weights of independent lobes
    Coupled  ///< the body lies under the interface and gets what that lets through
  };

  std::string name;
  Medium medium = Medium::Opaque;
  Combination combination = Combination::Convex;

  // Interface. n and kappa are absolute; the outer medium is the one the scene nests it in (air).
  SpectralValue n = 1.5;      ///< real index, > 0
  SpectralValue kappa = 0.0;  ///< index of absorption, k = n kappa, >= 0
  /// Roughness, D ~ exp(-c^2 delta^2): infinity is smooth. [1/rad]
  double c = std::numeric_limits<double>::infinity();
  /// rms height [m]; if set the lobe keeps a mirror part (coherent factor Gamma).
  std::optional<double> sigma;
  TextureSlot roughness_texture;  ///< multiplies the glTF roughness sqrt(1/c), channel as given
  Masking masking = Masking::VCavity;  ///< or Smith
  /// Adds what facets send to one another, so that a rough conductor with F = 1 is white. Opaque
  /// only; excludes a roughness_texture (so does Masking::Smith).
  bool facet_interreflection = false;
  /// Largest absolute error of F that a faster form may have; 0: always exact.
  double fresnel_error = 1e-3;

  LobeModel lobe;  ///< the paper's facets, or a comparison model instead of them

  // Weights in [0, 1]. Convex: k_df + k_rg = 1 and k_tp_df + k_tp_rg = 1 in the paper; less absorbs
  // the rest, more is refused.
  double k_df = 1.0;
  double k_rg = 0.0;
  double k_tp_df = 0.0;
  double k_tp_rg = 0.0;

  /// Body colours; absent: F(0), as the paper has it. Coupled: rho_b.
  std::optional<SpectralValue> body_reflectance;
  std::optional<SpectralValue> body_transmittance;
  TextureSlot body_texture;  ///< multiplies body_reflectance and body_transmittance (sRGB colour)
  /// Metals of glTF: base colour texture multiplies the interface's reflectance instead.
  TextureSlot reflectance_texture;
  /// Colour factor on directed transmission (glTF base colour of a transmissive surface).
  SpectralValue transmission_tint = 1.0;

  // Media and panes.
  SpectralValue extinction = 0.0;  ///< K of the body [1/m], exp(-K r)
  double pane_thickness = 0.004;   ///< d [m], Pane only

  // Emission.
  SpectralValue emission = 0.0;          ///< radiance; unit of the scene (nit or W/(sr m^2))
  bool emission_spectral_watts = false;  ///< emission is sampled in W/(sr m^2 nm)
  TextureSlot emission_texture;
  bool emits_both_sides = false;

  // Geometry-related switches.
  TextureSlot normal_texture;
  float normal_scale = 1.0f;
  TextureSlot alpha_texture;  ///< alpha mask: points with alpha < cutoff are not there
  float alpha_cutoff = 0.0f;  ///< 0: no mask
  float alpha_factor = 1.0f;
  bool one_sided = false;  ///< the back is not seen at all (glTF doubleSided = false is NOT this)

  // Paper mode: f(r) = 1/(c1 r^2 + c2) along reflected and transmitted rays.
  double ray_c1 = 0.0;
  double ray_c2 = 1.0;

  [[nodiscard]] bool facets() const { return std::holds_alternative<FacetModel>(lobe); }
  [[nodiscard]] bool smooth() const { return !(c < std::numeric_limits<double>::infinity()); }
  [[nodiscard]] bool emissive() const { return max_value(emission) > 0.0; }
};

/// Refuses what cannot be a material: names the parameter, its value and the valid range.
/// \throws Error, prefixed with `where` (file:line:column or material name).
void validate(const Material& material, const std::string& where);

/// What a renderer needs to know to skip work.
struct MaterialTraits {
  bool diffuse_reflection = false;
  bool diffuse_transmission = false;
  bool mirror = false;     ///< Dirac reflection
  bool rough = false;      ///< a lobe of finite width
  bool transmits = false;  ///< directed transmission, smooth or rough, solid
  bool pane = false;
  bool coupled = false;
  bool emissive = false;
  bool alpha_mask = false;
  bool chromatic = false;        ///< lanes differ
  bool wavelength_data = false;  ///< given by samples or optical constants
  bool textured = false;
  bool absorbing_medium = false;
};
[[nodiscard]] MaterialTraits traits(const Material& material);

}  // namespace atrium::material
