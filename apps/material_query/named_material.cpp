#include "material_query/named_material.h"

#include "common/json.h"
#include "common/suggest.h"
#include "material/error.h"

namespace atrium::material_query {

const material::OpticalConstants& named_material(std::string_view name) {
  if (const material::OpticalConstants* found = material::find_optical_constants(name))
    return *found;
  std::vector<std::string> names = material::optical_constants_names();
  for (const auto& alias : material::optical_constants_aliases()) names.push_back(alias.first);
  throw Error("unknown material '" + std::string(name) + "'" +
              app::suggestion(name, {names.begin(), names.end()}));
}

void check_wavelength(const material::OpticalConstants& constants, double nm) {
  const double first = constants.n.wavelength_nm.front(), last = constants.n.wavelength_nm.back();
  if (nm >= first && nm <= last) return;
  std::string text = "wavelength is ";
  app::append_json_number(text, nm);
  text += " nm, must be in [";
  app::append_json_number(text, first);
  text += ", ";
  app::append_json_number(text, last);
  throw Error(text + "] nm: the table of " + constants.name + " ends there");
}

}  // namespace atrium::material_query
