#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "material/frame.h"
#include "material/models/ggx.h"

// Densities that the lobes are sampled with. u in [0, 1)^2.
namespace atrium::material::detail {

inline constexpr float kPiF = std::numbers::pi_v<float>;
inline constexpr float kInvPiF = std::numbers::inv_pi_v<float>;

[[nodiscard]] inline bool above(const Vec3f& w) { return w.z() > kHorizon<float>; }

[[nodiscard]] inline std::optional<Vec3f> if_above(const Vec3f& w) {
  if (above(w)) return w;
  return std::nullopt;
}

/// Direction at a polar angle of given sin^2 and cosine.
[[nodiscard]] inline Vec3f at_azimuth(float sine2, float cosine, float u) {
  const float phi = 2.0f * kPiF * u, s = std::sqrt(std::max(0.0f, sine2));
  return {s * std::cos(phi), s * std::sin(phi), cosine};
}

[[nodiscard]] inline Vec3f sample_uniform_hemisphere(const Vec2f& u) {
  return at_azimuth(u.x() * (2.0f - u.x()), 1.0f - u.x(), u.y());
}

/// (p + 1)/(2 pi) cos^p about z; the sine by expm1, since cos rounds to 1 for large p.
[[nodiscard]] inline Vec3f sample_cosine_power(float p, const Vec2f& u) {
  const float x = std::log1p(-u.x()) / (p + 1.0f);  // ln cos
  return at_azimuth(-std::expm1(2.0f * x), std::exp(x), u.y());
}

/// Facet with density D cos, Beckmann's D of slope m.
[[nodiscard]] inline Vec3f sample_beckmann_facet(float m, const Vec2f& u) {
  const float tan2 = -m * m * std::log1p(-u.x());
  const float cos2 = 1.0f / (1.0f + tan2);
  return at_azimuth(tan2 * cos2, std::sqrt(cos2), u.y());
}

/// Mirrors wo at the facet h; nullopt where the facet faces away or the light goes down.
[[nodiscard]] inline std::optional<Vec3f> reflect(const Vec3f& wo, const Vec3f& h) {
  const float cosine = wo.dot(h);
  if (!(cosine > 0.0f)) return std::nullopt;
  return if_above((2.0f * cosine * h - wo).normalized());
}

/// Density of the mirrored direction for a density of facets: p(h) / (4 b.h).
[[nodiscard]] inline float mirrored_density(float facet_density, const Halfway<float>& q) {
  return facet_density / (2.0f * std::sqrt(q.norm2));
}

/// Visible facets of GGX: the disk seen from wo after stretching the surface to alpha = 1 (Heitz
/// 2018). Not zero: wo is above the horizon.
[[nodiscard]] inline Vec3f sample_visible_ggx_facet(const Vec3f& wo, float alpha, const Vec2f& u) {
  const Vec3f v = Vec3f(alpha * wo.x(), alpha * wo.y(), wo.z()).normalized();
  const float across = std::sqrt(sin2(v));
  const Vec3f t1 = across > 0.0f ? Vec3f(-v.y() / across, v.x() / across, 0.0f) : Vec3f::UnitX();
  const Vec3f t2 = v.cross(t1);
  const float r = std::sqrt(u.x()), phi = 2.0f * kPiF * u.y();
  const float x = r * std::cos(phi), half = 0.5f * (1.0f + v.z());
  const float y =
      (1.0f - half) * std::sqrt(std::max(0.0f, 1.0f - x * x)) + half * r * std::sin(phi);
  const float z = std::sqrt(std::max(0.0f, 1.0f - x * x - y * y));
  const Vec3f stretched = x * t1 + y * t2 + z * v;
  return Vec3f(alpha * stretched.x(), alpha * stretched.y(), std::max(1e-6f, stretched.z()))
      .normalized();
}

/// Its density, mirrored: G1 D (b.h)/(n.b) / (4 b.h), G1 = 2 (n.b)/((n.b) + sqrt(...)) [1/sr].
[[nodiscard]] inline float visible_ggx_density(const Vec3f& wo, const Halfway<float>& q,
                                               float alpha) {
  const float root = std::sqrt(wo.z() * wo.z() + alpha * alpha * sin2(wo));
  return ggx_density(q, alpha) / (2.0f * (wo.z() + root));
}

}  // namespace atrium::material::detail
