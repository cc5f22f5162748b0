#pragma once

#include <cmath>

#include "material/fresnel.h"

namespace atrium::material {

struct PaneTerms {
  float reflectance, transmittance;
};

/// A thin sheet with two smooth faces, interference averaged out, the same medium on both sides.
/// \param c   cosine outside, clamped to [0, 1].  \param n  index relative to the outside, >= 1.
/// \param kd  extinction times thickness K d, >= 0.
/// Per polarisation, then averaged (never the other way round). Source: MATERIAL_MODEL 5.6.
[[nodiscard]] inline PaneTerms pane(float c, float n, float kd) {
  c = std::fmin(std::fmax(c, 0.0f), 1.0f);
  const FresnelTerms<float> r = fresnel_dielectric(c, n);
  const float sin2 = (1.0f - c) * (1.0f + c);
  const float cos_inside = std::sqrt(std::fmax(1e-12f, 1.0f - sin2 / (n * n)));
  const float t = kd > 0.0f ? std::exp(-kd / cos_inside) : 1.0f;
  PaneTerms result{0.0f, 0.0f};
  for (const float R : {r.s, r.p}) {
    const float one = 1.0f - R;
    const float rt = R * t;
    const float d = 1.0f - rt * rt;
    const float T = d > 0.0f ? t * one * one / d : 0.0f;
    result.transmittance += 0.5f * T;
    result.reflectance += 0.5f * (d > 0.0f ? R + rt * t * one * one / d : 1.0f);
  }
  return result;
}

/// Index and K d of a pane.
struct PaneParameters {
  double n, kd;
};

/// The uncoated pane that has these values at normal incidence, as data sheets give them (EN 410):
/// \param tau_v  visible transmittance, in (0, 1].  \param rho_v  visible reflectance, >= 0.
/// \throws std::invalid_argument  naming the value and its range, also for tau_v + rho_v > 1.
/// From T and R_pane follow R = rho / (1 + t tau) and t, the root of t (1-R)^2 = tau (1 - R^2 t^2).
[[nodiscard]] PaneParameters pane_from_visible(double tau_v, double rho_v);

}  // namespace atrium::material
