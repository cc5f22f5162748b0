#include "material/models/lobes.h"

#include "lobe_sampling.h"

namespace atrium::material {
namespace {

using detail::above;
using detail::kInvPiF;
using detail::kPiF;
using Halfway = detail::Halfway<float>;

template <int N>
Spectrum<N> fresnel_of(float c, const Spectrum<N>& n, const Spectrum<N>& k) {
  return Spectrum<N>::generate([&](int i) { return fresnel(c, n[i], k[i]).mean(); });
}

template <int N>
Spectrum<N> schlick_of(float c, const Spectrum<N>& f0) {
  const float x = detail::pow5(std::max(0.0f, 1.0f - c));
  return f0 + (Spectrum<N>::one() - f0) * x;
}

float cosine_density(const Vec3f& w) { return w.z() * kInvPiF; }

}  // namespace

// ---- Phong ----

template <int N>
Spectrum<N> PhongLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return {};
  const float power = phong_cosine_power(wi, wo, p) * kInvPiF;
  return ks * (original ? power / wi.z() : 0.5f * (p + 2.0f) * power);
}

template <int N>
float PhongLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  if (p < 1.0f) return original ? 0.5f * kInvPiF : cosine_density(wi);
  return 0.5f * (p + 1.0f) * kInvPiF * phong_cosine_power(wi, wo, p);
}

template <int N>
std::optional<Vec3f> PhongLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  if (p < 1.0f)
    return detail::if_above(original ? detail::sample_uniform_hemisphere(u)
                                     : sample_cosine_hemisphere(u));
  const Frame about(Vec3f(-wo.x(), -wo.y(), wo.z()));
  return detail::if_above(about.to_world(detail::sample_cosine_power(p, u)).normalized());
}

template <int N>
Spectrum<N> PhongLobe<N>::albedo(const Vec3f& wo) const {
  return ks * (original ? 2.0f / (p + 2.0f) : (p * wo.z() + 1.0f) / (p + 1.0f));
}

// ---- Blinn-Phong ----

namespace {
constexpr float kBlinnCosineBelow = 10.0f;  // either density's bound is 2.1 here
}

template <int N>
Spectrum<N> BlinnPhongLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  return ks * blinn_phong(wi, wo, 0.0f, 1.0f, p);
}

template <int N>
float BlinnPhongLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  if (p <= kBlinnCosineBelow) return cosine_density(wi);
  const Halfway q(wi, wo);
  const float facet = 0.5f * (p + 1.0f) * kInvPiF * detail::cosine_power(q.xy2, q.z, p);
  return detail::mirrored_density(facet, q);
}

template <int N>
std::optional<Vec3f> BlinnPhongLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  if (p <= kBlinnCosineBelow) return detail::if_above(sample_cosine_hemisphere(u));
  return detail::reflect(wo, detail::sample_cosine_power(p, u));
}

template <int N>
Spectrum<N> BlinnPhongLobe<N>::albedo(const Vec3f& wo) const {
  return ks * ((p * wo.z() * wo.z() + 1.0f) / (p + 1.0f));
}

// ---- Cook-Torrance ----

template <int N>
Spectrum<N> CookTorranceLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  const float facets = cook_torrance_facets(wi, wo, m);
  if (!(facets > 0.0f)) return {};
  return ks * fresnel_of(Halfway(wi, wo).cos_phi(), n, k) * facets;
}

template <int N>
float CookTorranceLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  const Halfway q(wi, wo);
  return detail::mirrored_density(beckmann_density(q.tan2_delta(), m) * q.z / std::sqrt(q.norm2),
                                  q);
}

template <int N>
std::optional<Vec3f> CookTorranceLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  return detail::reflect(wo, detail::sample_beckmann_facet(m, u));
}

template <int N>
Spectrum<N> CookTorranceLobe<N>::albedo(const Vec3f& wo) const {
  return ks * fresnel_of(wo.z(), n, k);
}

// ---- GGX ----

template <int N>
Spectrum<N> GgxLobe<N>::fresnel_at(float cos_phi) const {
  return f0 ? schlick_of(cos_phi, *f0) : fresnel_of(cos_phi, n, k);
}

template <int N>
Spectrum<N> GgxLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  const float facets = ggx_facets(wi, wo, alpha);
  if (!(facets > 0.0f)) return {};
  return fresnel_at(Halfway(wi, wo).cos_phi()) * facets;
}

template <int N>
float GgxLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  return detail::visible_ggx_density(wo, Halfway(wi, wo), alpha);
}

template <int N>
std::optional<Vec3f> GgxLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  return detail::reflect(wo, detail::sample_visible_ggx_facet(wo, alpha, u));
}

template <int N>
Spectrum<N> GgxLobe<N>::albedo(const Vec3f& wo) const {
  return fresnel_at(wo.z());
}

// ---- Oren-Nayar ----

namespace {
// Share of the cosine density, A / (A + B) of the qualitative model.
float oren_nayar_cosine_share(float s) {
  const float s2 = s * s;
  const float A = 1.0f - 0.5f * s2 / (s2 + 0.33f), B = 0.45f * s2 / (s2 + 0.09f);
  return A / (A + B);
}
}  // namespace

template <int N>
Spectrum<N> OrenNayarLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  return Spectrum<N>::generate([&](int i) {
    return full ? std::max(0.0f, oren_nayar_full(wi, wo, rho[i], s))
                : oren_nayar_qualitative(wi, wo, rho[i], s);
  });
}

template <int N>
float OrenNayarLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  const float share = oren_nayar_cosine_share(s);
  return share * cosine_density(wi) + (1.0f - share) * 0.5f * kInvPiF;
}

template <int N>
std::optional<Vec3f> OrenNayarLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  const float share = oren_nayar_cosine_share(s);
  return detail::if_above(
      u.x() < share ? sample_cosine_hemisphere({u.x() / share, u.y()})
                    : detail::sample_uniform_hemisphere({(u.x() - share) / (1.0f - share), u.y()}));
}

template <int N>
Spectrum<N> OrenNayarLobe<N>::albedo(const Vec3f&) const {
  return rho;
}

// ---- Hanrahan-Krueger ----

template <int N>
Spectrum<N> HanrahanKruegerLobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  return Spectrum<N>::generate(
      [&](int i) { return hanrahan_krueger(wi, wo, n, W[i], taud[i], g); });
}

template <int N>
float HanrahanKruegerLobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return 0.0f;
  const detail::InsideDirections<float> in(wi, wo, n, false);
  if (!(in.mu_i > 0.0f && in.mu_o > 0.0f)) return 0.0f;
  // Solid angle inside per outside: cos / (n^2 mu).
  return detail::henyey_greenstein(in.minus2, in.plus2, g) * wi.z() / (n * n * in.mu_i);
}

template <int N>
std::optional<Vec3f> HanrahanKruegerLobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo)) return std::nullopt;
  const float mu = detail::refracted_cosine(wo.z(), n);
  if (!(mu > 0.0f)) return std::nullopt;
  const Vec3f down = Vec3f(-wo.x() / n, -wo.y() / n, -mu).normalized();
  // Inverse of the phase function's distribution; in double, since it divides by g.
  const double gd = static_cast<double>(g), ud = static_cast<double>(u.x());
  const double ratio = (1.0 - gd * gd) / (1.0 + gd - 2.0 * gd * ud);
  const double cosine =
      std::abs(gd) < 1e-6 ? 1.0 - 2.0 * ud : (1.0 + gd * gd - ratio * ratio) / (2.0 * gd);
  const float c = static_cast<float>(std::clamp(cosine, -1.0, 1.0));
  const float sine2 = static_cast<float>(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  const Vec3f v = Frame(down).to_world(detail::at_azimuth(sine2, c, u.y())).normalized();
  if (!(v.z() > 0.0f)) return std::nullopt;
  const float cos2 = (1.0f - n) * (1.0f + n) + n * n * v.z() * v.z();
  if (!(cos2 > 0.0f)) return std::nullopt;  // kept inside
  return detail::if_above(Vec3f(n * v.x(), n * v.y(), std::sqrt(cos2)).normalized());
}

template <int N>
Spectrum<N> HanrahanKruegerLobe<N>::albedo(const Vec3f& wo) const {
  const float mu = std::max(1e-3f, detail::refracted_cosine(wo.z(), n));
  const float through = 0.5f * (1.0f - g) * detail::fresnel_transmittance(wo.z(), n) / (1.0f + mu);
  return Spectrum<N>::generate(
      [&](int i) { return W[i] * through * (1.0f - std::exp(-taud[i] / mu)); });
}

// ---- Schlick 1994 ----

namespace {

float schlick_facet_share(float r) { return r < 0.5f ? 0.5f : 2.0f * r * (1.0f - r); }

// Density Z t / pi in the polar angle; half of the azimuths uniform, half A^2 / (2 pi), which
// bounds A by their mean (1 + A^2)/2.
float schlick_facet_density(const Halfway& q, float r, float p) {
  const float z = (r * q.z * q.z + q.xy2) / q.norm2;
  const float A2 = detail::schlick1994_azimuth(q, p);
  return r / (z * z) * q.z / std::sqrt(q.norm2) * kInvPiF * 0.5f * (1.0f + A2);
}

Vec3f sample_schlick_facet(float r, float p, const Vec2f& u) {
  const float y = u.y() < 0.5f ? 2.0f * u.y() : 2.0f * u.y() - 1.0f;
  Vec3f around = detail::at_azimuth(1.0f, 0.0f, y);
  if (u.y() >= 0.5f) around = Vec3f(p * around.x(), around.y(), 0.0f).normalized();
  const float d = r + (1.0f - r) * u.x();
  Vec3f h = around * std::sqrt(r * (1.0f - u.x()) / d);
  h.z() = std::sqrt(u.x() / d);
  return h;
}

}  // namespace

template <int N>
Spectrum<N> Schlick1994Lobe<N>::eval(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi)) return {};
  const float shape = schlick1994(wi, wo, 1.0f, r, p).f;
  return schlick_of(Halfway(wi, wo).cos_phi(), f0) * shape;
}

template <int N>
float Schlick1994Lobe<N>::pdf(const Vec3f& wo, const Vec3f& wi) const {
  if (!above(wo, wi) || !has_lobe()) return 0.0f;
  const Halfway q(wi, wo);
  const float share = schlick_facet_share(r);
  return share * detail::mirrored_density(schlick_facet_density(q, r, p), q) +
         (1.0f - share) * cosine_density(wi);
}

template <int N>
std::optional<Vec3f> Schlick1994Lobe<N>::sample(const Vec3f& wo, const Vec2f& u) const {
  if (!above(wo) || !has_lobe()) return std::nullopt;
  const float share = schlick_facet_share(r);
  if (u.x() >= share)
    return detail::if_above(sample_cosine_hemisphere({(u.x() - share) / (1.0f - share), u.y()}));
  return detail::reflect(wo, sample_schlick_facet(r, p, {u.x() / share, u.y()}));
}

template <int N>
Spectrum<N> Schlick1994Lobe<N>::mirror(float mu) const {
  return schlick_of(mu, f0) * Schlick1994Shares<float>(r).mirror;
}

template <int N>
Spectrum<N> Schlick1994Lobe<N>::albedo(const Vec3f& wo) const {
  return schlick_of(wo.z(), f0) * (1.0f - Schlick1994Shares<float>(r).mirror);
}

#define ATRIUM_LOBES(N)                   \
  template struct PhongLobe<N>;           \
  template struct BlinnPhongLobe<N>;      \
  template struct CookTorranceLobe<N>;    \
  template struct GgxLobe<N>;             \
  template struct OrenNayarLobe<N>;       \
  template struct HanrahanKruegerLobe<N>; \
  template struct Schlick1994Lobe<N>;
ATRIUM_LOBES(1)
ATRIUM_LOBES(3)
ATRIUM_LOBES(4)
ATRIUM_LOBES(8)

}  // namespace atrium::material
