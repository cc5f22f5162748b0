#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "material/coherent.h"
#include "material/fresnel.h"
#include "material/microfacet.h"
#include "material/smith.h"

namespace atrium::material {

/// Which facets hide each other.
enum class Masking {
  None,     ///< G = 1
  VCavity,  ///< Torrance & Sparrow 1967
  Smith     ///< Smith 1967 for this distribution; reflection height-correlated
};

/// G of a facet with cosine nh, whose sides see the two directions at bh, lh > 0; nb, nl are taken
/// absolutely. `transmitted`: the Smith form is the product. Smith by quadrature: exact and slow.
[[nodiscard]] double masking_term(Masking masking, double c, double nl, double nb, double nh,
                                  double lh, double bh, bool transmitted);

/// Halfway facet of two directions l below, b above the surface (Hall & Greenberg 1983), unit;
/// none where no facet refracts one into the other.
/// \param eta  index of the far side (l) over that of the near side (b).
template <class Real>
[[nodiscard]] std::optional<Vec3<Real>> refracting_facet(const Vec3<Real>& l, const Vec3<Real>& b,
                                                         Real eta) {
  if (eta == Real(1)) return std::nullopt;
  const Vec3<Real> m = eta > Real(1) ? Vec3<Real>(-(b + eta * l)) : Vec3<Real>(b + eta * l);
  const Real length = m.norm();
  if (!(length > Real(0))) return std::nullopt;
  const Vec3<Real> h = m / length;
  if (!(h.dot(b) > Real(0)) || !(h.dot(l) < Real(0)) || !(h.z() > Real(0))) return std::nullopt;
  return h;
}

/// Jacobian of refraction times the two facet cosines over the two surface cosines: f_t over
/// (1 - F) D G, radiance that enters the near side (b) from the far side (l). [1]
/// Source: Walter et al. 2007, eq. 21.
template <class Real>
[[nodiscard]] Real refraction_factor(Real nl, Real nb, Real lh, Real bh, Real eta) {
  const Real d = eta * lh + bh;
  return std::abs(lh * bh) / (std::abs(nl * nb) * d * d);
}

/// f_s = F D G / (4 (n.l)(n.b)) [1/sr]; 0 unless both directions are above the surface.
/// \param n, k  of the far side, relative to the near one.  Source: MATERIAL_MODEL 5.3.
[[nodiscard]] double brdf_specular(const Vec3d& l, const Vec3d& b,
                                   const GaussianFacets<double>& facets, double n, double k,
                                   Masking masking = Masking::VCavity);

/// f_t [1/sr], radiance in medium 1 (b above) by light from medium 2 (l below); absolute indices,
/// the factor (n1/n2)^2 of radiance included. 0 where no facet refracts l into b.
[[nodiscard]] double btdf_specular(const Vec3d& l, const Vec3d& b,
                                   const GaussianFacets<double>& facets, double n1, double n2,
                                   Masking masking = Masking::VCavity);

/// Convex combination of an opaque surface [1/sr]: k_df rho_d / pi + k_rg (1 - Gamma) f_s.
/// \param sigma_over_lambda  rms height over the wavelength; nullopt: Gamma = 0.
/// Source: MATERIAL_MODEL 5.4 and 5.5.
[[nodiscard]] double brdf_convex(const Vec3d& l, const Vec3d& b,
                                 const GaussianFacets<double>& facets, double n, double k_df,
                                 double k_rg, double rho_d, std::optional<double> sigma_over_lambda,
                                 Masking masking = Masking::VCavity);

}  // namespace atrium::material
