#pragma once

#include <array>
#include <optional>
#include <variant>

#include "material/frame.h"
#include "material/models/blinn_phong.h"
#include "material/models/cook_torrance.h"
#include "material/models/ggx.h"
#include "material/models/hanrahan_krueger.h"
#include "material/models/he.h"
#include "material/models/lambert.h"
#include "material/models/oren_nayar.h"
#include "material/models/phong.h"
#include "material/models/schlick94.h"
#include "material/spectrum.h"

namespace atrium::material {

/// The comparison models with resolved parameters, ready for a renderer. Each is a value with
///
///   diffuse         albedo of its Lambertian part, which the renderer treats as diffuse
///   eval(wo, wi)    f [1/sr] without the cosine and without Lambertian and Dirac parts; 0 unless
///                   both directions are above the horizon
///   sample(wo, u)   a direction for eval by u in [0, 1)^2; nullopt: absorbed (weight 0)
///   pdf(wo, wi)     density of sample() [1/sr]; 1 minus its integral is the absorbed probability
///   mirror(mu)      Dirac reflectance at the cosine mu
///   albedo(wo)      a cheap ESTIMATE of the directional albedo of eval, for choosing lobes
///   has_lobe(), has_mirror()   whether eval, mirror can be non-zero
///
/// The weight eval cos / pdf is bounded: kLargestWeight (times ks, F ..., at most 1) per lobe.
/// Parameters are not checked here: validate() the ...Parameters they come from.

template <int N>
struct LambertLobe {
  static constexpr float kLargestWeight = 0.0f;
  Spectrum<N> diffuse;

  [[nodiscard]] bool has_lobe() const { return false; }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f&, const Vec3f&) const { return {}; }
  [[nodiscard]] float pdf(const Vec3f&, const Vec3f&) const { return 0.0f; }
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f&, const Vec2f&) const { return {}; }
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f&) const { return {}; }
};

/// Cosine power about the mirror direction; for p < 1 the hemisphere (cosine, original: uniform).
template <int N>
struct PhongLobe {
  static constexpr float kLargestWeight = 2.0f;  ///< 1.5 unless original
  Spectrum<N> diffuse;                           ///< kd
  Spectrum<N> ks;
  float p = 20.0f;
  /// The model of 1975 as it shines under irradiance E = pi times its source intensity:
  /// f = kd/pi + ks (r.b)^p / (pi n.l). Not reciprocal; f is unbounded, its weight is not.
  bool original = false;

  [[nodiscard]] bool has_lobe() const { return !ks.is_zero(); }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// Facets by (p + 1)/(2 pi) cos^p for p > 10; cosine below.
template <int N>
struct BlinnPhongLobe {
  static constexpr float kLargestWeight = 2.2f;
  Spectrum<N> diffuse;  ///< kd
  Spectrum<N> ks;
  float p = 20.0f;

  [[nodiscard]] bool has_lobe() const { return !ks.is_zero(); }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// Facets by D cos; weight F G (b.h) / ((n.b)(n.h)) <= 2 F.
template <int N>
struct CookTorranceLobe {
  static constexpr float kLargestWeight = 2.0f;
  Spectrum<N> diffuse;  ///< kd rho
  Spectrum<N> ks;
  Spectrum<N> n{1.5f}, k;
  float m = 0.2f;

  [[nodiscard]] bool has_lobe() const { return !ks.is_zero(); }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// Visible facets (Heitz 2018); weight F G2 / G1 <= F.
template <int N>
struct GgxLobe {
  static constexpr float kLargestWeight = 1.0f;
  Spectrum<N> diffuse;
  Spectrum<N> n{1.5f}, k;
  std::optional<Spectrum<N>> f0;  ///< Schlick's Fresnel instead of n, k
  float alpha = 0.3f;

  [[nodiscard]] bool has_lobe() const { return true; }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
  [[nodiscard]] Spectrum<N> fresnel_at(float cos_phi) const;
};

/// Cosine and uniform density in the ratio A : B of the qualitative model, whose second term times
/// the cosine does not fall towards the horizon. The full fit's negative values count as 0.
template <int N>
struct OrenNayarLobe {
  static constexpr float kLargestWeight = 2.5f;
  Spectrum<N> diffuse;  ///< stays 0: nothing of it is Lambertian
  Spectrum<N> rho;
  float s = 0.3f;
  bool full = true;

  [[nodiscard]] bool has_lobe() const { return !rho.is_zero(); }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// The scattering itself: refract, phase function, refract; what goes deeper or is kept inside is
/// absorbed. Weight (1-F)(1-F) W mu_i/(mu_i + mu_o) (1 - e^...) <= W.
template <int N>
struct HanrahanKruegerLobe {
  static constexpr float kLargestWeight = 1.0f;
  Spectrum<N> diffuse;  ///< stays 0
  Spectrum<N> W, taud;
  float n = 1.4f;
  float g = 0.0f;

  [[nodiscard]] bool has_lobe() const { return !W.is_zero() && !taud.is_zero(); }
  [[nodiscard]] bool has_mirror() const { return false; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float) const { return {}; }
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// Facets by the model's Z and cosine, in equal parts (fewer facets as the lobe's share falls).
/// The bound holds for isotropy p = 1 and grows as 1 / sqrt(p).
template <int N>
struct Schlick1994Lobe {
  static constexpr float kLargestWeight = 6.0f;
  Spectrum<N> diffuse;  ///< stays 0: the Lambertian term carries a Fresnel factor
  Spectrum<N> f0;
  float r = 0.3f;
  float p = 1.0f;

  [[nodiscard]] bool has_lobe() const { return r > 0.0f; }
  [[nodiscard]] bool has_mirror() const { return r < 0.5f; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float mu) const;
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
};

/// Each lane at its wavelength (the sum costs some 25 to 100 exponentials per lane and eval).
/// Sampled by visible facets of a GGX density of the lobe's slope (the widest of the lanes'), whose
/// tails outlast those of every order of the sum, and by cosine (1 in 5).
template <int N>
struct He1991Lobe {
  static constexpr float kLargestWeight = 6.0f;
  Spectrum<N> diffuse;  ///< pi a
  Spectrum<N> n{1.5f}, k;
  std::array<float, N> lambda{};  ///< in the incident medium, unit of sigma0 and tau
  float sigma0 = 0.1f;
  float tau = 1.0f;

  [[nodiscard]] bool has_lobe() const { return sigma0 > 0.0f; }
  [[nodiscard]] bool has_mirror() const { return true; }
  [[nodiscard]] Spectrum<N> eval(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] float pdf(const Vec3f& wo, const Vec3f& wi) const;
  [[nodiscard]] std::optional<Vec3f> sample(const Vec3f& wo, const Vec2f& u) const;
  [[nodiscard]] Spectrum<N> mirror(float mu) const;
  [[nodiscard]] Spectrum<N> albedo(const Vec3f& wo) const;
  /// Slope of the facet density that stands for the lobe seen under the cosine mu.
  [[nodiscard]] float lobe_slope(float mu) const;
};

template <int N>
using ComparisonLobe =
    std::variant<LambertLobe<N>, PhongLobe<N>, BlinnPhongLobe<N>, CookTorranceLobe<N>, GgxLobe<N>,
                 OrenNayarLobe<N>, HanrahanKruegerLobe<N>, Schlick1994Lobe<N>, He1991Lobe<N>>;

#define ATRIUM_EXTERN_LOBES(N)                   \
  extern template struct PhongLobe<N>;           \
  extern template struct BlinnPhongLobe<N>;      \
  extern template struct CookTorranceLobe<N>;    \
  extern template struct GgxLobe<N>;             \
  extern template struct OrenNayarLobe<N>;       \
  extern template struct HanrahanKruegerLobe<N>; \
  extern template struct Schlick1994Lobe<N>;     \
  extern template struct He1991Lobe<N>;
ATRIUM_EXTERN_LOBES(1)
ATRIUM_EXTERN_LOBES(3)
ATRIUM_EXTERN_LOBES(4)
ATRIUM_EXTERN_LOBES(8)
#undef ATRIUM_EXTERN_LOBES

}  // namespace atrium::material
