#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "import_util.h"
#include "material/error.h"
#include "material/pane.h"
#include "scene/image_io.h"
#include "yaml_scene.h"

namespace atrium::scene {
namespace {

using material::Material;
using material::TextureSlot;

constexpr double kUnlimited = std::numeric_limits<double>::max();

TextureSlot read_slot(YamlScene& scene, const YamlView& view, bool srgb) {
  TextureSlot slot;
  if (!view.is_map()) {
    slot.texture = read_texture_file(scene, view, srgb);
    return slot;
  }
  const YamlMap map = view.map("a texture", {"file", "scale", "offset", "rotate", "channel"});
  slot.texture = read_texture_file(scene, map.get("file"), srgb);
  if (const auto scale = map.find("scale")) {
    const double both = scale->is_number() ? scale->number() : 0.0;
    const std::vector<double> s =
        scale->is_number() ? std::vector<double>{both, both} : scale->numbers(2);
    slot.scale = Vec2d(s[0], s[1]).cast<float>();
  }
  if (const auto offset = map.find("offset")) {
    const std::vector<double> o = offset->numbers(2);
    slot.offset = Vec2d(o[0], o[1]).cast<float>();
  }
  if (const auto rotate = map.find("rotate")) {
    slot.rotation = static_cast<float>(rotate->number() * std::numbers::pi / 180.0);
  }
  if (const auto channel = map.find("channel")) {
    if (srgb) channel->fail("a colour texture has no channel to choose");
    slot.channel = channel->integer(0, 3);
  }
  return slot;
}

// A pair of weights with sum 1: the missing one is the rest.
void read_pair(const YamlMap& map, std::string_view first, std::string_view second, bool sum_is_one,
               double& a, double& b) {
  const auto va = map.find(first);
  const auto vb = map.find(second);
  if (va) a = va->number(0.0, 1.0);
  if (vb) b = vb->number(0.0, 1.0);
  if (!sum_is_one) return;
  if (va && !vb) b = 1.0 - a;
  if (vb && !va) a = 1.0 - b;
  constexpr double rounding = 1e-6;
  if (va && vb && std::abs(a + b - 1.0) > rounding) {
    vb->fail(std::string(first) + " + " + std::string(second) + " must be 1 (combination: convex)");
  }
}

// Defaults follow from what the material is: a metal, a solid or a pane has a mirror's interface
// and no body; anything else is a diffuse body. Under `coupled` both are there in full.
void read_weights(const YamlMap& map, bool derived, Material& m) {
  const bool coupled = m.combination == Material::Combination::Coupled;
  const bool opaque = m.medium == Material::Medium::Opaque;
  if (!derived || map.has("medium") || map.has("combination") || map.has("ior")) {
    // The tables give glasses a kappa of 1e-6: clear all the same, no metal.
    constexpr double kClear = 1e-3;
    const bool interface_only = !opaque || material::max_value(m.kappa) > kClear;
    m.k_df = coupled || !interface_only ? 1.0 : 0.0;
    m.k_rg = coupled || interface_only ? 1.0 : 0.0;
    m.k_tp_df = 0.0;
    m.k_tp_rg = opaque ? 0.0 : 1.0;
  }
  read_pair(map, "k_df", "k_rg", !coupled, m.k_df, m.k_rg);
  if (opaque) {
    if (const auto rough = map.find("k_tp_rg"); rough && rough->number(0.0, 1.0) > 0.0) {
      rough->fail("directed transmission needs medium: solid or pane");
    }
    if (const auto diffuse = map.find("k_tp_df")) m.k_tp_df = diffuse->number(0.0, 1.0);
  } else {
    read_pair(map, "k_tp_df", "k_tp_rg", !coupled, m.k_tp_df, m.k_tp_rg);
  }
}

void read_roughness(const YamlMap& map, Material& m) {
  const auto c = map.find("c");
  const auto tau = map.find("tau");
  const auto sigma = map.find("sigma");
  if (c) {
    if (tau) tau->fail("give c, or tau with sigma");
    const bool smooth = !c->is_number() && c->choice({"smooth"}) == 0;
    m.c = smooth ? std::numeric_limits<double>::infinity() : c->number(0.0);
    m.sigma.reset();
  }
  if (sigma) m.sigma = sigma->number(0.0);
  if (!tau) return;
  if (!sigma) tau->fail("tau needs sigma: c = tau / (2 sigma)");
  // [Beckmann 1963]: the rms slope of a Gaussian surface is 2 sigma / tau = 1 / c.
  const double height = *m.sigma;
  const double length = tau->positive();
  m.c = height > 0.0 ? length / (2.0 * height) : std::numeric_limits<double>::infinity();
}

// lobe: facets | {model: {parameters}}, the models of the literature beside the paper's.
material::LobeModel read_lobe(const YamlView& view) {
  using namespace material;
  if (!view.is_map()) {
    if (view.choice({"facets"}) == 0) return FacetModel{};
  }
  const YamlMap map = view.map("lobe", {"phong", "blinn_phong", "cook_torrance", "he", "oren_nayar",
                                        "hanrahan_krueger", "schlick", "ggx"});
  const std::string model = map.one_of({"phong", "blinn_phong", "cook_torrance", "he", "oren_nayar",
                                        "hanrahan_krueger", "schlick", "ggx"});
  const YamlView given = map.get(model);
  const auto parameters = [&](std::initializer_list<std::string_view> keys) {
    return given.map(model, keys);
  };
  const auto set = [](const YamlMap& m, const char* key, double& value) {
    if (const auto v = m.find(key)) value = v->number();
  };
  if (model == "phong" || model == "blinn_phong") {
    double exponent = PhongModel{}.exponent;
    set(parameters({"exponent"}), "exponent", exponent);
    if (model == "phong") return PhongModel{exponent};
    return BlinnPhongModel{exponent};
  }
  if (model == "cook_torrance") {
    CookTorranceModel lobe;
    set(parameters({"m"}), "m", lobe.m);
    return lobe;
  }
  if (model == "he") {
    HeModel lobe;
    const YamlMap p = parameters({"sigma", "tau"});
    lobe.sigma = p.get("sigma").number();
    lobe.tau = p.get("tau").number();
    return lobe;
  }
  if (model == "oren_nayar") {
    OrenNayarModel lobe;
    set(parameters({"s"}), "s", lobe.s);
    return lobe;
  }
  if (model == "hanrahan_krueger") {
    HanrahanKruegerModel lobe;
    const YamlMap p = parameters({"depth", "g"});
    set(p, "depth", lobe.depth);
    set(p, "g", lobe.g);
    return lobe;
  }
  if (model == "schlick") {
    SchlickModel lobe;
    const YamlMap p = parameters({"r", "p"});
    set(p, "r", lobe.r);
    set(p, "p", lobe.p);
    return lobe;
  }
  GgxModel lobe;
  set(parameters({"alpha"}), "alpha", lobe.alpha);
  return lobe;
}

void read_facets(const YamlMap& map, Material& m) {
  if (const auto v = map.find("masking")) {
    m.masking = v->choice({"vcavity", "smith"}) == 0 ? material::Masking::VCavity
                                                     : material::Masking::Smith;
  }
  if (const auto v = map.find("facet_interreflection")) m.facet_interreflection = v->boolean();
  if (const auto v = map.find("fresnel_error")) m.fresnel_error = v->number(0.0, 1.0);
  if (const auto v = map.find("lobe")) m.lobe = read_lobe(*v);
}

void read_emission(YamlScene& scene, const YamlView& view, MaterialId id, Material& m) {
  m.emission_spectral_watts = false;
  if (!view.is_map()) {
    m.emission = read_spectral(scene, view, 0.0, kUnlimited);
    return;
  }
  const YamlMap map = view.map(
      "emission", {"radiance", "power", "spectral_radiance", "color", "both_sides", "texture"});
  if (const auto both = map.find("both_sides")) m.emits_both_sides = both->boolean();
  if (const auto texture = map.find("texture")) {
    m.emission_texture = read_slot(scene, *texture, true);
  }
  const std::string given = map.one_of({"radiance", "power", "spectral_radiance"});
  const YamlView value = map.get(given);
  if (given == "radiance") {
    m.emission = read_emitted(scene, map, given);
  } else if (given == "power") {
    if (map.has("texture")) value.fail("power cannot be shared out over a texture: give radiance");
    const auto color = map.find("color");
    scene.powers.push_back({id, value.number(0.0),
                            color ? read_light_color(scene, *color) : material::SpectralValue(1.0),
                            value.place()});
    m.emission = 0.0;
  } else {
    if (scene.unit != RadianceUnit::Nit) value.fail("spectral_radiance needs unit: nit");
    if (map.has("color")) value.fail("spectral_radiance has its colour already");
    m.emission = read_spectral(scene, value, 0.0, kUnlimited);
    m.emission_spectral_watts = true;
  }
}

void read_alpha(YamlScene& scene, const YamlView& view, Material& m) {
  const YamlMap map = view.map("alpha", {"texture", "cutoff"});
  m.alpha_texture = read_slot(scene, map.get("texture"), true);
  m.alpha_texture.channel = 3;
  m.alpha_cutoff = 0.5f;
  if (const auto cutoff = map.find("cutoff")) {
    m.alpha_cutoff = static_cast<float>(cutoff->number(0.0, 1.0));
  }
}

void read_textures(YamlScene& scene, const YamlMap& map, Material& m) {
  if (const auto v = map.find("body_texture")) m.body_texture = read_slot(scene, *v, true);
  if (const auto v = map.find("reflectance_texture")) {
    m.reflectance_texture = read_slot(scene, *v, true);
  }
  if (const auto v = map.find("roughness_texture")) {
    m.roughness_texture = read_slot(scene, *v, false);
  }
  if (const auto v = map.find("normal_texture")) m.normal_texture = read_slot(scene, *v, false);
  if (const auto v = map.find("normal_scale")) m.normal_scale = static_cast<float>(v->number());
  if (const auto v = map.find("alpha")) read_alpha(scene, *v, m);
}

// A pane by the values of its data sheet, at normal incidence.
void read_data_sheet(const YamlMap& map, Material& m) {
  const auto tau = map.find("tau_v");
  const auto rho = map.find("rho_v");
  if (!tau && !rho) return;
  const YamlView& given = tau ? *tau : *rho;
  if (m.medium != Material::Medium::Pane) given.fail("tau_v and rho_v belong to medium: pane");
  if (!tau || !rho) given.fail("tau_v and rho_v go together");
  for (const char* other : {"ior", "extinction"})
    if (map.has(other)) given.fail(std::string(other) + " follows from tau_v and rho_v");
  try {
    const material::PaneParameters pane = material::pane_from_visible(tau->number(), rho->number());
    m.n = pane.n;
    m.kappa = 0.0;
    m.extinction = pane.kd / m.pane_thickness;
  } catch (const std::invalid_argument& e) {
    given.fail(e.what());
  }
}

void read_body(const YamlScene& scene, const YamlMap& map, Material& m) {
  const auto color = [&](std::string_view key, double high) {
    return read_spectral(scene, map.get(key), 0.0, high);
  };
  if (map.has("body")) m.body_reflectance = color("body", 1.0);
  if (map.has("body_transmission")) m.body_transmittance = color("body_transmission", 1.0);
  if (map.has("tint")) m.transmission_tint = color("tint", 1.0);
  if (const auto v = map.find("extinction")) m.extinction = read_extinction(scene, *v);
  if (const auto v = map.find("thickness")) m.pane_thickness = v->positive();
  read_data_sheet(map, m);
  if (const auto v = map.find("one_sided")) m.one_sided = v->boolean();
  if (const auto v = map.find("ray_falloff")) {
    const std::vector<double> c = v->numbers(2);
    if (!(c[0] >= 0.0 && c[1] >= 0.0 && c[0] + c[1] > 0.0)) {
      v->fail("f(r) = 1 / (c1 r^2 + c2) needs c1, c2 >= 0, not both 0");
    }
    m.ray_c1 = c[0];
    m.ray_c2 = c[1];
  }
}

void read_material(YamlScene& scene, const std::string& name, const YamlView& view) {
  const YamlMap map = view.map("material '" + name + "'", {"like",
                                                           "medium",
                                                           "combination",
                                                           "ior",
                                                           "c",
                                                           "sigma",
                                                           "tau",
                                                           "masking",
                                                           "facet_interreflection",
                                                           "fresnel_error",
                                                           "lobe",
                                                           "k_df",
                                                           "k_rg",
                                                           "k_tp_df",
                                                           "k_tp_rg",
                                                           "body",
                                                           "body_transmission",
                                                           "tint",
                                                           "extinction",
                                                           "thickness",
                                                           "tau_v",
                                                           "rho_v",
                                                           "emission",
                                                           "body_texture",
                                                           "reflectance_texture",
                                                           "roughness_texture",
                                                           "normal_texture",
                                                           "normal_scale",
                                                           "alpha",
                                                           "one_sided",
                                                           "ray_falloff"});
  Material m;
  const auto like = map.find("like");
  if (like) {
    const MaterialId base = find_material(scene, *like);
    for (const PowerEmission& power : scene.powers) {
      if (power.material == base && !map.has("emission")) {
        like->fail("emission given as power belongs to one material: give this one its own");
      }
    }
    m = scene.model.materials[base.value];
  }
  m.name = name;
  if (const auto v = map.find("medium")) {
    m.medium = static_cast<Material::Medium>(v->choice({"opaque", "solid", "pane"}));
  }
  if (const auto v = map.find("combination")) {
    m.combination = static_cast<Material::Combination>(v->choice({"convex", "coupled"}));
  }
  if (const auto v = map.find("ior")) read_refraction(scene, *v, m);
  read_weights(map, like.has_value(), m);
  read_roughness(map, m);
  read_facets(map, m);
  read_body(scene, map, m);
  const MaterialId id(scene.model.materials.size());
  if (const auto v = map.find("emission")) read_emission(scene, *v, id, m);
  read_textures(scene, map, m);
  material::validate(m, view.place() + ": material '" + name + "'");
  scene.model.materials.push_back(std::move(m));
  scene.materials[name] = id;
}

double area_of(const MeshData& mesh, const Eigen::Affine3d& to_world) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]];
    const Vec3d u = to_world.linear() * (mesh.positions[t[1]] - a);
    const Vec3d v = to_world.linear() * (mesh.positions[t[2]] - a);
    area += 0.5 * u.cross(v).norm();
  }
  return area;
}

}  // namespace

material::TextureId read_texture_file(YamlScene& scene, const YamlView& view, bool srgb) {
  const std::filesystem::path file = view.file();
  if (!scene.images) return {};
  const std::string key = (srgb ? "c:" : "d:") + file.string();
  if (const auto known = scene.textures.find(key); known != scene.textures.end()) {
    return known->second;
  }
  material::TextureId id;
  id.value = static_cast<std::uint32_t>(scene.model.textures.size());
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  scene.budget.need_texture(texture_bytes(bytes, file.string()),
                            view.place() + ": " + file.string());
  scene.model.textures.push_back(decode_texture(bytes, file.string()));
  scene.model.textures.back().srgb = srgb;
  scene.textures[key] = id;
  return id;
}

MaterialId find_material(const YamlScene& scene, const YamlView& name) {
  const std::string text = name.text();
  const auto found = scene.materials.find(text);
  if (found != scene.materials.end()) return found->second;
  std::string names;
  for (const auto& [known, id] : scene.materials) names += (names.empty() ? "" : ", ") + known;
  name.fail("no material '" + text + "'; there are: " + (names.empty() ? "none" : names));
}

void read_materials(YamlScene& scene, const YamlView& view, const std::set<std::string>& used) {
  for (const auto& [name, value] : view.named()) {
    scene.images = used.contains(name);
    read_material(scene, name, value);
  }
  scene.images = true;
}

void resolve_powers(YamlScene& scene, std::size_t first_node) {
  if (scene.powers.empty()) return;
  struct Area {
    double sum = 0.0;
    bool cage = false;  // has no area yet
  };
  std::map<std::uint32_t, Area> areas;  // by material
  for (const PowerEmission& power : scene.powers) areas[power.material.value] = {};
  for (std::size_t i = first_node; i < scene.model.nodes.size(); ++i) {
    const Model::Node& node = scene.model.nodes[i];
    const auto area = areas.find(node.material.value);
    if (area == areas.end()) continue;
    const MeshData& mesh = scene.model.meshes[node.mesh.value];
    if (mesh.cage) area->second.cage = true;
    area->second.sum += area_of(mesh, node.to_world);
  }
  for (const PowerEmission& power : scene.powers) {
    Material& m = scene.model.materials[power.material.value];
    const auto [area, cage] = areas[power.material.value];
    if (cage) throw Error(power.place + ": a subdivision surface needs radiance, not power");
    if (!(area > 0.0)) throw Error(power.place + ": no surface has material '" + m.name + "'");
    // A Lambertian emitter of radiance L sends out pi L per area and side.
    const double sides = m.emits_both_sides ? 2.0 : 1.0;
    m.emission = scaled(power.color, power.power / (std::numbers::pi * area * sides));
  }
}

}  // namespace atrium::scene
