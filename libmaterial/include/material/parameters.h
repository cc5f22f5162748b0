#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace atrium::material {

/// Lambert extinction K = 4 pi k / lambda [1/m] of a medium with k = n kappa (absolute) at the
/// vacuum wavelength lambda [m].
[[nodiscard]] double extinction_coefficient(double k, double lambda);

/// A surface as it is made: heights of rms sigma with autocorrelation exp(-r^2 / tau^2), on a
/// material of index n (1 + i kappa) against air, whose bulk may scatter.
struct SurfaceStatistics {
  double sigma = 0.0;       ///< rms height [m], >= 0; 0: smooth
  double tau = 1e-6;        ///< correlation length [m], > 0
  double n = 1.5;           ///< > 0
  double kappa = 0.0;       ///< index of absorption, >= 0
  double scattering = 0.0;  ///< mu_s of the bulk [1/m], >= 0
  double thickness = 0.0;   ///< [m] of a transmitting body, >= 0
};

/// Whether facets describe such a surface (MATERIAL_MODEL section 8).
enum class FacetValidity {
  Mirror,         ///< sigma = 0: no facets at all
  Valid,          ///< sigma / lambda >= 1 and tau > lambda
  LowRelief,      ///< sigma < lambda: waves; the lobe keeps its shape only approximately
  FineStructure,  ///< tau <= lambda: structure finer than the wave sees
  Steep           ///< rms slope above 0.5: c is a poor fit (3 % there) and facets see each other
};
[[nodiscard]] const char* describe(FacetValidity validity);

/// The paper's parameters at one wavelength.
struct DerivedParameters {
  double m;           ///< rms slope, 2 sigma / tau
  double c;           ///< 1 / m; infinite for m = 0
  double gamma_mean;  ///< cosine mean of the coherent factor
  double F_mean;      ///< cosine mean of the Fresnel reflectance
  double k_df, k_rg, k_tp_df, k_tp_rg;
  double K;     ///< extinction of the body [1/m]
  double body;  ///< R_body, what the bulk gives back
  FacetValidity validity;
};

/// \param lambda  vacuum wavelength [m], > 0.
/// \throws std::invalid_argument  naming the input, its value and the valid range.
/// Source: MATERIAL_MODEL section 8 (Saunderson 1942, Hapke 1981, Kulla & Conty 2017).
[[nodiscard]] DerivedParameters derive_parameters(const SurfaceStatistics& surface, double lambda);

/// Mean albedo of the surface's facets if they reflected everything: the costly part, which is the
/// same at all wavelengths. \throws as derive_parameters().
[[nodiscard]] double facet_albedo(const SurfaceStatistics& surface);
/// \param facet_albedo  of this surface.
[[nodiscard]] DerivedParameters derive_parameters(const SurfaceStatistics& surface, double lambda,
                                                  double facet_albedo);

}  // namespace atrium::material
