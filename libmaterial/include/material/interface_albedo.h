#pragma once

#include "material/rough_interface.h"

namespace atrium::material {

/// Directional albedos of a rough interface: shares of the flux that arrives (or, by reciprocity,
/// of uniform radiance seen) at a cosine mu. One scattering off a facet; what the facets catch is
/// lost.
struct InterfaceAlbedo {
  double reflected, transmitted;
};

/// Albedo of f_s at the cosine mu in (0, 1], by quadrature over the facets; absolute error below
/// 1e-8 (Smith: 1e-4, by its table).
/// \param n, k  relative to the near side.
[[nodiscard]] double specular_albedo(double mu, double c, double n, double k,
                                     Masking masking = Masking::VCavity);
/// The same for a perfect reflector, F = 1.
[[nodiscard]] double white_albedo(double mu, double c, Masking masking = Masking::VCavity);

/// Both shares of a dielectric; absolute error below 1e-6. \param n  n_transmitted / n_incident.
[[nodiscard]] InterfaceAlbedo dielectric_albedo(double mu, double c, double n,
                                                Masking masking = Masking::VCavity);

/// Cosine mean of white_albedo over the hemisphere, V-cavities; 1 minus it is what one scattering
/// loses. Absolute error below 1e-6.
[[nodiscard]] double mean_white_albedo(double c);

/// Fresnel factor of light that left the facets after more than one reflection:
/// F^2 E / (1 - F (1 - E)) for the means F of the reflectance and E of white_albedo.
/// Source: Kulla & Conty 2017; MATERIAL_MODEL 5.5.
[[nodiscard]] inline double interreflected_fresnel(double mean_fresnel, double mean_albedo) {
  return mean_fresnel * mean_fresnel * mean_albedo / (1.0 - mean_fresnel * (1.0 - mean_albedo));
}

/// Coupled combination of an opaque dielectric (MATERIAL_MODEL 5.5): the interface with weight 1,
/// under it a body of reflectance rho_b that gets what the interface lets through.
class CoupledInterface {
 public:
  CoupledInterface(double c, double n, double rho_b);
  /// f_s + rho_b B(l) B(b) / (pi B-bar) [1/sr].
  [[nodiscard]] double brdf(const Vec3d& l, const Vec3d& b) const;
  /// Albedo R(mu) + rho_b B(mu) <= 1.
  [[nodiscard]] double albedo(double mu) const;
  /// B(mu) = 1 - R(mu).
  [[nodiscard]] double transmitted(double mu) const;
  /// B-bar = 2 * integral of B mu dmu.
  [[nodiscard]] double mean_transmitted() const { return mean_; }

 private:
  GaussianFacets<double> facets_;
  double n_, rho_b_, mean_;
};

}  // namespace atrium::material
