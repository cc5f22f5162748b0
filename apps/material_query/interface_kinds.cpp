#include <array>
#include <optional>

#include "material/coherent.h"
#include "material/error.h"
#include "material/interface_albedo.h"
#include "material/rough_interface.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

using Facets = material::GaussianFacets<double>;
using material::Masking;

void brdf_spec(const Inputs& in, Answer& out) {
  const Vec3d l = in.direction("l"), b = viewer_above(in);
  const Facets facets(in["c"]);
  const double n = in["n"], k = in["k"];
  const auto f = [&](Masking masking) {
    return material::brdf_specular(l, b, facets, n, k, masking);
  };
  out.number_or_infinite("none", f(Masking::None));
  out.number_or_infinite("vcavity", f(Masking::VCavity));
  out.number_or_infinite("smith", f(Masking::Smith));
}

void btdf(const Inputs& in, Answer& out) {
  const Vec3d l = in.direction("l"), b = viewer_above(in);
  const Facets facets(in["c"]);
  const double n1 = in["n1"], n2 = in["n2"];
  const auto f = [&](Masking masking) {
    return material::btdf_specular(l, b, facets, n1, n2, masking);
  };
  out.number_or_infinite("none", f(Masking::None));
  out.number_or_infinite("vcavity", f(Masking::VCavity));
  out.number_or_infinite("smith_separable", f(Masking::Smith));
}

void albedo(const Inputs& in, Answer& out) {
  const double mu = in["mu"], c = in["c"];
  if (in.has("k") && !in.has("n")) throw Error("missing input n (n and k go together)");
  out.number("E_one", material::white_albedo(mu, c));
  out.number("E_gold", material::specular_albedo(mu, c, 0.27, 2.95));
  out.number("E_glass", material::specular_albedo(mu, c, 1.5, 0.0));
  if (in.has("n")) out.number("E", material::specular_albedo(mu, c, in["n"], in.get("k", 0.0)));
}

void albedo_rt(const Inputs& in, Answer& out) {
  const material::InterfaceAlbedo a = material::dielectric_albedo(in["mu"], in["c"], in["n"]);
  out.number("R", a.reflected);
  out.number("T", a.transmitted);
}

void brdf_convex(const Inputs& in, Answer& out) {
  const double k_df = in["k_df"], k_rg = in["k_rg"];
  if (!(k_df + k_rg <= 1.0 + 1e-9))
    throw Error("k_df + k_rg is " + std::to_string(k_df + k_rg) + ", must be at most 1");
  std::optional<double> roughness_in_waves;
  if (in.has("sigma_over_lambda")) roughness_in_waves = in["sigma_over_lambda"];
  out.number_or_infinite(
      "f", material::brdf_convex(in.direction("l"), viewer_above(in), Facets(in["c"]), in["n"],
                                 k_df, k_rg, in["rho_d"], roughness_in_waves));
}

/// Making one is a matter of milliseconds, and queries often come as many directions of one
/// surface: the last is remembered.
const material::CoupledInterface& coupled_interface(double c, double n, double rho_b) {
  thread_local std::optional<material::CoupledInterface> last;
  thread_local std::array<double, 3> made_for{};
  if (!last || made_for != std::array{c, n, rho_b}) {
    last.emplace(c, n, rho_b);
    made_for = {c, n, rho_b};
  }
  return *last;
}

void brdf_coupled(const Inputs& in, Answer& out) {
  const Vec3d b = viewer_above(in);
  if (b.z() == 0.0) throw Error("z of b is 0, must be above 0: the albedo has no value there");
  const material::CoupledInterface& coupled = coupled_interface(in["c"], in["n"], in["rho_b"]);
  out.number_or_infinite("f", coupled.brdf(in.direction("l"), b));
  out.number("albedo_b", coupled.albedo(b.z()));
}

void coherent(const Inputs& in, Answer& out) {
  const double c = in["cos"], sigma = in["sigma"], lambda = in["lambda_"], n1 = in["n1"];
  out.number("gamma_r", material::coherent_reflection(c, sigma, lambda, n1));
  out.number("gamma_r_mean", material::coherent_reflection_mean(sigma, lambda, n1));
  out.number("gamma_t", material::coherent_transmission(c, sigma, lambda, n1, in["n2"]));
}

}  // namespace

std::vector<Kind> interface_kinds() {
  Input mu = number("mu", "cosine to the normal", between(0.0, 1.0));
  mu.range.low_open = true;
  const Input n1 = number("n1", "index of the viewer's medium", above(0.0));
  const Input n2 = number("n2", "index of the other medium", above(0.0));
  const Input dielectric = number("n", "index of the body, n2 / n1", above(0.0));
  Input waves = number("sigma_over_lambda", "rms height over wavelength; null: Gamma = 0",
                       or_infinite(at_least(0.0)));
  waves.type = Input::Type::NumberOrNull;
  waves.required = false;
  return {
      {"brdf_spec",
       "rough reflection f_s; 0 for l below the surface",
       {to_light(), to_viewer(), roughness(), index(), absorption()},
       "`none` (G = 1), `vcavity`, `smith` [1/sr]",
       brdf_spec},
      {"btdf",
       "rough refraction f_t; 0 for l above the surface",
       {to_light(), to_viewer(), roughness(), n1, n2},
       "`none`, `vcavity`, `smith_separable` [1/sr]",
       btdf},
      {"albedo",
       "directional albedo of f_s (V-cavities)",
       {mu, roughness(), optional(index()), optional(absorption())},
       "`E_one` (F = 1), `E_gold` (n = 0.27, k = 2.95), `E_glass` (n = 1.5); `E` for given `n`, "
       "`k`",
       albedo},
      {"albedo_rt",
       "directional albedos of a rough dielectric interface (V-cavities)",
       {mu, roughness(), index()},
       "`R`, `T`",
       albedo_rt},
      {"brdf_convex",
       "k_df rho_d / pi + k_rg (1 - Gamma) f_s (V-cavities)",
       {to_light(), to_viewer(), roughness(), dielectric, share("k_df", "diffuse"),
        share("k_rg", "directed, k_df + k_rg <= 1"), share("rho_d", "body reflectance"), waves},
       "`f` [1/sr]",
       brdf_convex},
      {"brdf_coupled",
       "interface over a body that gets what it lets through (V-cavities)",
       {to_light(), to_viewer(), roughness(), dielectric, share("rho_b", "body reflectance")},
       "`f` [1/sr], `albedo_b` (directional albedo at b)",
       brdf_coupled},
      {"coherent",
       "mirror and straight parts of a rough interface",
       {cosine(), number("sigma", "rms height, unit of lambda_", at_least(0.0)),
        number("lambda_", "vacuum wavelength", above(0.0)), n1, n2},
       "`gamma_r`, `gamma_r_mean` (cosine mean), `gamma_t` (0 under total reflection)",
       coherent}};
}

}  // namespace atrium::material_query
