#include "material/parameters.h"

#include <optional>
#include <utility>

#include "material/error.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

void extinction(const Inputs& in, Answer& out) {
  out.number("K_per_m", material::extinction_coefficient(in["n"] * in["kappa"], in["lambda_m"]));
}

/// Queries often come as many wavelengths of one surface: the last slope is remembered.
double cached_facet_albedo(const material::SurfaceStatistics& surface) {
  thread_local std::optional<std::pair<double, double>> last;  // slope, albedo
  const double slope = surface.sigma / surface.tau;
  if (!last || last->first != slope) last.emplace(slope, material::facet_albedo(surface));
  return last->second;
}

void derive(const Inputs& in, Answer& out) {
  material::SurfaceStatistics surface;
  surface.sigma = in["sigma"];
  surface.tau = in["tau"];
  surface.n = in["n"];
  surface.kappa = in["kappa"];
  surface.scattering = in.get("mu_s", 0.0);
  surface.thickness = in.get("thickness", 0.0);
  const material::DerivedParameters p =
      material::derive_parameters(surface, in["lambda_"], cached_facet_albedo(surface));
  out.number("m", p.m);
  out.number_or_infinite("c", p.c);
  out.number("gamma_mean", p.gamma_mean);
  out.number("F_mean", p.F_mean);
  out.number("k_df", p.k_df);
  out.number("k_rg", p.k_rg);
  out.number("K", p.K);
  if (in.has("mu_s") || in.has("thickness")) {
    out.number("k_tp_df", p.k_tp_df);
    out.number("k_tp_rg", p.k_tp_rg);
  }
}

}  // namespace

std::vector<Kind> parameter_kinds() {
  const Input n = number("n", "absolute index", above(0.0));
  const Input kappa = number("kappa", "index of absorption k / n", at_least(0.0));
  return {
      {"extinction",
       "Lambert extinction 4 pi n kappa / lambda",
       {n, kappa, number("lambda_m", "vacuum wavelength [m]", above(0.0))},
       "`K_per_m`",
       extinction},
      {"derive",
       "the paper's parameters of a surface; lengths in one unit",
       {number("sigma", "rms height", at_least(0.0)),
        number("tau", "correlation length", above(0.0)),
        number("lambda_", "vacuum wavelength", above(0.0)), n, kappa,
        optional(number("mu_s", "scattering of the bulk [1/length]", at_least(0.0))),
        optional(number("thickness", "of a transmitting body", at_least(0.0)))},
       "`m`, `c` (\"inf\" for sigma = 0), `gamma_mean`, `F_mean`, `k_df`, `k_rg`, `K` [1/length]; "
       "`k_tp_df`, `k_tp_rg` if `mu_s` or `thickness` is given",
       derive}};
}

}  // namespace atrium::material_query
