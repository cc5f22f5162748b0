#include <numbers>

#include "material/error.h"
#include "material/microfacet.h"
#include "material/off_specular.h"
#include "material/smith.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

constexpr double kPi = std::numbers::pi;
using Facets = material::GaussianFacets<double>;

void norm(const Inputs& in, Answer& out) {
  out.number("N", material::gaussian_facets_norm(in["c"]));
}

void density(const Inputs& in, Answer& out) {
  out.number("D", Facets(in["c"]).density(in["delta"]));
}

void cdf(const Inputs& in, Answer& out) {
  out.number("cdf", material::gaussian_facets_cdf(in["c"], in["delta"]));
}

void sample_rayleigh(const Inputs& in, Answer& out) {
  const Facets facets(in["c"]);
  const double delta = facets.sample_delta(in["u"]);
  out.number("delta", delta);
  out.number("pdf", facets.pdf(delta));
}

void g_vcavity(const Inputs& in, Answer& out) {
  const double bh = in["bh"];
  out.number("G", material::g_vcavity(in["nl"], in["nb"], in["nh"], bh, bh));
}

void smith(const Inputs& in, Answer& out) {
  const material::SmithTerms s = material::smith(in["c"], in["theta_deg"] * kPi / 180.0);
  out.number_or_infinite("Lambda", s.lambda);
  out.number("G1", s.g1);
}

void off_specular(const Inputs& in, Answer& out) {
  out.number("theta_peak_deg",
             material::off_specular_peak(in["c"], in["theta_i_deg"] * kPi / 180.0) * 180.0 / kPi);
}

}  // namespace

std::vector<Kind> facet_kinds() {
  const Input delta = number("delta", "angle of the facet to the normal [rad]", between(0.0, kPi));
  Range half_open = between(0.0, 1.0);
  half_open.high_open = true;
  Range degrees = between(0.0, 90.0);
  degrees.high_open = true;
  return {
      {"norm", "N(c) of D = N exp(-c^2 delta^2)", {roughness()}, "`N`", norm},
      {"D", "facet density [1/sr]", {roughness(), delta}, "`D`", density},
      {"cdf", "share of the density D cos(delta) below delta", {roughness(), delta}, "`cdf`", cdf},
      {"sample_rayleigh",
       "facet angle by the truncated Rayleigh density",
       {roughness(), number("u", "random number", half_open)},
       "`delta` [rad], `pdf` of h [1/sr]",
       sample_rayleigh},
      {"G_vcavity",
       "geometric attenuation of V-cavities",
       {share("nl", "n.l"), share("nb", "n.b"), share("nh", "n.h"), share("bh", "b.h = l.h")},
       "`G`",
       g_vcavity},
      {"smith",
       "masking of Smith for this density",
       {roughness(), number("theta_deg", "angle to the normal", between(0.0, 90.0))},
       "`Lambda` (\"inf\" at 90), `G1`",
       smith},
      {"off_specular",
       "angle of the largest f_s in the plane of incidence (F = 1, V-cavities)",
       {roughness(), number("theta_i_deg", "angle of incidence", degrees)},
       "`theta_peak_deg`",
       off_specular}};
}

}  // namespace atrium::material_query
