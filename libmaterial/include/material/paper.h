#pragma once

#include <array>
#include <optional>
#include <vector>

#include "material/bsdf.h"
#include "material/frame.h"
#include "material/spectrum.h"

namespace atrium::material {

/// The literal model of Hansmann & Warncke 1998 ("paper mode"): six terms that add to the light
/// J_r sent to the viewer. Not reciprocal and not energy conserving; nothing is repaired here.
/// Source: MATERIAL_MODEL sections 1 to 4; docs/materials.md Eq. P1 to P6.

/// A light as the paper has it: unit direction from the surface point, J_e, distance.
struct PaperLight {
  Vec3d direction = Vec3d::UnitZ();
  double J = 0.0;         ///< radiance scale: J_e f(r) = E / pi for irradiance E facing the light
  double distance = 1.0;  ///< r [m]
};

/// f(r) = 1 / (c1 r^2 + c2).
struct PaperFalloff {
  double c1 = 0.0, c2 = 1.0;
};

/// One wavelength of the paper's equation.
struct PaperInput {
  Vec3d normal = Vec3d::UnitZ();  ///< unit, on the viewer's side: normal.viewer >= 0
  Vec3d viewer = Vec3d::UnitZ();  ///< b, unit
  double n21 = 1.5;               ///< n2 / n1, > 0; medium 1 holds the viewer
  double kappa2 = 0.0;            ///< index of absorption of medium 2, k = n kappa, >= 0
  double k_df = 0.0, k_rg = 0.0, k_tp_df = 0.0, k_tp_rg = 0.0;  ///< in [0, 1]
  std::optional<double> body_reflectance;                       ///< replaces F(0) in C1 and C2
  std::optional<double> body_transmittance;                     ///< replaces F(0) in C5 and C6
  double c = 0.0;           ///< roughness [1/rad], >= 0; infinity: smooth
  bool transparent = true;  ///< false: C4 = C5 = C6 = 0

  std::vector<PaperLight> lights;  ///< normal.direction >= 0 counts in C1, else in C5
  PaperFalloff light_falloff{1.0, 0.0};
  PaperFalloff ray_falloff{0.0, 1.0};
  double J_ab1 = 0.0, J_ab2 = 0.0;  ///< ambient light on the viewer's and the other side
  double J_refl = 0.0, r_refl = 0.0, K_refl = 0.0;     ///< reflected ray: radiance, path, K1 [1/m]
  double J_trans = 0.0, r_trans = 0.0, K_trans = 0.0;  ///< transmitted ray, K2 [1/m]
};

/// C1 to C6; [0] is C1.
struct PaperTerms {
  std::array<double, 6> term{};
  [[nodiscard]] double total() const;
};

/// \throws std::invalid_argument  names the input, its value and the valid range; also where a
///   light that shines (J > 0) or a ray has c1 r^2 + c2 = 0.
[[nodiscard]] PaperTerms paper_terms(const PaperInput& input);

/// The paper's constants of a surface at a point, for the lanes of a scene; the counterpart of Bsdf
/// with the same arguments and the same local frame (z up on the viewer's side).
///
/// What the paper does not know: a pane reflects and transmits by MATERIAL_MODEL 5.6 without k's;
/// of a coupled material the body counts with 1 - k_rg F(0) in the place of k_df.
template <int N>
class PaperSurface {
 public:
  PaperSurface(const ResolvedMaterial<N>& material, bool front, const Spectrum<N>& body_factor,
               const Spectrum<N>& reflectance_factor, float roughness_factor);

  /// The bracket of C1 (l.z >= 0) or C5 (l.z < 0): multiply by J_e f(r), which is E / pi for the
  /// irradiance E of a plane that faces the light. The cosine of the diffuse part is included.
  [[nodiscard]] Spectrum<N> direct(const Vec3f& b, const Vec3f& l) const;

  [[nodiscard]] const Spectrum<N>& ambient_front() const { return diffuse_front_; }  ///< C2 / J_ab1
  [[nodiscard]] const Spectrum<N>& ambient_back() const { return diffuse_back_; }    ///< C6 / J_ab2
  /// C3 over the radiance that arrives along the mirror direction; at any c.
  [[nodiscard]] Spectrum<N> mirror(float cos_theta) const;
  /// C4 over the radiance that arrives along transmitted(); 0 under total reflection.
  [[nodiscard]] Spectrum<N> transmission(float cos_theta) const;
  /// T, away from the surface on the other side, unit; straight on through a pane. nullopt: total
  /// reflection, by the mean index of the lanes.
  [[nodiscard]] std::optional<Vec3f> transmitted(const Vec3f& b) const;
  [[nodiscard]] bool pane() const { return pane_; }

 private:
  [[nodiscard]] Spectrum<N> fresnel(float c) const;
  [[nodiscard]] Spectrum<N> highlight_front(const Vec3f& b, const Vec3f& l) const;
  [[nodiscard]] Spectrum<N> highlight_back(const Vec3f& b, const Vec3f& l) const;

  Spectrum<N> n21_, k21_, pane_kd_;
  float n21_mean_ = 1.0f;
  Spectrum<N> diffuse_front_, diffuse_back_;
  Spectrum<N> reflectance_factor_, tint_;
  float k_rg_ = 0.0f, k_tp_rg_ = 0.0f;
  float c_ = 0.0f;
  bool pane_ = false;
};

/// The material whose radiometric transport has the weights of the paper's equation: body k_df
/// rho_d and k_tp_df tau_d, mirror k_rg F and refraction k_tp_rg (1 - F) at any roughness. What the
/// diffuse inter-reflection of paper mode is solved with; the highlight's c is gone.
/// \throws Error  if body and specular weights together reach 1: nothing would ever be absorbed.
[[nodiscard]] Material paper_transport(const Material& material);

extern template class PaperSurface<1>;
extern template class PaperSurface<3>;
extern template class PaperSurface<4>;
extern template class PaperSurface<8>;

}  // namespace atrium::material
