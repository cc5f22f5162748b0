#include "material_study/subject.h"

#include <limits>
#include <map>
#include <mutex>

#include "material/error.h"
#include "material/optical_constants.h"
#include "material_study/lobes.h"

namespace atrium::study {

namespace {

using material::Material;

material::SampledSpectrum kappa_of(const material::OpticalConstants& c) {
  // The index of absorption k / n on the grid of both tables.
  std::vector<double> nm, value;
  for (double w = 360.0; w <= 830.0; w += 5.0) {
    nm.push_back(w);
    value.push_back(c.k.at(w) / c.n.at(w));
  }
  return material::make_sampled_spectrum(std::move(nm), std::move(value));
}

Substance from_table(const std::string& name, const char* table) {
  const material::OpticalConstants* c = material::find_optical_constants(table);
  if (c == nullptr) throw Error(name + ": no optical constants of " + table);
  return {.name = name, .n = c->n, .kappa = kappa_of(*c)};
}

// What the paper gives a plastic: most of it body, a tenth interface.
constexpr double kPlasticInterface = 0.1;

void set_weights(Material& m, const Substance& s) {
  m.n = s.n;
  m.kappa = s.kappa;
  m.k_rg = s.body ? kPlasticInterface : 1.0;
  m.k_df = s.body ? 1.0 - kPlasticInterface : 0.0;
  m.body_reflectance = s.body;
}

void set_facets(Material& m, const Roughness& r) {
  m.c = 1.0 / r.slope();
  m.sigma = r.sigma;
}

}  // namespace

const std::vector<Roughness>& roughnesses() {
  static const std::vector<Roughness> all{
      {"smooth", 20e-9, 4e-6}, {"medium", 1e-6, 20e-6}, {"rough", 3e-6, 6e-6 / 0.35}};
  return all;
}

const std::vector<Substance>& substances() {
  static const std::vector<Substance> all = [] {
    std::vector<Substance> list{from_table("gold", "Au"), from_table("copper", "Cu"),
                                from_table("aluminium", "Al")};
    list.push_back({.name = "plastic", .body = make_rgb(0.55, 0.07, 0.05)});
    list.push_back(from_table("glass", "soda-lime-glass"));
    list.back().kappa = 0.0;  // what it absorbs in the thickness of a facet
    list.back().transparent = true;
    return list;
  }();
  return all;
}

const Substance& find_substance(const std::string& name) {
  std::string known;
  for (const Substance& s : substances()) {
    if (s.name == name) return s;
    known += " " + s.name;
  }
  throw Error(name + ": unknown material (known:" + known + ")");
}

Substance grey_substance(const std::string& name, double n, double k) {
  return {.name = name, .n = n, .kappa = k / n};
}

const char* name_of(Model model) {
  switch (model) {
    case Model::Facets:
      return "facets";
    case Model::Paper:
      return "paper mode";
    case Model::Phong:
      return "Phong";
    case Model::CookTorrance:
      return "Cook-Torrance";
    case Model::He:
      return "He 1991";
    case Model::BlinnPhong:
      return "Blinn-Phong";
    case Model::Schlick:
      return "Schlick 94";
    case Model::Ggx:
      return "GGX";
    case Model::Coupled:
      return "coupled";
    case Model::Solid:
      return "solid";
    case Model::SolidPaper:
      return "solid, paper";
  }
  return "";
}

trace::Mode mode_of(Model model) {
  return model == Model::Paper || model == Model::SolidPaper ? trace::Mode::Paper
                                                             : trace::Mode::Radiometric;
}

std::vector<Model> main_models() {
  return {Model::Facets, Model::Paper, Model::Phong, Model::CookTorrance, Model::He};
}

std::vector<Model> all_models(const Substance& substance) {
  std::vector<Model> models = main_models();
  models.insert(models.end(), {Model::BlinnPhong, Model::Schlick, Model::Ggx});
  if (substance.body) models.push_back(Model::Coupled);
  return models;
}

Material make_material(const Substance& s, const Roughness& r, Model model) {
  Material m;
  m.name = s.name + ", " + name_of(model);
  set_weights(m, s);
  const double slope = r.slope();
  switch (model) {
    case Model::Facets:
      set_facets(m, r);
      break;
    case Model::Paper:
    case Model::SolidPaper:
      // The paper knows no sigma: what is meant to be a mirror has to be called smooth.
      if (r.sigma > 50e-9) m.c = 1.0 / slope;
      break;
    case Model::Phong:
      m.lobe = material::PhongModel{0.5 / (slope * slope)};
      break;
    case Model::CookTorrance:
      m.lobe = material::CookTorranceModel{slope};
      break;
    case Model::He:
      m.lobe = material::HeModel{r.sigma, r.tau};
      break;
    case Model::BlinnPhong:
      m.lobe = material::BlinnPhongModel{2.0 / (slope * slope)};
      break;
    case Model::Schlick:
      m.lobe = material::SchlickModel{fitted_schlick_r(slope), 1.0};
      break;
    case Model::Ggx:
      m.lobe = material::GgxModel{slope};
      break;
    case Model::Coupled:
      set_facets(m, r);
      m.combination = Material::Combination::Coupled;
      m.k_rg = 1.0;
      break;
    case Model::Solid:
      set_facets(m, r);
      break;
  }
  if (model == Model::Solid || model == Model::SolidPaper) {
    m.medium = Material::Medium::Solid;
    m.k_tp_rg = 1.0;
  }
  return m;
}

double fitted_schlick_r(double m) {
  static std::map<double, double> known;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (const auto it = known.find(m); it != known.end()) return it->second;

  Material facets, schlick;
  for (Material* x : {&facets, &schlick}) {
    x->k_df = 0.0;
    x->k_rg = 1.0;
    x->n = 1.0;
    x->kappa = 1e4;  // F = 1
  }
  facets.c = 1.0 / m;
  double best = 0.5, least = std::numeric_limits<double>::infinity();
  const LobeSurface reference(facets);
  for (int i = 1; i < 60; ++i) {
    // Steps of 0.25 dB about r = m^2, where the densities have equal peaks, up to 1.
    const double r = m * m * std::pow(1.0 / (m * m), i / 60.0);
    schlick.lobe = material::SchlickModel{r, 1.0};
    const double d = lobe_difference(reference, LobeSurface(schlick), 45.0).seen;
    if (d < least) least = d, best = r;
  }
  return known[m] = best;
}

}  // namespace atrium::study
