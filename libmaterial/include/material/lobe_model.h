#pragma once

#include <variant>

#include "material/spectral_value.h"

namespace atrium::material {

// Which reflection model a material follows: the paper's facets, or one of the literature that
// stands in their place for comparison. Colours, n, kappa and the weights k_df, k_rg are those of
// the Material; only shape parameters are here. Opaque, convex materials only. Not all conserve
// energy: of a perfect mirror's material He's model reflects up to 1.041 (near grazing, sigma/lambda
// about 0.3), Schlick's up to 1.57, Oren & Nayar's up to 1.05 of the body's reflectance.

/// The paper's model: Material::c, sigma, masking, facet_interreflection.
struct FacetModel {};

/// Energy-normalised (Lafortune & Willems 1994); ks = k_rg F(0).
struct PhongModel {
  double exponent = 20.0;  ///< p, in [0, 1e8]
};
/// Halfway-vector form, normalised and reciprocal; ks = k_rg F(0).
struct BlinnPhongModel {
  double exponent = 20.0;
};
/// Cook & Torrance 1982, D normalised.
struct CookTorranceModel {
  double m = 0.2;  ///< rms slope, in [1e-6, 100]
};
/// He, Torrance, Sillion & Greenberg 1991: directional-diffuse lobe and mirror by wave optics.
struct HeModel {
  double sigma = 0.0;  ///< rms height [m], >= 0
  double tau = 1e-6;   ///< correlation length [m], > 0
};
/// Oren & Nayar 1994, the full model: a rough body of colour rho_d and weight k_df; k_rg is 0.
struct OrenNayarModel {
  double s = 0.3;  ///< standard deviation of the facet angle [rad], in [0, 1]
};
/// Hanrahan & Krueger 1993: single scattering in a slab under a smooth interface of index n, weight
/// k_df; its single-scattering albedo is rho_d; k_rg is 0.
struct HanrahanKruegerModel {
  double depth = 1.0;  ///< optical depth, >= 0
  double g = 0.0;      ///< mean cosine of scattering, in (-1, 1)
};
/// Schlick 1994, single layer, f0 = F(0), weight k_rg.
struct SchlickModel {
  double r = 0.3;  ///< roughness, in [0, 1]
  double p = 1.0;  ///< isotropy, in (0, 1]
};
/// Microfacets of Walter et al. 2007 as in glTF, exact Fresnel; roughness textures multiply
/// sqrt(alpha).
struct GgxModel {
  double alpha = 0.3;  ///< in [1e-4, 1]
};

using LobeModel = std::variant<FacetModel, PhongModel, BlinnPhongModel, CookTorranceModel, HeModel,
                               OrenNayarModel, HanrahanKruegerModel, SchlickModel, GgxModel>;

/// Whether the model replaces the diffuse body (weight k_df) and not the interface (k_rg).
[[nodiscard]] inline bool is_body(const LobeModel& lobe) {
  return std::holds_alternative<OrenNayarModel>(lobe) ||
         std::holds_alternative<HanrahanKruegerModel>(lobe);
}
/// Whether the model has a Dirac part.
[[nodiscard]] inline bool has_mirror(const LobeModel& lobe) {
  const auto* schlick = std::get_if<SchlickModel>(&lobe);
  return std::holds_alternative<HeModel>(lobe) || (schlick != nullptr && schlick->r < 0.5);
}

}  // namespace atrium::material
