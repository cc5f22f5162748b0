
#include "material/error.h"
#include "material/fresnel.h"
#include "material_query/kinds.h"
#include "material_query/named_material.h"

namespace atrium::material_query {
namespace {

void optical_constants(const Inputs& in, Answer& out) {
  const auto& table = named_material(in.text("material"));
  const double nm = in["lambda_nm"];
  check_wavelength(table, nm);
  const double n = table.n.at(nm), k = table.k.at(nm);
  out.number("n", n);
  out.number("k", k);
  out.number("kappa", k / n);
  out.number("F0", material::fresnel(1.0, n, k).mean());
  out.text("source", table.source);
}

void fresnel_material(const Inputs& in, Answer& out) {
  const auto& table = named_material(in.text("material"));
  const double nm = in["lambda_nm"];
  check_wavelength(table, nm);
  const auto r = material::fresnel(in["cos"], table.n.at(nm), table.k.at(nm));
  out.number("Rs", r.s);
  out.number("Rp", r.p);
  out.number("F", r.mean());
}

}  // namespace

std::vector<Kind> material_kinds() {
  const Input name = {"material", "name, as `atrium material list` has it", Input::Type::Text};
  const Input lambda = number("lambda_nm", "vacuum wavelength [nm], within the table", above(0.0));
  return {{"optical_constants",
           "index of a named material",
           {name, lambda},
           "`n`, `k`, `kappa`, `F0` (reflectance at normal incidence), `source`",
           optical_constants},
          {"fresnel_material",
           "Fresnel reflectance of a named material against air",
           {name, lambda, cosine()},
           "`Rs`, `Rp`, `F`",
           fresnel_material}};
}

}  // namespace atrium::material_query
