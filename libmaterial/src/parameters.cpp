#include "material/parameters.h"

#include <cmath>
#include <numbers>

#include "material/coherent.h"
#include "material/fresnel.h"
#include "material/interface_albedo.h"
#include "require.h"

namespace atrium::material {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kRoughest = 1e6;  // c beyond which facets are a mirror to any eye

void require_above_0(const char* name, double v) {
  require(v > 0.0 && v < kInf, name, v, "above 0 and finite");
}

void check(const SurfaceStatistics& s) {
  const auto at_least_0 = [](const char* name, double v) {
    require(v >= 0.0 && v < kInf, name, v, "at least 0 and finite");
  };
  at_least_0("sigma", s.sigma);
  require_above_0("tau", s.tau);
  require_above_0("n", s.n);
  at_least_0("kappa", s.kappa);
  at_least_0("scattering", s.scattering);
  at_least_0("thickness", s.thickness);
}

double slope(const SurfaceStatistics& s) { return 2.0 * s.sigma / s.tau; }

// Reflectance of a scattering half-space under an interface (Hapke's two streams inside,
// Saunderson's correction for the interface).
double body_reflectance(const SurfaceStatistics& s, double K, double F_outside) {
  if (!(s.scattering > 0.0)) return 0.0;
  const double W = s.scattering / (s.scattering + K);
  const double root = std::sqrt(1.0 - W);
  const double infinite = (1.0 - root) / (1.0 + root);
  const double F_inside = 1.0 - (1.0 - F_outside) / (s.n * s.n);
  return (1.0 - F_outside) * (1.0 - F_inside) * infinite / (1.0 - F_inside * infinite);
}

FacetValidity validity_of(const SurfaceStatistics& s, double m, double lambda) {
  if (s.sigma == 0.0) return FacetValidity::Mirror;
  if (!(s.tau > lambda)) return FacetValidity::FineStructure;
  if (!(s.sigma >= lambda)) return FacetValidity::LowRelief;
  return m > 0.5 ? FacetValidity::Steep : FacetValidity::Valid;
}

}  // namespace

const char* describe(FacetValidity validity) {
  switch (validity) {
    case FacetValidity::Mirror:
      return "smooth: a mirror, no facets";
    case FacetValidity::Valid:
      return "facets are valid (sigma >= lambda, tau > lambda)";
    case FacetValidity::LowRelief:
      return "sigma < lambda: wave optics; mirror part by Gamma, lobe shape approximate";
    case FacetValidity::FineStructure:
      return "tau <= lambda: structure finer than the wavelength; facets do not apply";
    case FacetValidity::Steep:
      return "rms slope above 0.5: c = 1/m is a rough fit and interreflection matters";
  }
  return "";
}

double extinction_coefficient(double k, double lambda) {
  return 4.0 * std::numbers::pi * k / lambda;
}

double facet_albedo(const SurfaceStatistics& s) {
  check(s);
  const double m = slope(s);
  return m > 0.0 && 1.0 / m <= kRoughest ? mean_white_albedo(1.0 / m) : 1.0;
}

DerivedParameters derive_parameters(const SurfaceStatistics& s, double lambda) {
  return derive_parameters(s, lambda, facet_albedo(s));
}

DerivedParameters derive_parameters(const SurfaceStatistics& s, double lambda,
                                    double facet_albedo) {
  check(s);
  require_above_0("lambda", lambda);
  DerivedParameters d{};
  const double k = s.n * s.kappa;
  d.m = slope(s);
  d.c = d.m > 0.0 ? 1.0 / d.m : kInf;
  d.gamma_mean = coherent_reflection_mean(s.sigma, lambda);
  d.F_mean = fresnel_mean(s.n, k);
  d.K = extinction_coefficient(k, lambda);
  d.body = body_reflectance(s, d.K, d.F_mean);
  d.validity = validity_of(s, d.m, lambda);

  const double E = facet_albedo;
  const double specular = d.F_mean * (d.gamma_mean + (1.0 - d.gamma_mean) * E);
  const double diffuse =
      (1.0 - d.gamma_mean) * (1.0 - E) * interreflected_fresnel(d.F_mean, E) + d.body;
  const double sum = specular + diffuse;
  d.k_df = sum > 0.0 ? diffuse / sum : 0.0;  // n = 1, kappa = 0: nothing is reflected
  d.k_rg = 1.0 - d.k_df;
  d.k_tp_rg = std::exp(-s.scattering * s.thickness);
  d.k_tp_df = -std::expm1(-s.scattering * s.thickness);
  return d;
}

}  // namespace atrium::material
