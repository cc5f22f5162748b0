#include <cstdio>

#include "commands.h"
#include "common/json.h"
#include "data_sheet.h"

namespace atrium::app {

namespace {

void print_text(const std::vector<const material::OpticalConstants*>& materials) {
  std::printf("%-16s %-9s %-25s %-8s %s\n", "material", "table", "F(0), linear RGB, D65", "sRGB",
              "source");
  for (const auto* m : materials) {
    const SheetColor f0 = fresnel_color(*m, 1.0, "D65");
    std::printf("%-16s %3.0f-%-5.0f %-8.4f %-7.4f %-8.4f %-8s %s\n", m->name.c_str(),
                m->n.wavelength_nm.front(), m->n.wavelength_nm.back(), f0.rgb[0], f0.rgb[1],
                f0.rgb[2], f0.hex.c_str(), m->source.c_str());
  }
  std::printf("\n%-16s\n", "illuminant");
  for (const IlluminantName& i : illuminant_names()) std::printf("%-16s %s\n", i.name, i.meaning);
  std::printf("\nalso known as:");
  for (const auto& [name, table] : material::optical_constants_aliases())
    std::printf(" %s (%s)", name.c_str(), table.c_str());
  std::printf("\nwavelengths in nm\n");
}

void print_json(const std::vector<const material::OpticalConstants*>& materials) {
  JsonWriter json;
  json.begin_object();
  json.begin_array("materials");
  for (const auto* m : materials) {
    const SheetColor f0 = fresnel_color(*m, 1.0, "D65");
    json.begin_object();
    json.member("name", m->name);
    json.member("source", m->source);
    json.begin_array("wavelength_nm");
    json.element(m->n.wavelength_nm.front());
    json.element(m->n.wavelength_nm.back());
    json.end();
    json.begin_array("F0_rgb");
    for (const double v : f0.rgb) json.element(v);
    json.end();
    json.member("F0_srgb", f0.hex);
    json.end();
  }
  json.end();
  json.begin_array("illuminants");
  for (const IlluminantName& i : illuminant_names()) {
    json.begin_object();
    json.member("name", i.name);
    json.member("meaning", i.meaning);
    json.end();
  }
  json.end();
  json.end();
  std::fputs(json.text().c_str(), stdout);
}

}  // namespace

int run_material_list(const MaterialListCommand& c) {
  std::vector<const material::OpticalConstants*> materials;
  for (const std::string& name : material::optical_constants_names())
    materials.push_back(material::find_optical_constants(name));
  c.json ? print_json(materials) : print_text(materials);
  return 0;
}

}  // namespace atrium::app
