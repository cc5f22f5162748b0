#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "material/cie.h"
#include "material/error.h"
#include "material/optical_constants.h"
#include "scene/ray_query.h"
#include "scene/scene_io.h"

namespace atrium::scene {
namespace {

constexpr double kPi = std::numbers::pi;
using material::SampledSpectrum;

// A scene file in a folder of its own, gone with the test.
class YamlScenes : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("atrium_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] Model read(const std::string& text) const {
    write("scene.yaml", "atrium: 1\n" + text);
    Model model;
    read_yaml(model, folder_ / "scene.yaml", {});
    return model;
  }
  /// The message of the Error that reading ends with, without the folder.
  [[nodiscard]] std::string error(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& e) {
      std::string message = e.what();
      const std::string prefix = folder_.string() + "/";
      if (message.starts_with(prefix)) message.erase(0, prefix.size());
      EXPECT_EQ(message.find('\n'), std::string::npos) << "one line only";
      return message;
    }
    return "";
  }

  std::filesystem::path folder_;
};

const material::Material& material_named(const Model& model, const std::string& name) {
  for (const material::Material& m : model.materials)
    if (m.name == name) return m;
  throw std::runtime_error("no material " + name);
}

double number(const material::SpectralValue& value) { return std::get<double>(value); }

double luminance_of(const material::SpectralValue& value) {
  if (std::holds_alternative<double>(value)) return number(value);
  if (std::holds_alternative<Rgb>(value)) {
    return static_cast<double>(luminance(std::get<Rgb>(value)));
  }
  return material::xyz_of_reflectance(std::get<SampledSpectrum>(value),
                                      *material::find_illuminant("D65"))
      .y();
}

double area_of(const MeshData& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[t[0]];
    area += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  return area;
}

double volume_of(const MeshData& mesh) {
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
  }
  return volume;
}

// Directed edges of polygons without their opposite, after merging positions to 1e-9.
std::size_t open_edges(const MeshData& mesh) {
  using Point = std::tuple<long, long, long>;
  std::map<std::pair<Point, Point>, int> count;
  const auto edge = [&](std::uint32_t i, std::uint32_t j) {
    const auto key = [&](std::uint32_t k) {
      const Vec3d p = mesh.positions[k] * 1e9;
      return Point(std::lround(p.x()), std::lround(p.y()), std::lround(p.z()));
    };
    ++count[{key(i), key(j)}];
    --count[{key(j), key(i)}];
  };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edge(t[i], t[(i + 1) % 3]);
  if (mesh.cage) {
    std::size_t begin = 0;
    for (const std::uint32_t n : mesh.cage->face_sizes) {
      for (std::uint32_t i = 0; i < n; ++i) {
        edge(mesh.cage->face_indices[begin + i], mesh.cage->face_indices[begin + (i + 1) % n]);
      }
      begin += n;
    }
  }
  std::size_t open = 0;
  for (const auto& [e, n] : count) open += n > 0 ? static_cast<std::size_t>(n) : 0;
  return open;
}

// ---- errors ----

TEST_F(YamlScenes, UnknownKeysListTheKnownOnes) {
  const std::string message = error("materials:\n  wall: {bodyy: 0.5}\n");
  EXPECT_TRUE(message.starts_with("scene.yaml:3:10: unknown key 'bodyy' in material 'wall'"))
      << message;
  EXPECT_NE(message.find("known keys: like, medium"), std::string::npos) << message;
  EXPECT_NE(error("colour: 1\n").find("scene.yaml:2:1: unknown key 'colour' in scene"),
            std::string::npos);
  EXPECT_NE(error("lights:\n  - point: {position: [0, 0, 0], intensity: 1, watts: 2}\n")
                .find("unknown key 'watts' in point"),
            std::string::npos);
}

struct Bad {
  const char* name;
  const char* text;
  const char* message;
};
class BadScenes : public YamlScenes, public testing::WithParamInterface<Bad> {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / (std::string("atrium_bad_") + GetParam().name);
    std::filesystem::create_directories(folder_);
  }
};
TEST_P(BadScenes, AreRefused) {
  const std::string message = error(GetParam().text);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_TRUE(message.starts_with("scene.yaml:")) << message;
}
INSTANTIATE_TEST_SUITE_P(
    Yaml, BadScenes,
    testing::Values(
        Bad{"nan", "materials:\n  a: {body: .nan}\n", ":3:13: "},
        Bad{"inf", "materials:\n  a: {extinction: .inf}\n", "'.inf' is no number"},
        Bad{"huge", "lights:\n  - point: {position: [0, 0, 1e999], intensity: 1}\n",
            ":3:30: expected a finite number"},
        Bad{"hex", "lights:\n  - point: {position: [0, 0, 0x10], intensity: 1}\n",
            "expected a finite number"},
        Bad{"reflectance", "materials:\n  a: {body: 1.5}\n", "within 0 and 1"},
        Bad{"rgb_range", "materials:\n  a: {body: [0.1, -0.2, 0.3]}\n", "out of range"},
        Bad{"negative_light", "lights:\n  - point: {position: [0, 0, 0], intensity: -1}\n",
            "must be 0 or more"},
        Bad{"weights", "materials:\n  a: {k_df: 0.5, k_rg: 0.7}\n", "k_df + k_rg must be 1"},
        Bad{"metal", "materials:\n  a: {ior: Xx}\n", "no optical constants for 'Xx'; known:"},
        Bad{"no_material", "objects:\n  - box: {size: [1, 1, 1]}\n", "object needs 'material'"},
        Bad{"two_kinds",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, box: {size: [1, 1, 1]}, "
            "sphere: {radius: 1}}\n",
            "object takes only one of"},
        Bad{"unknown_material", "objects:\n  - {box: {size: [1, 1, 1]}, material: b}\n",
            "no material 'b'; there are: none"},
        Bad{"absolute", "objects:\n  - {file: /etc/hostname}\n", "must lie beside the scene"},
        Bad{"climbing", "objects:\n  - {file: a/../../b.glb}\n", "must lie beside the scene"},
        Bad{"missing", "objects:\n  - {file: b.glb}\n", "no file 'b.glb'"},
        Bad{"itself", "objects:\n  - {file: scene.yaml}\n", "cannot hold another scene"},
        Bad{"twice", "unit: nit\nunit: nit\n", "key 'unit' appears twice"},
        Bad{"version", "unit: nit\natrium2: 1\n", "unknown key"},
        Bad{"syntax", "materials: {a: [1, 2\n", "scene.yaml:"},
        Bad{"document", "unit: nit\n---\natrium: 1\n", "more than one YAML document"},
        Bad{"own_alias", "materials: &a {x: *a}\n", "an alias within its own value"},
        Bad{"no_power", "materials:\n  a: {emission: {power: 10}}\n",
            ":3:25: no surface has material 'a'"},
        Bad{"copies",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, box: {size: [1, 1, 1]}, "
            "repeat: {count: [1000, 1000, 1000], step: [1, 1, 1]}}\n",
            "more than 100000 copies"},
        Bad{"concave",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, polygon: [[0, 0, 0], "
            "[2, 0, 0], [0.2, 0.2, 0], [0, 2, 0]]}\n",
            "must be convex"},
        Bad{"bent",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, polygon: [[0, 0, 0], "
            "[1, 0, 0], [1, 1, 0.5], [0, 1, 0]]}\n",
            "must be flat"},
        Bad{"index",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, mesh: {vertices: [[0, 0, 0], "
            "[1, 0, 0], [1, 1, 0]], faces: [[0, 1, 3]]}}\n",
            "within 0 and 2"},
        Bad{"singular",
            "materials: {a: {body: 0}}\nobjects:\n  - {material: a, sphere: {radius: 1}, "
            "scale: [1, 0, 1]}\n",
            "scale must not be 0"},
        Bad{"wavelengths", "spectra:\n  s: {wavelengths: [500, 400], values: [1, 2]}\n",
            "must increase"},
        Bad{"counts", "spectra:\n  s: {wavelengths: [500], values: [1, 2]}\n",
            "as many values as wavelengths"},
        Bad{"falloff", "lights:\n  - point: {position: [0, 0, 0], intensity: 1, falloff: [0, 0]}\n",
            "not both 0"},
        Bad{"cone",
            "lights:\n  - spot: {position: [0, 0, 0], intensity: 1, inner_angle: 50, "
            "outer_angle: 40}\n",
            "must be less than outer_angle"},
        Bad{"direction", "lights:\n  - directional: {irradiance: 1, direction: [0, 0, 0]}\n",
            "must not be zero"},
        Bad{"unit", "unit: candela\n", "expected one of: nit, watt"}),
    [](const auto& bad) { return bad.param.name; });

TEST_F(YamlScenes, HazardsEndInErrorsNotInMemory) {
  EXPECT_NE(error("objects: " + std::string(100000, '[') + "\n").find("scene.yaml:"),
            std::string::npos);
  EXPECT_NE(error("objects: " + std::string(80, '[') + std::string(80, ']') + "\n")
                .find("nested deeper than 64"),
            std::string::npos);
  std::string bomb = "description: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += "k" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += last + (k < 9 ? ", " : "]\n");
  }
  EXPECT_NE(error(bomb).find("more than 2000000 values"), std::string::npos);
  Model model;
  EXPECT_THROW(read_yaml(model, folder_ / "none.yaml", {}), Error);
  write("empty.yaml", "");
  EXPECT_THROW(read_yaml(model, folder_ / "empty.yaml", {}), Error);
  write("other.yaml", "unit: nit\n");
  EXPECT_THROW(read_yaml(model, folder_ / "other.yaml", {}), Error);  // no version
}

TEST_F(YamlScenes, AliasesAreCopies) {
  const Model model = read("materials:\n  a: &m {body: 0.25}\n  b: *m\n");
  EXPECT_EQ(number(*material_named(model, "b").body_reflectance), 0.25);
}

// ---- materials ----

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

// ---- objects ----

TEST_F(YamlScenes, ShapesHaveTheirVolumes) {
  const Model model = read(
      "materials: {a: {body: 0.5}}\n"
      "objects:\n"
      "  - {material: a, box: {min: [1, 2, 3], max: [2, 4, 6]}}\n"
      "  - {material: a, sphere: {center: [1, 2, 3], radius: 2, segments: 256}}\n"
      "  - {material: a, cylinder: {from: [0, 0, 0], to: [3, 4, 0], radius: 0.5, segments: 256}}\n"
      "  - {material: a, mesh: {vertices: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],\n"
      "     faces: [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}}\n"
      "  - {material: a, box: {size: [1, 1, 1], inside: true}}\n"
      "  - {material: a, cylinder: {from: [0, 1, 0], to: [0, 0, 0], radius: 1, open: true}}\n");
  ASSERT_EQ(model.nodes.size(), 6u);
  const auto mesh = [&](std::size_t i) -> const MeshData& {
    return model.meshes[model.nodes[i].mesh.value];
  };
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(open_edges(mesh(i)), 0u) << i;
  EXPECT_GT(open_edges(mesh(5)), 0u);
  EXPECT_NEAR(volume_of(mesh(0)), 6.0, 1e-12);
  // n segments lack a share of about (2 pi / n)^2 / 2 = 3e-4 of the ball's volume.
  EXPECT_NEAR(volume_of(mesh(1)) / (4.0 / 3.0 * kPi * 8.0), 1.0, 4e-4);
  EXPECT_NEAR(volume_of(mesh(2)) / (kPi * 0.25 * 5.0), 1.0, 2e-4);
  EXPECT_NEAR(volume_of(mesh(3)), 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(volume_of(mesh(4)), -1.0, 1e-12);
  for (std::size_t i = 0; i < mesh(1).positions.size(); ++i) {
    const Vec3d n = (mesh(1).positions[i] - Vec3d(1, 2, 3)) / 2.0;
    EXPECT_GT(n.dot(mesh(1).normals[i].cast<double>()), 1.0 - 1e-6);
  }
  EXPECT_NEAR(area_of(mesh(5)) / (2.0 * kPi), 1.0, 1e-3);
}

TEST_F(YamlScenes, BoxSidesTakeTheirOwnMaterials) {
  const Model model = read(
      "materials: {a: {body: 0.5}, b: {body: 0.1}, c: {body: 0.2}}\n"
      "objects:\n"
      "  - {material: a, materials: {bottom: b, top: c}, box: {size: [2, 3, 4], omit: [front]}}\n");
  std::map<std::string, double> area;
  for (const Model::Node& node : model.nodes) {
    area[model.materials[node.material.value].name] += area_of(model.meshes[node.mesh.value]);
  }
  EXPECT_NEAR(area["a"], 12.0 + 12.0 + 6.0, 1e-12);  // left, right, back
  EXPECT_NEAR(area["b"], 8.0, 1e-12);
  EXPECT_NEAR(area["c"], 8.0, 1e-12);
  EXPECT_NE(
      error("materials: {a: {body: 0.5}}\nobjects:\n  - {material: a, materials: {frontt: a}, "
            "box: {size: [2, 3, 4]}}\n")
          .find("has no part 'frontt'"),
      std::string::npos);
}

TEST_F(YamlScenes, GroupsPlaceTheirParts) {
  const Model model = read(
      "materials: {a: {body: 0.5}, b: {body: 0.1}}\n"
      "groups:\n"
      "  pair:\n"
      "    - {name: cube, material: a, box: {size: [1, 1, 1]}, repeat: {count: 2, step: [0, 0, "
      "3]}}\n"
      "    - {light: {point: {position: [0, 1, 0], intensity: 5}}}\n"
      "objects:\n"
      "  - {use: pair, translate: [10, 0, 0], rotate: 90, repeat: {count: [2, 1, 3], step: [100, "
      "7, 50]}}\n"
      "  - {use: pair, at: [[1, 2, 3], [4, 5, 6, 180]], materials: {a: b}}\n"
      "  - {group: [{use: pair}], scale: 2, translate: [0, 9, 0]}\n");
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.nodes.size(), 12u + 4u + 2u);
  ASSERT_EQ(model.lights.size(), 6u + 2u + 1u);
  // Rotation by 90 degrees about y takes +z to +x.
  EXPECT_TRUE(model.nodes[1].to_world.translation().isApprox(Vec3d(13, 0, 0), 1e-12));
  EXPECT_TRUE(model.nodes[11].to_world.translation().isApprox(Vec3d(113, 0, 100), 1e-12));
  EXPECT_TRUE(model.nodes[15].to_world.translation().isApprox(Vec3d(4, 5, 3), 1e-12));
  EXPECT_EQ(model.materials[model.nodes[15].material.value].name, "b");
  EXPECT_TRUE(model.lights[8].to_scene.translation().isApprox(Vec3d(0, 11, 0), 1e-12));
  EXPECT_NEAR(model.lights[8].to_scene.linear().determinant(), 1.0, 1e-12) << "no size to scale";
}

TEST_F(YamlScenes, MatrixAndTransformExcludeEachOther) {
  const std::string start =
      "materials: {a: {body: 0.5}}\nobjects:\n"
      "  - {material: a, box: {size: [1, 1, 1]}, ";
  EXPECT_NE(
      error(start + "scale: 2, matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0]}\n").find("give a matrix or"),
      std::string::npos);
  const Model model = read(start + "matrix: [0,0,1,5, 0,1,0,6, -1,0,0,7]}\n");
  EXPECT_TRUE((model.nodes[0].to_world * Vec3d(1, 0, 0)).isApprox(Vec3d(5, 6, 6), 1e-12));
}

TEST_F(YamlScenes, CagesAreClosedAndKeepTheirPolygons) {
  write("house.obj",
        "# a pentagonal prism\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.5 0\nv 0 1 0\n"
        "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0.5 1.5 1\nv 0 1 1\n"
        "f 5 4 3 2 1\nf 6/1 7/1 8/1 9/1 10/1\nf 1 2 -4 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\nf 5 1 "
        "6 10\n");
  const Model model = read(
      "materials: {a: {body: 0.5}}\n"
      "objects:\n"
      "  - {material: a, cage: {box: {size: [1, 2, 3], divide: [2, 3, 4]}, sharpness: 1.5}}\n"
      "  - {material: a, cage: {lathe: {sides: 6, profile: [[0, 0], [1, 0], [1, 1], [0, 1]]}}}\n"
      "  - {material: a, cage: {file: house.obj, creases: [[0, 1, sharp], [1, 2, 0.5]]}}\n"
      "  - {material: a, cage: {scheme: loop, mesh: {vertices: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],\n"
      "     faces: [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}, sharp_boundary: false}}\n");
  ASSERT_EQ(model.meshes.size(), 4u);
  for (const MeshData& mesh : model.meshes) {
    ASSERT_TRUE(mesh.cage);
    EXPECT_EQ(open_edges(mesh), 0u);
  }
  const SubdivisionCage& box = *model.meshes[0].cage;
  EXPECT_EQ(box.face_sizes.size(), 2u * (2 * 3 + 3 * 4 + 4 * 2));
  // Euler: V - E + F = 2, with E = 2 F for quadrilaterals.
  EXPECT_EQ(model.meshes[0].positions.size(), box.face_sizes.size() + 2);
  EXPECT_EQ(box.creases.size(), 2 * box.face_sizes.size()) << "every edge once";
  EXPECT_EQ(model.meshes[1].positions.size(), 14u);
  const SubdivisionCage& house = *model.meshes[2].cage;
  EXPECT_EQ(house.face_sizes[0], 5u);
  ASSERT_EQ(house.creases.size(), 2u);
  EXPECT_TRUE(std::isinf(house.creases[0].sharpness));
  EXPECT_EQ(model.meshes[3].cage->scheme, SubdivisionCage::Scheme::Loop);
  EXPECT_FALSE(model.meshes[3].cage->sharp_boundary);
  // Outward: the volume of the fans from the origin is positive.
  for (const MeshData& mesh : model.meshes) {
    double volume = 0.0;
    std::size_t begin = 0;
    for (const std::uint32_t n : mesh.cage->face_sizes) {
      const auto p = [&](std::size_t i) {
        return mesh.positions[mesh.cage->face_indices[begin + i]];
      };
      for (std::uint32_t i = 2; i < n; ++i) volume += p(0).dot(p(i - 1).cross(p(i))) / 6.0;
      begin += n;
    }
    EXPECT_GT(volume, 0.0) << mesh.cage->face_sizes.size();
  }
}

// ---- lights, cameras, environment ----

TEST_F(YamlScenes, Lights) {
  write("lamp.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 180\n0\n100 100\n");
  const Model model = read(
      "lights:\n"
      "  - {name: p, point: {position: [1, 2, 3], flux: 100, falloff: [0.5, 2]}}\n"
      "  - {spot: {position: [0, 3, 0], target: [0, 3, -5], intensity: [10, 20, 30],\n"
      "     inner_angle: 10, outer_angle: 30}}\n"
      "  - {directional: {direction: [0, -2, 0], irradiance: 50000, angular_diameter: 0.53}}\n"
      "  - {ies: {file: lamp.ies, position: [0, 2, 0], flux: 1000}}\n"
      "  - {rectangle: {center: [0, 2.5, 0], size: [1, 2], radiance: 500}, "
      "repeat: {count: 2, step: [3, 0, 0]}}\n"
      "environment: {radiance: [1, 2, 3], rotate: 90}\n");
  ASSERT_EQ(model.lights.size(), 4u);
  const auto& point = std::get<PointLight>(model.lights[0].kind);
  EXPECT_NEAR(number(point.intensity), 100.0 / (4.0 * kPi), 1e-12);
  EXPECT_EQ(point.falloff.c1, 0.5);
  EXPECT_EQ(point.falloff.c2, 2.0);
  EXPECT_EQ(model.lights[0].to_scene.translation(), Vec3d(1, 2, 3));
  const auto axis = [&](std::size_t i) {
    return (model.lights[i].to_scene.linear() * Vec3d(0, 0, -1)).eval();
  };
  EXPECT_TRUE(axis(1).isApprox(Vec3d(0, 0, -1), 1e-12));
  EXPECT_NEAR(std::get<SpotLight>(model.lights[1].kind).outer_angle, kPi / 6.0, 1e-6);
  EXPECT_TRUE(axis(2).isApprox(Vec3d(0, -1, 0), 1e-12));
  EXPECT_NEAR(std::get<DirectionalLight>(model.lights[2].kind).angular_radius, 0.265 * kPi / 180.0,
              1e-8);
  EXPECT_TRUE(axis(3).isApprox(Vec3d(0, -1, 0), 1e-12));
  const auto& profile = std::get<ProfileLight>(model.lights[3].kind);
  EXPECT_NEAR(number(profile.scale) * profile.profile.flux(), 1000.0, 1e-9);
  // Phi = 0 lies along x for a luminaire that looks down.
  EXPECT_TRUE((model.lights[3].to_scene.linear() * Vec3d(1, 0, 0)).isApprox(Vec3d(1, 0, 0), 1e-12));
  ASSERT_EQ(model.nodes.size(), 2u);
  const MeshData& mesh = model.meshes[model.nodes[0].mesh.value];
  const Triangle& t = mesh.triangles[0];
  const auto corner = [&](std::size_t i) -> Vec3d {
    return model.nodes[1].to_world * mesh.positions[t[i]];
  };
  const Vec3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  EXPECT_TRUE(normal.isApprox(Vec3d(0, -1, 0), 1e-12)) << "lights the floor, not the ceiling";
  EXPECT_NEAR(area_of(mesh), 2.0, 1e-12);
  EXPECT_TRUE(model.nodes[1].to_world.translation().isApprox(Vec3d(3, 2.5, 0), 1e-12));
  ASSERT_TRUE(model.environment);
  EXPECT_EQ(std::get<Rgb>(model.environment->radiance), make_rgb(1, 2, 3));
}

// A scene in watts takes a luminaire's candela at 179 lm/W.
TEST_F(YamlScenes, WattsAndLumens) {
  write("lamp.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 180\n0\n100 100\n");
  const Model model =
      read("unit: watt\nlights:\n  - {ies: {file: lamp.ies, position: [0, 2, 0]}}\n");
  EXPECT_EQ(model.unit, RadianceUnit::Watt);
  EXPECT_NEAR(number(std::get<ProfileLight>(model.lights[0].kind).scale), 1.0 / 179.0, 1e-12);
}

// ---- daylight ----

double dome_irradiance(const Model& model) { return number(model.environment->radiance); }
const SkyDome& dome_of(const Model& model) { return std::get<SkyDome>(model.environment->pattern); }
const DirectionalLight& sun_of(const Model& model) {
  return std::get<DirectionalLight>(model.lights.at(0).kind);
}
Vec3d towards_sun(const Model& model) { return model.lights.at(0).to_scene.linear().col(2); }

TEST_F(YamlScenes, CieSkies) {
  // E = 7 pi / 9 Lz, and a ground of albedo 0.2 below it.
  const Model overcast = read("sky: {cie: 16, zenith: 9000}\n");
  EXPECT_NEAR(dome_irradiance(overcast), 7000.0 * kPi, 0.01);
  EXPECT_NEAR(dome_of(overcast).ground(), 0.2 / kPi, 1e-12);
  EXPECT_TRUE(overcast.lights.empty());
  const Model clear = read(
      "north: 90\n"
      "sun: {azimuth: 90, elevation: 30, irradiance: 60000}\n"
      "sky: {cie: 12, irradiance: 15000, ground: 0.4}\n");
  EXPECT_NEAR(dome_irradiance(clear), 15000.0, 1e-6);
  // The ground has the sky's 15000 lx and 60000 sin 30 from the sun.
  EXPECT_NEAR(dome_of(clear).ground(), 0.4 * (1.0 + 30000.0 / 15000.0) / kPi, 1e-12);
  EXPECT_NEAR(number(sun_of(clear).irradiance), 60000.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(sun_of(clear).angular_radius) * 360.0 / kPi, 0.533, 1e-3);
  // North is +x, so east is +z; sky and sun agree where the sun is.
  const Vec3d east(0.0, 0.5, std::sqrt(0.75));
  EXPECT_TRUE(towards_sun(clear).isApprox(east, 1e-6));
  EXPECT_TRUE((clear.environment->to_scene * dome_of(clear).sun()).isApprox(east, 1e-6));
}

TEST_F(YamlScenes, PerezSkiesAndUnits) {
  const std::string text =
      "sun: {place: {latitude: 52, longitude: 13, utc_offset: 1}, time: [2021, 6, 21, 12]}\n"
      "sky: {perez: {direct_normal: 700, diffuse_horizontal: 120}}\n";
  const Model nits = read(text);
  // 100 and 130 lm/W or so.
  EXPECT_NEAR(number(sun_of(nits).irradiance) / 700.0, 102.0, 4.0);
  EXPECT_NEAR(dome_irradiance(nits) / 120.0, 132.0, 8.0);
  EXPECT_NEAR(std::asin(towards_sun(nits).y()) * 180.0 / kPi, 61.4, 0.2);
  const Model watts = read("unit: watt\n" + text);
  EXPECT_NEAR(number(sun_of(watts).irradiance), 700.0, 1e-9);
  EXPECT_NEAR(dome_irradiance(watts), 120.0, 1e-9);
}

TEST_F(YamlScenes, WeatherFiles) {
  write("a.epw",
        "LOCATION,Somewhere,XX,YYY,TMY3,1,41.98,-87.92,-6.0,201.0\nDATA PERIODS,1\n"
        "1986,6,21,12,0,?9,30.6,13.3,35,99000,1247,1322,405,876,703,211\n"
        "1986,6,21,24,0,?9,20.6,13.3,35,99000,0,0,405,0,0,0\n");
  const Model model = read("sky: {epw: a.epw, time: [6, 21, 12]}\nunit: watt\n");
  EXPECT_NEAR(dome_irradiance(model), 211.0, 1e-9);
  EXPECT_NEAR(number(sun_of(model).irradiance), 703.0, 1e-9);
  EXPECT_NEAR(std::asin(towards_sun(model).y()) * 180.0 / kPi, 71.0, 1.0);
  EXPECT_EQ(error("sky: {epw: a.epw, time: [6, 21, 24]}\n"),
            "scene.yaml:2:25: the sun is 24 degrees below the horizon then");
  EXPECT_EQ(error("sky: {epw: a.epw, time: [6, 22, 12]}\n"),
            "a.epw:4: has no row for month 6, day 22, hour 12");
}

TEST_F(YamlScenes, SunWithoutASky) {
  const Model model = read("sun: {azimuth: 180, elevation: 45, irradiance: 1000}\n");
  EXPECT_FALSE(model.environment);
  EXPECT_TRUE(towards_sun(model).isApprox(Vec3d(0, 1, 1).normalized(), 1e-6)) << "south is +z";
}

TEST_F(YamlScenes, DaylightErrors) {
  EXPECT_EQ(error("sky: {cie: 17, zenith: 1}\n"),
            "scene.yaml:2:12: must lie within 1 and 16, is 17");
  EXPECT_EQ(error("sky: {cie: 12, zenith: 1}\n"),
            "scene.yaml:2:12: this type of sky follows the sun: say where it is by 'sun'");
  EXPECT_EQ(error("sky: {cie: 1}\n"), "scene.yaml:2:6: sky needs one of: irradiance, zenith");
  EXPECT_EQ(error("sky: {perez: {direct_normal: 1, diffuse_horizontal: 2}}\n"),
            "scene.yaml:2:14: this sky follows the sun: say where it is by 'sun'");
  EXPECT_EQ(error("sun: {azimuth: 1, elevation: 30, irradiance: 3}\n"
                  "sky: {perez: {direct_normal: 1, diffuse_horizontal: 2}}\n"),
            "scene.yaml:2:6: the sun's irradiance follows from the sky's direct irradiance");
  EXPECT_EQ(error("sun: {irradiance: 3}\n"),
            "scene.yaml:2:6: say where the sun is: azimuth and elevation, or place and time");
  EXPECT_EQ(error("sun: {place: {latitude: 50, longitude: 0, utc_offset: 0}, "
                  "time: [2023, 2, 29, 12]}\n"),
            "scene.yaml:2:65: there is no such date");
  EXPECT_EQ(error("north: 10\n"), "scene.yaml:2:8: turns sun and sky, but there is neither");
  EXPECT_EQ(error("sky: {cie: 1, zenith: 1}\nenvironment: {radiance: 1}\n"),
            "scene.yaml:2:6: give sky or environment, not both");
  EXPECT_EQ(error("sky: {cie: 1, zenith: 1, time: [1, 1, 1]}\n"),
            "scene.yaml:2:32: this key belongs to an epw sky");
}

TEST_F(YamlScenes, Portals) {
  const Model model = read(
      "materials: {m: {body: 0.5}}\n"
      "objects:\n"
      "  - {name: opening, polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], material: m}\n"
      "portals:\n"
      "  find: false\n"
      "  polygons: [[[0, 1, 1], [0, 2, 1], [0, 2, 3], [0, 1, 3]]]\n"
      "  objects: [opening]\n");
  EXPECT_FALSE(model.portals.find);
  ASSERT_EQ(model.portals.polygons.size(), 1u);
  EXPECT_EQ(model.portals.polygons[0][2], Vec3d(0, 2, 3));
  EXPECT_EQ(model.portals.objects, std::vector<std::string>{"opening"});
  EXPECT_EQ(error("portals: {objects: [door]}\n"), "scene.yaml:2:21: there is no object 'door'");
  EXPECT_EQ(error("portals: {polygons: [[[0, 1, 1], [0, 2, 1], [0, 3, 1]]]}\n"),
            "scene.yaml:2:22: a polygon without area");
}

// An image of floats keeps them: no 8 bits between the file and the sky.
TEST_F(YamlScenes, EnvironmentImages) {
  const std::vector<float> pixels{0.25f, 1e-4f, 3000.0f, -1.0f};
  std::string text = "Pf\n2 2\n-1.0\n";
  text.append(reinterpret_cast<const char*>(pixels.data()), 16);
  write("sky.pfm", text);
  const Model model = read("environment: {radiance: 2, image: sky.pfm, rotate: 30}\n");
  const auto& image = std::get<Image>(model.environment->pattern);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.at(0, 0, 1), 3000.0f);  // the file's rows go upwards
  EXPECT_EQ(image.at(1, 0, 0), 0.0f);     // no negative light
  EXPECT_EQ(image.at(1, 1, 2), 1e-4f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(text.data() + text.size() - 4, &nan, 4);
  write("sky.pfm", text);
  EXPECT_EQ(error("environment: {radiance: 1, image: sky.pfm}\n"),
            "sky.pfm: holds pixels that are no numbers");
}

TEST_F(YamlScenes, Cameras) {
  const Model model = read(
      "cameras:\n"
      "  - {name: a, perspective: {eye: [1, 2, 3], target: [1, 2, 9], yfov: 45, aspect: 1.5}}\n"
      "  - {name: b, orthographic: {eye: [0, 9, 0], direction: [0, -1, 0], height: 4}}\n"
      "  - {panorama: {eye: [0, 1, 0], direction: [1, 0, 0]}}\n");
  ASSERT_EQ(model.cameras.size(), 3u);
  EXPECT_NEAR(model.cameras[0].yfov, kPi / 4.0, 1e-12);
  EXPECT_EQ(model.cameras[0].aspect, 1.5);
  const auto middle = [&](std::size_t i) {
    return model.cameras[i].ray({0.5, 0.5}, 1.0).direction;
  };
  EXPECT_TRUE(middle(0).isApprox(Vec3f(0, 0, 1), 1e-6f));
  // Looking along +z with y up, the right side of the picture is at -x.
  EXPECT_LT(model.cameras[0].ray({1.0, 0.5}, 1.0).direction.x(), -0.1f);
  EXPECT_EQ(model.cameras[1].kind, Camera::Kind::Orthographic);
  EXPECT_TRUE(middle(1).isApprox(Vec3f(0, -1, 0), 1e-6f));
  EXPECT_TRUE(middle(2).isApprox(Vec3f(1, 0, 0), 1e-6f));
}

TEST_F(YamlScenes, ModelFilesAreReadOnceAndRecoloured) {
  write("part.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const Model model = read(
      "materials: {red: {body: [0.5, 0.1, 0.1]}}\n"
      "objects:\n"
      "  - {file: part.obj, material: red, translate: [5, 0, 0]}\n"
      "  - {file: part.obj, repeat: {count: 3, step: [1, 0, 0]}}\n");
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.nodes.size(), 4u);
  EXPECT_EQ(model.materials[model.nodes[0].material.value].name, "red");
  EXPECT_NE(model.materials[model.nodes[1].material.value].name, "red");
  EXPECT_TRUE(model.nodes[3].to_world.translation().isApprox(Vec3d(2, 0, 0), 1e-12));
}

// ---- the shipped scenes ----

struct Shipped {
  const char* file;
  std::size_t fewest_nodes;
  bool has_cage;
};
class ShippedScenes : public testing::TestWithParam<Shipped> {};
TEST_P(ShippedScenes, Load) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes" / GetParam().file, {});
  EXPECT_GE(model.nodes.size(), GetParam().fewest_nodes);
  EXPECT_FALSE(model.cameras.empty());
  EXPECT_TRUE(model.warnings.empty());
  bool cage = false;
  for (const MeshData& mesh : model.meshes) cage = cage || mesh.cage.has_value();
  EXPECT_EQ(cage, GetParam().has_cage);
  bool light = model.environment.has_value() || !model.lights.empty();
  for (const material::Material& m : model.materials) light = light || m.emissive();
  EXPECT_TRUE(light);
  const Scene scene = build_scene(std::move(model));
  EXPECT_EQ(scene.report.non_finite_dropped, 0u);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScenes,
                         testing::Values(Shipped{"cornell/cornell.yaml", 8, false},
                                         Shipped{"furnace/furnace.yaml", 3, false},
                                         Shipped{"glass_and_mirror/glass_and_mirror.yaml", 10,
                                                 false},
                                         Shipped{"office/office.yaml", 300, true},
                                         Shipped{"lounge/lounge.yaml", 40, true},
                                         Shipped{"paper/paper.yaml", 8, false}));

// Spot checks against the published tables (400, 528, 700 nm), and the balance that makes the
// red wall red.
TEST(ShippedScenes, CornellSpectraAreThePublishedOnes) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes/cornell/cornell.yaml", {});
  const auto value = [&](const char* name, double nm) {
    return std::get<SampledSpectrum>(*material_named(model, name).body_reflectance).at(nm);
  };
  EXPECT_DOUBLE_EQ(value("white", 400), 0.343);
  EXPECT_DOUBLE_EQ(value("white", 456), 0.777);
  EXPECT_DOUBLE_EQ(value("white", 700), 0.737);
  EXPECT_DOUBLE_EQ(value("green", 528), 0.481);
  EXPECT_DOUBLE_EQ(value("green", 700), 0.159);
  EXPECT_DOUBLE_EQ(value("red", 400), 0.040);
  EXPECT_DOUBLE_EQ(value("red", 688), 0.657);
  EXPECT_NEAR(luminance_of(material_named(model, "lamp").emission), 12000.0, 1e-2);
}

// The office stands on 130 m x 120 m of ground: the view is chosen inside it, standing, level, and
// the same every time.
TEST(ShippedScenes, InteriorViewOfTheOfficeIsInTheRoom) {
  Model model;
  read_yaml(model, std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes/office/office.yaml", {});
  const Scene scene = build_scene(std::move(model));
  const RayQuery query(scene);
  const Camera camera = choose_interior_view(scene, query);
  const Vec3d eye = camera.to_scene.translation() + scene.origin;
  const Bounds room(Vec3d(0.3, 1.0, 0.3), Vec3d(12.9, 2.0, 6.9));
  EXPECT_TRUE(room.contains(eye)) << eye.transpose();
  EXPECT_NEAR(camera.to_scene.linear().col(2).y(), 0.0, 1e-9);
  EXPECT_TRUE(choose_interior_view(scene, query).to_scene.isApprox(camera.to_scene, 0.0));
}

TEST_F(YamlScenes, MediumIsTheExtinctionOfTheAir) {
  EXPECT_EQ(std::get<double>(read("objects: []\n").medium_extinction), 0.0);
  const Model model = read("medium: {extinction: [0.1, 0.2, 0.3]}\n");
  EXPECT_EQ(std::get<Rgb>(model.medium_extinction), make_rgb(0.1, 0.2, 0.3));
  EXPECT_NE(error("medium: {extinction: -1}\n"), "");
  EXPECT_NE(error("medium: {density: 1}\n").find("extinction"), std::string::npos);
  EXPECT_NE(error("medium: {}\n"), "");
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
