#include "material/fresnel.h"

#include "material/error.h"
#include "material/fresnel_forms.h"
#include "material/pane.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

constexpr std::string_view kTerms = "`Rs`, `Rp`, `F` = (Rs + Rp) / 2";

void answer_terms(const material::FresnelTerms<double>& r, Answer& out) {
  out.number("Rs", r.s);
  out.number("Rp", r.p);
  out.number("F", r.mean());
}

void dielectric(const Inputs& in, Answer& out) {
  answer_terms(material::fresnel_dielectric(in["cos"], in["n"]), out);
}

void conductor(const Inputs& in, Answer& out) {
  if (in.has("k") == in.has("kappa"))
    throw Error(in.has("k") ? "k and kappa are both given, must be one of them (k = n kappa)"
                            : "missing input k or kappa (k = n kappa, at least 0 and finite)");
  const double n = in["n"];
  answer_terms(material::fresnel(in["cos"], n, in.has("k") ? in["k"] : n * in["kappa"]), out);
}

/// Given together or not at all.
bool has_all(const Inputs& in, const std::vector<std::string_view>& names) {
  std::string_view missing;
  std::size_t there = 0;
  for (const std::string_view name : names) {
    if (in.has(name))
      ++there;
    else
      missing = name;
  }
  if (there > 0 && there < names.size()) {
    std::string all;
    for (const std::string_view name : names) all += " " + std::string(name);
    throw Error("missing input " + std::string(missing) + " (these go together:" + all + ")");
  }
  return there > 0;
}

void approximations(const Inputs& in, Answer& out) {
  const bool forms = has_all(in, {"cos", "n", "k"});
  const bool inverse = has_all(in, {"r", "g"});
  if (!forms && !inverse) throw Error("missing input cos, n, k, or r, g");
  if (forms) {
    const double c = in["cos"], n = in["n"], k = in["k"];
    out.number("schlick", material::fresnel_schlick(c, n, k));
    out.number("drude0", material::fresnel_drude0(c, n, k));
    out.number("series1", material::fresnel_series1(c, n, k));
    out.number("f82", material::fresnel_f82(c, n, k));
  }
  if (inverse) {
    const auto index = material::gulbrandsen_index(in["r"], in["g"]);
    out.number("n", index.n);
    out.number("k", index.k);
  }
}

void mean(const Inputs& in, Answer& out) {
  out.number("F_mean", material::fresnel_mean(in["n"], in["k"]));
}

void radiance_smooth(const Inputs& in, Answer& out) {
  const double ratio = in["n1"] / in["n2"];
  const double F = material::fresnel_dielectric(in["cos"], in["n2"] / in["n1"]).mean();
  out.number("L1", (1.0 - F) * ratio * ratio * in["L2"] * std::exp(-in["K2"] * in["r"]));
}

Input absolute(std::string_view name, std::string_view meaning) {
  return number(name, meaning, above(0.0));
}

}  // namespace

std::vector<Kind> fresnel_kinds() {
  const Input kappa = number("kappa", "index of absorption k / n", at_least(0.0));
  Range below_one = between(0.0, 1.0);
  below_one.high_open = true;
  return {
      {"fresnel_dielectric",
       "Fresnel reflectance without absorption",
       {cosine(), index()},
       kTerms,
       dielectric},
      {"fresnel_conductor",
       "Fresnel reflectance; `k` or `kappa`",
       {cosine(), index(), optional(absorption()), optional(kappa)},
       kTerms,
       conductor},
      {"fresnel_approx",
       "fast forms; or Gulbrandsen's inverse of `r` and `g`",
       {optional(cosine()), optional(index()), optional(absorption()),
        optional(number("r", "reflectance at normal incidence", below_one)),
        optional(share("g", "edge tint"))},
       "`schlick`, `drude0` (order 0), `series1` (order 1), `f82` (corrected Schlick); `n`, `k` "
       "for `r`, `g`",
       approximations},
      {"fresnel_mean",
       "cosine mean of F over the hemisphere",
       {index(), absorption()},
       "`F_mean`",
       mean},
      {"radiance_smooth",
       "radiance that leaves medium 2 through a smooth face",
       {number("cos", "cosine in medium 1", between(0.0, 1.0)), absolute("n1", "index of medium 1"),
        absolute("n2", "index of medium 2"), number("L2", "radiance in medium 2", at_least(0.0)),
        number("K2", "extinction of medium 2 [1/m]", at_least(0.0)),
        number("r", "path in medium 2 [m]", at_least(0.0))},
       "`L1` = (1 - F) (n1/n2)^2 L2 exp(-K2 r)",
       radiance_smooth}};
}

}  // namespace atrium::material_query
