#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "material/frame.h"
#include "material/fresnel_forms.h"
#include "material/material.h"
#include "material/microfacet.h"
#include "material/models/lobes.h"
#include "material/spectral_basis.h"

namespace atrium::material {

/// What can happen to light at a surface. Diffuse events read the radiosity field; the others are
/// "specular" in the light-path table (S): followed by rays. PaneStraight is neutral in that table.
enum Event : std::uint32_t {
  kDiffuseReflection = 1,    ///< body, C1/C2
  kDiffuseTransmission = 2,  ///< translucent sheet, C5/C6
  kLobeReflection = 4,       ///< rough interface, C1/C3
  kLobeTransmission = 8,     ///< rough refraction, C4/C5
  kMirror = 16,              ///< Dirac, C3
  kRefraction = 32,          ///< Dirac, C4
  kPaneReflection = 64,      ///< Dirac, C3
  kPaneStraight = 128,       ///< Dirac, direction kept, C4
  kAllEvents = 255,
  kDiffuseEvents = kDiffuseReflection | kDiffuseTransmission,
  kLobeEvents = kLobeReflection | kLobeTransmission,
  kDiracEvents = kMirror | kRefraction | kPaneReflection | kPaneStraight,
  kSpecularEvents = kLobeEvents | kDiracEvents
};

/// Radiance is scaled by (n1/n2)^2 where it enters a denser medium; flux (photons) is not.
enum class Transport { Radiance, Flux };

/// Values of a BSDF for two directions, by term; without the cosine [1/sr].
template <int N>
struct BsdfValue {
  Spectrum<N> diffuse;  ///< reflection or transmission, whichever side wi is on
  Spectrum<N> lobe;
  [[nodiscard]] Spectrum<N> sum() const { return diffuse + lobe; }
};

template <int N>
struct BsdfSample {
  Vec3f wi;
  Spectrum<N>
      weight;        ///< f |cos| / pdf, for Dirac events the event's reflectance / its probability
  float pdf = 0.0f;  ///< [1/sr] of all non-Dirac events asked for; 0 for a Dirac event
  Event event = kDiffuseReflection;
  [[nodiscard]] bool dirac() const { return (event & kDiracEvents) != 0; }
};

/// The share of light that the interface of a coupled material lets through, B(mu), tabulated
/// (MATERIAL_MODEL 5.5), with its cosine mean. The table is even in asinh(mu / width), fine where
/// the interface's albedo bends, and cubic between its places.
template <int N>
struct CoupledBody {
  static constexpr int kSteps = 96;
  std::array<Spectrum<N>, kSteps + 1> transmitted;  ///< B at mu = node(i)
  Spectrum<N> mean;                                 ///< B-bar = 2 * integral of B mu dmu

  /// \param width  of mu at which B begins to change, in [1e-4, 1].
  explicit CoupledBody(double width);
  [[nodiscard]] double node(int i) const;
  [[nodiscard]] Spectrum<N> at(float mu) const {
    mu = std::min(std::max(mu, 0.0f), 1.0f);
    const float x = std::asinh(mu * inverse_width_) * scale_;
    const int first = std::clamp(static_cast<int>(x) - 1, 0, kSteps - 3);
    const float t = x - static_cast<float>(first);  // of four places, 0 to 3 (Lagrange)
    const auto i = static_cast<std::size_t>(first);
    Spectrum<N> b = transmitted[i] * (-(t - 1.0f) * (t - 2.0f) * (t - 3.0f) / 6.0f);
    b += transmitted[i + 1] * (0.5f * t * (t - 2.0f) * (t - 3.0f));
    b += transmitted[i + 2] * (-0.5f * t * (t - 1.0f) * (t - 3.0f));
    b += transmitted[i + 3] * (t * (t - 1.0f) * (t - 2.0f) / 6.0f);
    for (float& v : b.lane) v = std::clamp(v, 0.0f, 1.0f);
    return b;
  }

 private:
  float inverse_width_, scale_;
};

/// What facets lose to one scattering, 1 - E(mu) for F = 1, and what of it comes back.
class Interreflection {
 public:
  Interreflection(double c, Masking masking);
  /// 1 - E(mu).
  [[nodiscard]] float loss(float mu) const;
  /// 2 * integral of loss mu dmu, of the table as it is interpolated.
  [[nodiscard]] float mean_loss() const { return mean_; }
  /// Directions on the upper hemisphere, nearly in proportion to loss(mu) mu; their density [1/sr]
  /// at a cosine mu. loss mu / (pi mean_loss) is at most about twice that.
  [[nodiscard]] Vec3f sample(const Vec2f& u) const;
  [[nodiscard]] float pdf(float mu) const;

 private:
  void tabulate_density();

  static constexpr int kSteps = 64;
  float width_, scale_;  // of w = mu / (mu + width): fine towards grazing
  float mean_ = 0.0f;
  std::array<float, kSteps + 1> loss_{};
  std::array<float, kSteps + 1> cumulative_{}, cosine2_{};  // of sample(), at the steps' ends
  std::array<float, kSteps> average_{};                     // loss within a step over the mean
};

/// A material with its spectra turned into lanes; one per material of a scene.
template <int N>
struct ResolvedMaterial {
  const Material* source = nullptr;
  MaterialTraits traits;
  Spectrum<N> n, k;     ///< absolute index and n kappa per lane
  float n_mean = 1.5f;  ///< steers refracted directions
  /// F as seen from outside and from inside; forms by Material::fresnel_error.
  std::shared_ptr<const std::array<FresnelTerm<N>, 2>> fresnel;
  Spectrum<N> reflectance_zero;  ///< F(0) against air
  Spectrum<N> body_reflectance;  ///< rho_d or rho_b before textures
  Spectrum<N> body_transmittance;
  Spectrum<N> transmission_tint;
  Spectrum<N> extinction;  ///< K [1/m]
  Spectrum<N> emission;
  Spectrum<N> pane_kd;                          ///< K d
  std::optional<GaussianFacets<float>> facets;  ///< rough lobe
  Spectrum<N> coherent_g;  ///< (4 pi sigma / lambda)^2, if the source has sigma
  std::shared_ptr<const CoupledBody<N>> coupled;  ///< shared by copies of the same material
  std::shared_ptr<const SmithTable> smith;        ///< Masking::Smith
  std::shared_ptr<const Interreflection> interreflection;
  Spectrum<N> interreflected;  ///< F_ms: reflectance of light that met several facets
  std::shared_ptr<const ComparisonLobe<N>> lobe;  ///< stands in the place of the facets
};
template <int N>
[[nodiscard]] ResolvedMaterial<N> resolve_material(const Material& material,
                                                   const SpectralBasis& basis);

/// A material's numbers at a point: what textures multiplied, which side is looked at.
///
/// Local frame: z is the shading normal on the viewer's side; directions are unit and point away
/// from the surface; wo.z > 0. All densities are per solid angle.
template <int N>
class Bsdf {
 public:
  Bsdf() = default;
  /// \param front  the viewer is on the outside (front) of the surface; decides which index is
  /// where.
  Bsdf(const ResolvedMaterial<N>& material, bool front, const Spectrum<N>& body_factor,
       const Spectrum<N>& reflectance_factor, float roughness_factor);

  [[nodiscard]] bool has(std::uint32_t events) const { return (events_ & events) != 0; }
  [[nodiscard]] std::uint32_t events() const { return events_; }

  /// f(wo, wi) without the cosine; Dirac events are not part of it.
  [[nodiscard]] BsdfValue<N> eval(const Vec3f& wo, const Vec3f& wi,
                                  Transport transport = Transport::Radiance) const;
  /// Density of sample() for the same events [1/sr]; Dirac events count in the choice only.
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi,
                          std::uint32_t events = kAllEvents) const;
  /// \param u_choice, u  in [0, 1).  nullopt: the sample is absorbed (weight 0).
  [[nodiscard]] std::optional<BsdfSample<N>> sample(
      const Vec3f& wo, float u_choice, const Vec2f& u, std::uint32_t events = kAllEvents,
      Transport transport = Transport::Radiance) const;

  /// Exitance per irradiance of the diffuse parts: with E the irradiance of this side (coupled:
  /// E_B), radiance towards wo is diffuse_reflectance(wo) * E / pi.
  [[nodiscard]] Spectrum<N> diffuse_reflectance(const Vec3f& wo) const;
  [[nodiscard]] Spectrum<N> diffuse_transmittance() const { return diffuse_transmission_; }
  /// Hemispherical: share of E (E_B) that leaves as diffuse flux.
  [[nodiscard]] Spectrum<N> diffuse_albedo() const;
  /// Weight of an incident direction in E_B relative to E: B(mu) / B-bar; 1 if not coupled.
  [[nodiscard]] Spectrum<N> body_weight(float mu) const;
  [[nodiscard]] bool coupled() const { return coupled_ != nullptr; }
  /// Estimate of the directional albedo of some events (choice of lobes, denoising guides).
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo, std::uint32_t events) const;

  /// Index behind the surface relative to the viewer's side (mean over lanes).
  [[nodiscard]] float eta() const { return eta_mean_; }
  /// K of the body behind (front) or on this side (back) of a solid [1/m].
  [[nodiscard]] const Spectrum<N>& extinction() const { return extinction_; }

 private:
  /// Probabilities of the kinds of events at wo; the lobe's choice between reflection and
  /// transmission is made at the sampled facet.
  struct Choice {
    float diffuse_reflection = 0, diffuse_transmission = 0, lobe = 0;
    float mirror = 0, refraction = 0, pane_reflection = 0, pane_straight = 0;
  };
  [[nodiscard]] Choice choose(const Vec3f& wo, std::uint32_t events) const;
  [[nodiscard]] Spectrum<N> fresnel(float c) const;
  [[nodiscard]] float cos_refracted(float cos_incident) const;      // 0: total reflection
  [[nodiscard]] Spectrum<N> coherent_reflection(float mu) const;    // Gamma_r
  [[nodiscard]] Spectrum<N> coherent_transmission(float mu) const;  // Gamma_t
  [[nodiscard]] Spectrum<N> incoherent_share(float mu_o, float mu_i) const;
  [[nodiscard]] Spectrum<N> mirror_weight(float mu) const;
  [[nodiscard]] Spectrum<N> refraction_weight(float mu, Transport transport) const;
  [[nodiscard]] Spectrum<N> lobe_reflection(const Vec3f& wo, const Vec3f& wi) const;
  /// The facet that refracts one direction into the other.
  struct RefractingFacet {
    Vec3f h;
    float lh, bh;
    float factor;    ///< refraction_factor()
    float jacobian;  ///< solid angle of facets per solid angle of wi
  };
  [[nodiscard]] std::optional<RefractingFacet> refraction(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] Spectrum<N> lobe_transmission(const Vec3f& wo, const Vec3f& wi,
                                              Transport transport) const;
  [[nodiscard]] float masking(const Vec3f& wo, const Vec3f& wi, float nh, float lh, float bh) const;
  [[nodiscard]] Spectrum<N> interreflection(float mu_o, float mu_i) const;
  [[nodiscard]] float interreflection_probability(float mu) const;
  void use_comparison_lobe(const ResolvedMaterial<N>& material, const Spectrum<N>& body_factor,
                           float roughness_factor);
  [[nodiscard]] const ComparisonLobe<N>& comparison() const {
    return textured_lobe_ ? *textured_lobe_ : *lobe_;
  }
  [[nodiscard]] Spectrum<N> comparison_albedo(const Vec3f& wo, std::uint32_t events) const;
  [[nodiscard]] float reflect_probability(float cos_facet, std::uint32_t events) const;
  [[nodiscard]] float lobe_pdf(const Vec3f& wo, const Vec3f& wi, std::uint32_t events) const;
  [[nodiscard]] float pdf(const Choice& choice, const Vec3f& wo, const Vec3f& wi,
                          std::uint32_t events) const;
  [[nodiscard]] std::optional<Vec3f> sample_lobe(const Vec3f& wo, float u_choice, const Vec2f& u,
                                                 std::uint32_t events) const;
  [[nodiscard]] std::optional<BsdfSample<N>> sample_dirac(const Choice& choice, const Vec3f& wo,
                                                          float x, Transport transport) const;

  std::uint32_t events_ = 0;
  Spectrum<N> diffuse_reflection_, diffuse_transmission_;
  Spectrum<N> eta_, k_;  ///< n2/n1 and k2/n1 per lane, seen from the viewer's side
  float eta_mean_ = 1.0f;
  double eta_exact_ = 1.0;  ///< eta_mean_ before rounding
  float k_rg_ = 0.0f, k_tp_rg_ = 0.0f;
  Spectrum<N> tint_;                ///< on directed transmission
  Spectrum<N> reflectance_factor_;  ///< on the interface's reflectance
  Spectrum<N> pane_kd_;
  Spectrum<N> extinction_;
  Spectrum<N> coherent_g_;  ///< (4 pi sigma / lambda)^2 per lane
  bool coherent_ = false;   ///< sigma is given: lobe and mirror share the light
  std::optional<GaussianFacets<float>> facets_;
  const CoupledBody<N>* coupled_ = nullptr;
  const FresnelTerm<N>* fresnel_ = nullptr;
  const ComparisonLobe<N>* lobe_ = nullptr;
  std::optional<ComparisonLobe<N>> textured_lobe_;  ///< lobe_ with this point's roughness
  Spectrum<N> lobe_weight_;
  const SmithTable* smith_ = nullptr;
  const Interreflection* interreflection_ = nullptr;
  Spectrum<N> interreflected_;
};

extern template class Bsdf<1>;
extern template class Bsdf<3>;
extern template class Bsdf<4>;
extern template class Bsdf<8>;

}  // namespace atrium::material
