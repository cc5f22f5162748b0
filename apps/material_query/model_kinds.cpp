#include <numbers>

#include "material/error.h"
#include "material/models/blinn_phong.h"
#include "material/models/cook_torrance.h"
#include "material/models/ggx.h"
#include "material/models/hanrahan_krueger.h"
#include "material/models/he.h"
#include "material/models/oren_nayar.h"
#include "material/models/phong.h"
#include "material/models/schlick94.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// l, b of a query in the local frame.
struct Pair {
  Vec3d l, b;
  explicit Pair(const Inputs& in) : l(in.direction("l")), b(viewer_above(in)) {}
};

void check_shares(double kd, double ks) {
  if (!(kd + ks <= 1.0 + 1e-9))
    throw Error("kd + ks is " + std::to_string(kd + ks) + ", must be at most 1");
}

void phong(const Inputs& in, Answer& out) {
  const Pair d(in);
  const double kd = in["kd"], ks = in["ks"], p = in["p"];
  check_shares(kd, ks);
  out.number("phong_1975", material::phong_1975(d.l, d.b, kd, ks, p));
  out.number("lafortune", material::phong_lafortune(d.l, d.b, kd, ks, p));
}

void blinn_phong(const Inputs& in, Answer& out) {
  const Pair d(in);
  check_shares(in["kd"], in["ks"]);
  out.number("f", material::blinn_phong(d.l, d.b, in["kd"], in["ks"], in["p"]));
}

void cook_torrance(const Inputs& in, Answer& out) {
  const Pair d(in);
  out.number("f", material::cook_torrance(d.l, d.b, in["m"], in["n"], in["k"]));
}

void ggx(const Inputs& in, Answer& out) {
  const Pair d(in);
  out.number("f", material::ggx(d.l, d.b, in["alpha"], in["n"], in["k"]));
}

void oren_nayar(const Inputs& in, Answer& out) {
  const Pair d(in);
  out.number("qualitative", material::oren_nayar_qualitative(d.l, d.b, in["rho"], in["s"]));
  out.number("full", material::oren_nayar_full(d.l, d.b, in["rho"], in["s"]));
}

void hanrahan_krueger(const Inputs& in, Answer& out) {
  const Pair d(in);
  out.number("f", material::hanrahan_krueger(d.l, d.b, in["n"], in["W"], in["taud"], in["g"]));
}

void schlick1994(const Inputs& in, Answer& out) {
  const Pair d(in);
  const auto s = material::schlick1994(d.l, d.b, in["f0"], in["r"], in["p"]);
  out.number("f", s.f);
  out.number("dirac", s.dirac);
}

void he1991(const Inputs& in, Answer& out) {
  const Pair d(in);
  const auto h =
      material::he1991(d.l, d.b, in["sigma0"], in["tau"], in["lambda_"], in["n"], in["k"]);
  out.number("dd", h.dd);
  out.number("specular", h.specular);
  out.number("sigma_eff", h.sigma_eff);
  out.number("g", h.g);
  out.number("S", h.S);
  out.number("D", h.D);
  out.number("G", h.G);
}

void he_sum(const Inputs& in, Answer& out) { out.number("S", material::he_sum(in["g"], in["B"])); }

void he_sigma(const Inputs& in, Answer& out) {
  out.number("sigma", material::he_sigma(in["theta_i_deg"] * kDegree, in["theta_r_deg"] * kDegree,
                                         in["sigma0"], in["tau"]));
}

std::vector<Kind> he_kinds() {
  const Input sigma0 = number("sigma0", "rms height", at_least(0.0));
  const Input tau = number("tau", "correlation length, unit of sigma0", above(0.0));
  const auto degrees = [](std::string_view name) {
    return number(name, "angle to the normal", between(0.0, 90.0));
  };
  return {
      {"he1991",
       "He et al. 1991, unpolarised; lengths in one unit",
       {to_light(), to_viewer(), sigma0, tau,
        number("lambda_", "wavelength in the incident medium", above(0.0)), index(), absorption()},
       "`dd` [1/sr], `specular` (F e^-g S), `sigma_eff`, `g`, `S`, `D`, `G`",
       he1991},
      {"he_sum",
       "sum over m of g^m e^-g / (m! m) e^(-B/m)",
       {number("g", "roughness in waves, squared", between(0.0, 1e10)),
        number("B", "(v_xy tau / 2)^2", at_least(0.0))},
       "`S`",
       he_sum},
      {"he_sigma",
       "effective rms height",
       {degrees("theta_i_deg"), degrees("theta_r_deg"), sigma0, tau},
       "`sigma`",
       he_sigma}};
}

}  // namespace

std::vector<Kind> model_kinds() {
  Range phase = between(-1.0, 1.0);
  phase.low_open = phase.high_open = true;
  const std::vector<Input> phong_inputs = {to_light(), to_viewer(), share("kd", "diffuse"),
                                           share("ks", "highlight, kd + ks <= 1"),
                                           number("p", "exponent", between(0.0, 1e8))};
  const Input rho = share("rho", "reflectance of a facet");
  std::vector<Kind> kinds = {
      {"phong", "Phong 1975 (with the cosine, per source intensity) and normalised", phong_inputs,
       "`phong_1975`, `lafortune` [1/sr]", phong},
      {"blinn_phong", "normalised, with the halfway vector", phong_inputs, "`f` [1/sr]",
       blinn_phong},
      {"cook_torrance",
       "specular part, Beckmann's density, V-cavities",
       {to_light(), to_viewer(), number("m", "rms slope", between(1e-6, 100.0)), index(),
        absorption()},
       "`f` [1/sr]",
       cook_torrance},
      {"ggx",
       "specular part, GGX, Smith's G height-correlated",
       {to_light(), to_viewer(),
        number("alpha", "width, glTF roughness squared", between(1e-4, 1.0)), index(),
        absorption()},
       "`f` [1/sr]",
       ggx},
      {"oren_nayar",
       "rough diffuse",
       {to_light(), to_viewer(), rho,
        number("s", "standard deviation of the facet angle [rad]", between(0.0, 1.0))},
       "`qualitative`, `full` [1/sr]",
       oren_nayar},
      {"hanrahan_krueger",
       "single scattering in a slab",
       {to_light(), to_viewer(), index(), share("W", "albedo of one scattering"),
        number("taud", "optical depth", or_infinite(at_least(0.0))),
        number("g", "mean cosine of Henyey-Greenstein, > 0 forward", phase)},
       "`f` [1/sr]",
       hanrahan_krueger},
      {"schlick1994",
       "Schlick's rough surface; azimuth of h from x",
       {to_light(), to_viewer(), share("f0", "reflectance at normal incidence"),
        share("r", "roughness: 0 mirror, 1 Lambertian"),
        number("p", "isotropy, 1 isotropic", between(1e-4, 1.0))},
       "`f` [1/sr], `dirac` (mirror weight of the pair)",
       schlick1994}};
  for (Kind& kind : he_kinds()) kinds.push_back(std::move(kind));
  return kinds;
}

}  // namespace atrium::material_query
