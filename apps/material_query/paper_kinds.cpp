#include "material/paper.h"

#include "material/error.h"
#include "material_query/kinds.h"

namespace atrium::material_query {
namespace {

/// Lights of one side; those on the other side would count in the wrong term.
void add_lights(material::PaperInput& paper, const Inputs& in, std::string_view name, bool front) {
  std::size_t i = 0;
  for (const LightInput& light : in.lights(name)) {
    const double cosine = paper.normal.dot(light.l);
    if ((cosine >= 0.0) != front)
      throw Error(std::string(name) + "[" + std::to_string(i) + "].l has n.l " +
                  (front ? "below 0, must be at least 0 (else it belongs to lights_back)"
                         : "of 0 or more, must be below 0 (else it belongs to lights_front)"));
    paper.lights.push_back({light.l, light.J, light.r});
    ++i;
  }
}

void paper(const Inputs& in, Answer& out) {
  material::PaperInput p;
  p.normal = in.direction("n");
  p.viewer = in.direction("b");
  p.n21 = in["n21"];
  p.kappa2 = in.get("kappa2", 0.0);
  p.k_df = in.get("k_df", 0.0);
  p.k_rg = in.get("k_rg", 0.0);
  p.k_tp_df = in.get("k_tp_df", 0.0);
  p.k_tp_rg = in.get("k_tp_rg", 0.0);
  p.c = in.get("c", 0.0);
  p.transparent = in.flag("transparent", true);
  p.light_falloff = {in.get("c1", 0.0), in.get("c2", 0.0)};
  p.ray_falloff = p.light_falloff;
  p.J_ab1 = in.get("J_ab1", 0.0);
  p.J_ab2 = in.get("J_ab2", 0.0);
  p.J_refl = in.get("J_refl", 0.0);
  p.r_refl = in.get("r_refl", 0.0);
  p.K_refl = in.get("K_refl", 0.0);
  p.J_trans = in.get("J_trans", 0.0);
  p.r_trans = in.get("r_trans", 0.0);
  p.K_trans = in.get("K_trans", 0.0);
  add_lights(p, in, "lights_front", true);
  add_lights(p, in, "lights_back", false);
  const material::PaperTerms terms = material::paper_terms(p);
  constexpr std::string_view kNames[] = {"C1", "C2", "C3", "C4", "C5", "C6"};
  for (std::size_t i = 0; i < terms.term.size(); ++i) out.number(kNames[i], terms.term[i]);
  out.number("total", terms.total());
}

}  // namespace

std::vector<Kind> paper_kinds() {
  const auto zero = [](std::string_view name, std::string_view meaning) {
    return optional(number(name, meaning, at_least(0.0)));
  };
  return {
      {"paper",
       "the six terms of the paper, literally; what is missing is 0",
       {optional(direction("n", "normal on the viewer's side, [0, 0, 1] if missing")),
        direction("b", "to the viewer, n.b >= 0"),
        number("n21", "n2 / n1, medium 1 holds the viewer", above(0.0)),
        zero("kappa2", "index of absorption of medium 2"),
        optional(share("k_df", "diffuse reflection")),
        optional(share("k_rg", "directed reflection")),
        optional(share("k_tp_df", "diffuse transmission")),
        optional(share("k_tp_rg", "directed transmission")),
        optional(number("c", "roughness [1/rad]", or_infinite(at_least(0.0)))),
        zero("c1", "f(r) = 1/(c1 r^2 + c2), lights and rays"),
        zero("c2", "as c1"),
        zero("J_ab1", "ambient light on the viewer's side"),
        zero("J_ab2", "ambient light behind"),
        zero("J_refl", "radiance of the reflected ray"),
        zero("r_refl", "its length [m]"),
        zero("K_refl", "extinction along it [1/m]"),
        zero("J_trans", "radiance of the transmitted ray"),
        zero("r_trans", "its length [m]"),
        zero("K_trans", "extinction along it [1/m]"),
        {"lights_front", "lights with n.l >= 0", Input::Type::Lights, {}, false},
        {"lights_back", "lights with n.l < 0", Input::Type::Lights, {}, false},
        {"transparent", "true if missing; false: C4 = C5 = C6 = 0", Input::Type::Flag, {}, false}},
       "`C1` ... `C6`, `total`",
       paper}};
}

}  // namespace atrium::material_query
