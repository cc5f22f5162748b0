#pragma once

#include <optional>
#include <string>
#include <vector>

#include "material/material.h"
#include "trace/render.h"

// What the study compares: substances, roughnesses, reflection models.
namespace atrium::study {

/// The same surface in every model: a Gaussian one of rms height sigma, correlation length tau.
struct Roughness {
  std::string name;
  double sigma = 0.0;                                               ///< [m]
  double tau = 1e-6;                                                ///< [m]
  [[nodiscard]] double slope() const { return 2.0 * sigma / tau; }  ///< m, rms
};
/// smooth (sigma 20 nm), medium (slope 0.1), rough (slope 0.35, several wavelengths high).
[[nodiscard]] const std::vector<Roughness>& roughnesses();

/// A stuff by its optical constants; with a body colour it is half interface, half body.
struct Substance {
  std::string name;
  material::SpectralValue n = 1.5, kappa = 0.0;
  std::optional<material::SpectralValue> body = {};
  bool transparent = false;  ///< can be shown as a refracting solid, too
};
/// gold, copper, aluminium, plastic, glass.
[[nodiscard]] const std::vector<Substance>& substances();
/// \throws Error  for an unknown name, with those that are known.
[[nodiscard]] const Substance& find_substance(const std::string& name);
/// Constants at one wavelength: an opaque surface without colour.
[[nodiscard]] Substance grey_substance(const std::string& name, double n, double k);

enum class Model {
  Facets,  ///< the paper's model, radiometric mode: the reference of all differences
  Paper,   ///< its six terms literally
  Phong,
  CookTorrance,
  He,
  BlinnPhong,
  Schlick,
  Ggx,
  Coupled,  ///< Facets with the body under the interface; substances with a body only
  Solid,    ///< Facets, refracting; transparent substances only
  SolidPaper
};
[[nodiscard]] const char* name_of(Model model);
[[nodiscard]] trace::Mode mode_of(Model model);
/// Compared in every scene: the first one is the reference.
[[nodiscard]] std::vector<Model> main_models();
/// Compared on the sphere.
[[nodiscard]] std::vector<Model> all_models(const Substance& substance);

/// The material of a substance under one of the models, equal roughness as described in the study.
[[nodiscard]] material::Material make_material(const Substance& substance,
                                               const Roughness& roughness, Model model);

/// Schlick's r whose lobe and mirror together look most like the facets of slope m without a
/// coherent part (LobeDifference::seen at 45 degrees, F = 1).
[[nodiscard]] double fitted_schlick_r(double m);

}  // namespace atrium::study
