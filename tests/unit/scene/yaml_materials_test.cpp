// Materials, spectra and what emits in scene files.
#include "material/optical_constants.h"

#include "yaml_scenes.h"

namespace atrium::scene {
namespace {

// Names of optical tables: n and kappa, and K = 4 pi k / lambda. A spectrum of the scene comes
// first.
TEST_F(YamlScenes, TablesAndIlluminantsByName) {
  const Model model = read(
      "spectra:\n"
      "  silver: 0.25\n"
      "materials:\n"
      "  bath: {ior: water, medium: solid, extinction: Water}\n"
      "  pane: {ior: window-glass, medium: pane, extinction: soda-lime-glass}\n"
      "  own: {ior: 1.5, medium: solid, extinction: silver}\n"
      "lights:\n"
      "  - {name: A, point: {position: [0, 1, 0], intensity: 10, color: A}}\n"
      "  - {name: D65, point: {position: [0, 1, 0], intensity: 10, color: D65}}\n"
      "  - {name: E, point: {position: [0, 1, 0], intensity: 10, color: E}}\n"
      "  - {name: F2, point: {position: [0, 1, 0], intensity: 10, color: F2}}\n"
      "  - {name: F11, point: {position: [0, 1, 0], intensity: 10, color: f11}}\n");
  const material::OpticalConstants& water = *material::find_optical_constants("water");
  const auto& bath = std::get<SampledSpectrum>(material_named(model, "bath").extinction);
  const auto& pane = std::get<SampledSpectrum>(material_named(model, "pane").extinction);
  for (const double nm : {450.0, 650.0}) {
    EXPECT_NEAR(bath.at(nm) * nm * 1e-9 / (4.0 * std::numbers::pi * water.k.at(nm)), 1.0, 1e-12);
    EXPECT_GT(pane.at(nm), 0.0);
  }
  EXPECT_NEAR(bath.at(650.0), 0.317, 0.0005);  // Hale & Querry 1973: k = 1.64e-8
  EXPECT_EQ(number(material_named(model, "own").extinction), 0.25);
  ASSERT_EQ(model.lights.size(), 5u);
  const material::SpectralBasis rgb = material::SpectralBasis::rgb();
  for (const Light& light : model.lights) {
    SCOPED_TRACE(light.name);
    const Rgb lanes = rgb.resolve<3>(std::get<PointLight>(light.kind).intensity);
    const SampledSpectrum& table = *material::find_illuminant(light.name);
    const Eigen::Vector3d xyz = material::xyz_of_emission(table);
    const Eigen::Vector3d colour = material::rgb_from_xyz() * (10.0 * xyz / xyz.y());
    // 380-730 nm instead of the whole table, and the white of the tables.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(lanes[c], std::max(0.0, colour[c]), 0.02);
  }
  EXPECT_NE(error("materials:\n  a: {extinction: Xx}\n").find("'Xx'"), std::string::npos);
}

// A lamp of lines finer than 5 nm keeps the ratio of their powers: 435.8 and 546.1 nm, 1 nm wide.
TEST_F(YamlScenes, LinesBetweenTheStepsCount) {
  const Model model = read(
      "lights:\n"
      "  - {name: lamp, point: {position: [0, 1, 0], intensity: 1, color: {wavelengths:"
      " [380, 435.3, 435.8, 436.3, 546.9, 547.4, 547.9, 730], values: [0, 0, 2, 0, 0, 1, 0, "
      "0]}}}\n");
  const auto& ratio =
      std::get<SampledSpectrum>(std::get<PointLight>(model.lights.at(0).kind).intensity);
  const SampledSpectrum& d65 = *material::find_illuminant("D65");
  EXPECT_NEAR((ratio.at(435.8) * d65.at(435.8)) / (ratio.at(547.4) * d65.at(547.4)), 2.0, 1e-12);
  const Eigen::Vector3d xyz = material::xyz_of_reflectance(ratio, d65);
  const auto sum = [](const SampledSpectrum& cmf) { return 2.0 * cmf.at(435.8) + cmf.at(547.4); };
  EXPECT_NEAR(xyz.y(), 1.0, 1e-12);
  EXPECT_NEAR(xyz.z(), sum(material::cie_z_bar()) / sum(material::cie_y_bar()), 1e-3);
}

TEST_F(YamlScenes, LobesOfTheLiterature) {
  const Model model = read(
      "materials:\n"
      "  smith: {ior: Au, c: 4, masking: smith, facet_interreflection: true, fresnel_error: 0}\n"
      "  phong: {ior: Au, lobe: {phong: {exponent: 50}}}\n"
      "  blinn: {ior: Au, lobe: {blinn_phong: {exponent: 70}}}\n"
      "  cook: {ior: Au, lobe: {cook_torrance: {m: 0.25}}}\n"
      "  he: {ior: Au, lobe: {he: {sigma: 1e-7, tau: 2e-6}}}\n"
      "  clay: {body: 0.5, lobe: {oren_nayar: {s: 0.4}}}\n"
      "  leaf: {body: 0.5, lobe: {hanrahan_krueger: {depth: 2, g: 0.3}}}\n"
      "  schlick: {ior: Au, lobe: {schlick: {r: 0.2, p: 0.9}}}\n"
      "  ggx: {ior: Au, lobe: {ggx: {alpha: 0.2}}}\n"
      "  plain: {like: ggx, lobe: facets}\n");
  using namespace material;
  const Material& smith = material_named(model, "smith");
  EXPECT_EQ(smith.masking, Masking::Smith);
  EXPECT_TRUE(smith.facet_interreflection);
  EXPECT_EQ(smith.fresnel_error, 0.0);
  const auto lobe = [&](const char* name) { return material_named(model, name).lobe; };
  EXPECT_EQ(std::get<PhongModel>(lobe("phong")).exponent, 50.0);
  EXPECT_EQ(std::get<BlinnPhongModel>(lobe("blinn")).exponent, 70.0);
  EXPECT_EQ(std::get<CookTorranceModel>(lobe("cook")).m, 0.25);
  EXPECT_EQ(std::get<HeModel>(lobe("he")).sigma, 1e-7);
  EXPECT_EQ(std::get<HeModel>(lobe("he")).tau, 2e-6);
  EXPECT_EQ(std::get<OrenNayarModel>(lobe("clay")).s, 0.4);
  EXPECT_EQ(std::get<HanrahanKruegerModel>(lobe("leaf")).depth, 2.0);
  EXPECT_EQ(std::get<HanrahanKruegerModel>(lobe("leaf")).g, 0.3);
  EXPECT_EQ(std::get<SchlickModel>(lobe("schlick")).r, 0.2);
  EXPECT_EQ(std::get<SchlickModel>(lobe("schlick")).p, 0.9);
  EXPECT_EQ(std::get<GgxModel>(lobe("ggx")).alpha, 0.2);
  EXPECT_TRUE(material_named(model, "plain").facets());
}

TEST_F(YamlScenes, GlassOfATableIsNoMetal) {
  const Model model = read("materials:\n  glass: {ior: BK7}\n  gold: {ior: Au}\n");
  EXPECT_EQ(material_named(model, "glass").k_df, 1.0);  // opaque: a body, as with {ior: 1.52}
  EXPECT_EQ(material_named(model, "gold").k_df, 0.0);
}

TEST_F(YamlScenes, PaneByItsDataSheet) {
  const Model model = read("materials:\n  w: {medium: pane, tau_v: 0.9183, rho_v: 0.0817}\n");
  const material::Material& pane = material_named(model, "w");
  EXPECT_NEAR(std::get<double>(pane.n), 1.52, 5e-4);
  EXPECT_NEAR(std::get<double>(pane.extinction) * pane.pane_thickness, 0.0, 1e-6);
}

TEST_F(YamlScenes, MaterialsInThePapersTerms) {
  const Model model = read(
      "materials:\n"
      "  gold: {ior: Au, c: 8}\n"
      "  body: {body: [0.1, 0.2, 0.3]}\n"
      "  plastic: {ior: 1.6, k_rg: 0.2, body: 0.4, sigma: 1e-7, tau: 2e-6}\n"
      "  water: {ior: 1.33, medium: solid, extinction: [0.3, 0.1, 0.05], k_tp_df: 0.25}\n"
      "  pane: {ior: 1.52, medium: pane, thickness: 0.006}\n"
      "  varnish: {combination: coupled, ior: 1.5, body: 0.3, c: smooth}\n"
      "  sheet: {k_tp_df: 1, body: 0.4, body_transmission: 0.3}\n"
      "  metal: {ior: {n: 0.2, k: 3}}\n"
      "  darker: {like: plastic, body: 0.1}\n"
      "  fog: {ray_falloff: [0.1, 1]}\n");
  const material::Material& gold = material_named(model, "gold");
  const material::OpticalConstants& table = *material::find_optical_constants("Au");
  for (const double nm : {450.0, 550.0, 650.0}) {  // kappa = k / n
    EXPECT_NEAR(std::get<SampledSpectrum>(gold.kappa).at(nm), table.k.at(nm) / table.n.at(nm),
                0.05);
    EXPECT_NEAR(std::get<SampledSpectrum>(gold.n).at(nm), table.n.at(nm), 1e-9);
  }
  EXPECT_EQ(gold.k_rg, 1.0);
  EXPECT_EQ(gold.k_df, 0.0);
  EXPECT_EQ(gold.c, 8.0);
  const material::Material& body = material_named(model, "body");
  EXPECT_EQ(body.k_df, 1.0);
  EXPECT_EQ(body.k_rg, 0.0);
  EXPECT_EQ(std::get<Rgb>(*body.body_reflectance), make_rgb(0.1, 0.2, 0.3));
  const material::Material& plastic = material_named(model, "plastic");
  EXPECT_DOUBLE_EQ(plastic.k_df, 0.8);
  EXPECT_DOUBLE_EQ(plastic.c, 10.0);  // tau / (2 sigma)
  EXPECT_EQ(plastic.sigma, 1e-7);
  const material::Material& water = material_named(model, "water");
  EXPECT_EQ(water.medium, material::Material::Medium::Solid);
  EXPECT_EQ(water.k_rg, 1.0);
  EXPECT_EQ(water.k_tp_rg, 0.75);
  EXPECT_EQ(std::get<Rgb>(water.extinction), make_rgb(0.3, 0.1, 0.05));
  const material::Material& pane = material_named(model, "pane");
  EXPECT_EQ(pane.medium, material::Material::Medium::Pane);
  EXPECT_EQ(pane.pane_thickness, 0.006);
  EXPECT_EQ(pane.k_tp_rg, 1.0);
  const material::Material& varnish = material_named(model, "varnish");
  EXPECT_EQ(varnish.combination, material::Material::Combination::Coupled);
  EXPECT_EQ(varnish.k_df, 1.0);
  EXPECT_EQ(varnish.k_rg, 1.0);
  EXPECT_TRUE(varnish.smooth());
  const material::Material& sheet = material_named(model, "sheet");
  EXPECT_EQ(sheet.k_tp_df, 1.0);
  EXPECT_EQ(sheet.k_tp_rg, 0.0);
  EXPECT_DOUBLE_EQ(number(material_named(model, "metal").kappa), 15.0);
  const material::Material& darker = material_named(model, "darker");
  EXPECT_DOUBLE_EQ(darker.k_rg, 0.2);
  EXPECT_EQ(number(darker.n), 1.6);
  EXPECT_EQ(number(*darker.body_reflectance), 0.1);
  EXPECT_EQ(material_named(model, "fog").ray_c1, 0.1);
}

TEST_F(YamlScenes, SpectraByNameRgbAndHex) {
  const Model model = read(
      "spectra:\n"
      "  ramp: {wavelengths: {from: 400, step: 100}, values: [0.1, 0.2, 0.3, 0.4]}\n"
      "materials:\n  a: {body: ramp}\n  b: {body: \"#ffffff\"}\n  c: {body: \"#808080\"}\n");
  EXPECT_NEAR(std::get<SampledSpectrum>(*material_named(model, "a").body_reflectance).at(550.0),
              0.25, 1e-12);
  EXPECT_NEAR(std::get<Rgb>(*material_named(model, "b").body_reflectance)[1], 1.0f, 1e-6f);
  // sRGB 128/255 is 0.2159 linear (IEC 61966-2-1).
  EXPECT_NEAR(std::get<Rgb>(*material_named(model, "c").body_reflectance)[0], 0.2159f, 1e-4f);
}

// A Lambertian surface of area A and radiance L emits pi L A per side.
TEST_F(YamlScenes, PowerIsSharedOverTheArea) {
  const Model model = read(
      "materials:\n"
      "  one: {body: 0, emission: {power: 100}}\n"
      "  two: {body: 0, emission: {power: 100, both_sides: true, color: [1, 0.5, 0.2]}}\n"
      "objects:\n"
      "  - {material: one, polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], scale: 2,\n"
      "     repeat: {count: 3, step: [5, 0, 0]}}\n"
      "  - {material: two, polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}\n"
      "lights:\n"
      "  - {name: r, rectangle: {center: [0, 2, 0], size: [2, 0.5], power: 300}}\n");
  EXPECT_NEAR(number(material_named(model, "one").emission), 100.0 / (kPi * 12.0), 1e-12);
  EXPECT_NEAR(luminance_of(material_named(model, "two").emission), 100.0 / (2.0 * kPi), 1e-5);
  EXPECT_NEAR(number(material_named(model, "r").emission), 300.0 / kPi, 1e-12);
}

TEST_F(YamlScenes, ColoursOfLightsHaveLuminanceOne) {
  const Model model = read(
      "spectra:\n  lamp: {wavelengths: [400, 500, 600, 700], values: [0, 8, 15.6, 18.4]}\n"
      "materials:\n"
      "  a: {emission: {radiance: 1000, color: [0.2, 0.9, 0.1]}}\n"
      "  b: {emission: {radiance: 1000, color: lamp}}\n"
      "  c: {emission: {radiance: 1000, color: {temperature: 2700}}}\n"
      "  d: {emission: {radiance: 1000, color: D65}}\n"
      "  e: {emission: [10, 20, 30]}\n");
  for (const char* name : {"a", "b", "c", "d"}) {
    EXPECT_NEAR(luminance_of(material_named(model, name).emission), 1000.0, 1e-3) << name;
  }
  const auto& white = std::get<SampledSpectrum>(material_named(model, "d").emission);
  EXPECT_NEAR(white.at(450.0), white.at(650.0), 1e-6) << "D65 is the white that lanes count";
  const auto& warm = std::get<SampledSpectrum>(material_named(model, "c").emission);
  EXPECT_GT(warm.at(650.0), 4.0 * warm.at(450.0));
  EXPECT_EQ(std::get<Rgb>(material_named(model, "e").emission), make_rgb(10, 20, 30));
}

// An image that nothing shows is not read; `like` hands it on.
TEST_F(YamlScenes, ImagesOfMaterialsThatNothingUsesAreNotRead) {
  write("broken.png", "no image");
  const std::string materials =
      "materials:\n  plain: {body: 0.5}\n  painted: {body_texture: broken.png}\n";
  const std::string more = "  painted_too: {like: painted}\n";
  const auto floor = [](const std::string& material) {
    return "objects:\n  - {material: " + material +
           ", polygon: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n";
  };
  EXPECT_TRUE(read(materials + floor("plain")).textures.empty());
  for (const std::string& text : {materials + floor("painted"), materials + more + floor("plain")})
    EXPECT_NE(error(text).find("broken.png"), std::string::npos);
  EXPECT_NE(error("materials:\n  painted: {body_texture: none.png}\n" + floor("plain")), "");
}

}  // namespace
}  // namespace atrium::scene
