// Baked models: a file that our own importer reads shows the field.
#include "radiosity/bake.h"

#include <random>

#include "lightmap_charts.h"
#include "material/error.h"
#include "physics/radiosity_support.h"
#include "radiosity/export_mesh.h"
#include "scene/image_io.h"
#include "scene/scene_io.h"
#include "support/glb_check.h"
#include "support/temp_folder.h"
#include "trace/render.h"
#include "triangulate_polygon.h"
#include "unit/radiosity/field_picture.h"

namespace {

using namespace atrium;
using radiosity::bake;
using scene::BakedModel;
using Kind = BakedModel::Material::Kind;

const material::SpectralBasis kRgb = material::SpectralBasis::rgb();

material::Texture checker() {
  material::Texture t;
  t.name = "checker";
  t.width = t.height = 16;
  t.channels = 3;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const bool light = ((x / 4) + (y / 4)) % 2 == 0;
      for (const int v : {250, 200, 120})
        t.pixels.push_back(static_cast<std::uint8_t>(light ? v : v / 2));
    }
  return t;
}

/// A coloured room with a baffle lit on both sides, differently, a panel, and a black lamp.
scene::Scene room(bool textured) {
  test::SceneMaker maker;
  const auto grey = maker.material(test::diffuse(0.6));
  material::Material red = test::diffuse(0.5);
  red.body_reflectance = make_rgb(0.6f, 0.2f, 0.1f);
  const auto painted = maker.material(red);
  maker.room({0, 0, 0}, {4, 3, 3}, {grey, painted, grey, grey, grey, grey});
  maker.quad(grey, {2.0f, 0.0f, 0.8f}, {2.0f, 2.0f, 0.8f}, {2.0f, 2.0f, 2.2f}, {2.0f, 0.0f, 2.2f});
  maker.quad(maker.material(test::emitter(20.0, 0.5)), {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f},
             {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.quad(maker.material(test::emitter(5.0, 0.0)), {3.0f, 0.5f, 0.1f}, {3.5f, 0.5f, 0.1f},
             {3.5f, 1.0f, 0.1f}, {3.0f, 1.0f, 0.1f});
  scene::Scene s = maker.take();
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    s.objects[i].name = "part " + std::to_string(i);
    s.materials[s.objects[i].material.value].name =
        std::string("m").append(std::to_string(s.objects[i].material.value));
  }
  s.origin = Vec3d(10, 0, -5);
  if (textured) {
    s.textures = {checker()};
    s.materials[s.objects[2].material.value].body_texture.texture = material::TextureId{0};
    for (scene::Mesh& m : s.meshes)
      for (const Vec3f& p : m.positions)
        m.uvs.emplace_back(0.5f * p.x() + 0.3f * p.y(), 0.5f * p.z());
  }
  scene::Camera camera;
  camera.name = "corner";
  camera.to_scene = scene::look_at({0.3, 1.6, 2.7}, {3.5, 1.2, 0.2}, Vec3d::UnitY());
  camera.yfov = 1.1;
  s.cameras = {camera};
  return s;
}

struct Baked {
  explicit Baked(bool textured = false)
      : scene(room(textured)),
        query(scene),
        result(radiosity::solve(query, kRgb,
                                {.max_elements = 4000,
                                 .mesh_error = 0.01,
                                 .direct_samples = 64,
                                 .light_groups = scene::Grouping::ByName})) {}
  scene::Scene scene;
  scene::RayQuery query;
  radiosity::SolveResult result;

  [[nodiscard]] BakedModel model(const radiosity::BakeOptions& options = {}) const {
    return bake(scene, result.elements, result.field, kRgb, result.groups, options);
  }
};
const Baked& plain() {
  static const Baked b;
  return b;
}

std::vector<std::uint8_t> encode(const BakedModel& model, double white) {
  return scene::encode_glb(model, {.white = white});
}

/// The file as another program sees it: read, and rendered without any inter-reflection.
scene::Image picture_of(const std::vector<std::uint8_t>& glb, int width, int height) {
  const test::TempFolder folder;
  scene::write_bytes(glb, folder / "baked.glb");
  const scene::Scene read = scene::build_scene(scene::read_model({folder / "baked.glb"}));
  EXPECT_EQ(read.cameras.size(), 1U);
  const scene::RayQuery query(read);
  return trace::render(query, kRgb, read.cameras.at(0), {},
                       {.method = trace::Method::Direct,
                        .width = width,
                        .height = height,
                        .samples = 16,
                        .share_samples = false})
      .image;
}

/// Mean absolute difference over the mean of the reference, colour for colour.
double difference(const scene::Image& a, double scale, const scene::Image& reference) {
  double sum = 0.0;
  double mean = 0.0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (const char* c : {"R", "G", "B"}) {
        const double r = static_cast<double>(reference.at(x, y, reference.channel_index(c)));
        sum += std::abs(scale * static_cast<double>(a.at(x, y, a.channel_index(c))) - r);
        mean += r;
      }
  EXPECT_GT(mean, 0.0);
  ::testing::Test::RecordProperty("difference_percent", std::to_string(100.0 * sum / mean));
  return sum / mean;
}

// Elements of 0.1 to 0.2 m: triangles instead of bilinear cells, limited slopes at rims, edges of
// things within pixels (16 random against 9 regular samples) leave 1.5 %. Nothing is clipped.
TEST(Bake, AFileShowsTheField) {
  const Baked& b = plain();
  const scene::Image field =
      test::field_picture<3>(b.query, kRgb, b.result.field, b.scene.cameras[0], 80, 60);
  const double white = 25.0;
  const scene::Image file = picture_of(encode(b.model(), white), 80, 60);
  EXPECT_LT(difference(file, white, field), 0.015);
}

// The picture of the floor stays sharp: it is not in the vertices. JPEG and textures that are read
// bilinearly on both sides leave another 1 %.
TEST(Bake, TexturesStayPictures) {
  if (!scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  const Baked b(true);
  const scene::Image field =
      test::field_picture<3>(b.query, kRgb, b.result.field, b.scene.cameras[0], 80, 60);
  const BakedModel model = b.model();
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_LT(difference(picture_of(encode(model, 60.0), 80, 60), 60.0, field), 0.03);
}

TEST(Bake, FilesAreSoundGltf) {
  for (const bool page : {false, true}) {
    const Baked& b = plain();
    const BakedModel model = b.model({.group_light = page, .merge_objects = page});
    const std::vector<std::uint8_t> bytes =
        scene::encode_glb(model, {.white = 25.0, .ev = 4.0, .page = page});
    const test::Glb glb = test::parse_glb(bytes);
    test::check_glb(glb);
    EXPECT_EQ(glb.json.at("cameras").size(), 1U);
    for (const auto& m : glb.json.at("materials"))
      EXPECT_TRUE(m.at("extensions").contains("KHR_materials_unlit"));
    const auto& extras = glb.json.at("asset").at("extras").at("atrium");
    EXPECT_EQ(extras.at("radiance_of_white"), 25.0);
    EXPECT_EQ(extras.at("exposure_ev"), 4.0);
    EXPECT_EQ(extras.at("unit"), "W/(sr m^2)");
    if (page) {
      EXPECT_EQ(glb.json.at("meshes").size(), 2U);  // with elements, without
      EXPECT_EQ(extras.at("groups").size(), 2U);
    } else {
      EXPECT_EQ(glb.json.at("meshes").size(), 11U);  // 9 things, of the baffle and panel two sides
    }
  }
}

/// Integral of radiosity over an object's triangles, from the file alone.
double flux_in(const test::Glb& glb, const std::string& name, double white) {
  double flux = 0.0;
  for (const auto& mesh : glb.json.at("meshes")) {
    if (mesh.at("name") != name) continue;
    const auto& p = mesh.at("primitives").at(0);
    const std::vector<double> x = glb.numbers(p.at("attributes").at("POSITION"));
    const std::vector<double> c = glb.numbers(p.at("attributes").at("COLOR_0"));
    const std::vector<double> index = glb.numbers(p.at("indices"));
    for (std::size_t t = 0; t < index.size(); t += 3) {
      std::array<Vec3d, 3> corner;
      double mean = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(index[t + k]);
        corner[k] = Vec3d(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        mean += (0.2126 * c[4 * i] + 0.7152 * c[4 * i + 1] + 0.0722 * c[4 * i + 2]) / 3.0;
      }
      flux += 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() * mean;
    }
  }
  return flux * M_PI * white;
}

// Both sides of every object: what the file says by its colours and extras is the field's radiosity
// within what corners differ from means of elements.
TEST(Bake, RadiosityIsRecoveredInItsUnit) {
  const Baked& b = plain();
  const double white = 25.0;
  const test::Glb glb = test::parse_glb(encode(b.model(), white));
  const scene::PolygonMesh mesh =
      radiosity::to_polygon_mesh(b.scene, b.result.elements, b.result.field, kRgb);
  std::vector<double> expected(b.scene.objects.size(), 0.0);
  const auto array = [&](const std::string& name) -> const std::vector<float>& {
    for (const auto& a : mesh.cell_arrays)
      if (a.name == name) return a.values;
    throw std::runtime_error(name);
  };
  std::size_t first = 0;
  for (std::size_t k = 0; k < mesh.polygon_sizes.size(); first += mesh.polygon_sizes[k++]) {
    Vec3d twice = Vec3d::Zero();
    const auto p = [&](std::size_t i) { return mesh.points[mesh.polygon_points[first + i]]; };
    for (std::size_t i = 1; i + 1 < mesh.polygon_sizes[k]; ++i)
      twice += (p(i) - p(0)).cross(p(i + 1) - p(0));
    for (const char* name : {"radiosity", "radiosity_back"}) {
      const std::vector<float>& v = array(name);
      expected[static_cast<std::size_t>(array("object_id")[k])] +=
          0.5 * twice.norm() *
          static_cast<double>(luminance(make_rgb(v[3 * k], v[3 * k + 1], v[3 * k + 2])));
    }
  }
  for (std::size_t o = 0; o < expected.size(); ++o) {
    if (expected[o] == 0.0) continue;
    EXPECT_NEAR(flux_in(glb, b.scene.objects[o].name, white), expected[o], 0.01 * expected[o]) << o;
  }
  // The lamp without elements: 5 W/(sr m^2) on 0.25 m^2.
  EXPECT_NEAR(flux_in(glb, b.scene.objects.back().name, white), 5.0 * M_PI * 0.25, 1e-3);
}

// The baffle hangs between the lit and the dim half.
TEST(Bake, SidesShowTheirOwnLight) {
  const BakedModel model = plain().model();
  std::vector<double> mean;
  std::vector<Vec3f> normal;
  for (const auto& p : model.primitives) {
    if (p.name != "part 6") continue;
    double sum = 0.0;
    for (const Rgb& r : p.radiance) sum += static_cast<double>(r[1]);
    mean.push_back(sum / static_cast<double>(p.radiance.size()));
    const auto corner = [&](std::size_t i) { return p.positions[p.indices[i]]; };
    normal.push_back((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized());
  }
  ASSERT_EQ(mean.size(), 2U);
  EXPECT_NEAR(normal[0].dot(normal[1]), -1.0f, 1e-4f);
  EXPECT_GT(std::max(mean[0], mean[1]), 1.5 * std::min(mean[0], mean[1]));
}

// With textures of the walls in the atlas: 2 cm texels, 8 bits of sRGB (0.4 %).
TEST(Lightmap, AFileShowsTheField) {
  if (!scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  const Baked b(true);
  const scene::Image field =
      test::field_picture<3>(b.query, kRgb, b.result.field, b.scene.cameras[0], 80, 60);
  const BakedModel model = b.model({.lightmap = 512});
  EXPECT_TRUE(model.textures.empty());
  EXPECT_LT(model.atlas.texel_size, 0.03);
  const std::vector<std::uint8_t> bytes = encode(model, 25.0);
  test::check_glb(test::parse_glb(bytes));
  EXPECT_LT(difference(picture_of(bytes, 80, 60), 25.0, field), 0.025);
}

// At every corner the bilinear look-up finds what that corner has as a vertex colour, whatever lies
// beside its chart: neighbours in the atlas are of other brightness.
TEST(Lightmap, CornersLookUpTheirOwnLight) {
  const Baked& b = plain();
  for (const std::uint32_t size : {64U, 256U, 1024U}) {
    SCOPED_TRACE(size);
    const BakedModel colours = b.model();
    const BakedModel map = b.model({.lightmap = size});
    const BakedModel::Atlas& atlas = map.atlas;
    const auto texel = [&](int x, int y) {
      return static_cast<double>(atlas.radiance[static_cast<std::size_t>(y * atlas.width + x)][1]);
    };
    double sum = 0.0, error = 0.0, largest = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < map.primitives.size(); ++k) {
      const BakedModel::Primitive& p = map.primitives[k];
      if (p.uvs.empty()) continue;
      const BakedModel::Primitive& q = colours.primitives[k];
      ASSERT_EQ(p.name, q.name);
      ASSERT_EQ(p.positions, q.positions);  // no smooth surfaces here, which share points
      for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const double u = static_cast<double>(p.uvs[i].x()) * atlas.width - 0.5;
        const double v = static_cast<double>(p.uvs[i].y()) * atlas.height - 0.5;
        const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
        const double s = u - x, t = v - y;
        ASSERT_TRUE(x >= 1 && y >= 1 && x + 1 < atlas.width && y + 1 < atlas.height);
        const double found = (1 - s) * (1 - t) * texel(x, y) + s * (1 - t) * texel(x + 1, y) +
                             (1 - s) * t * texel(x, y + 1) + s * t * texel(x + 1, y + 1);
        const double right = static_cast<double>(q.radiance[i][1]);
        error += std::abs(found - right);
        largest = std::max(largest, std::abs(found - right));
        sum += right;
        ++count;
      }
    }
    // What texels smooth: with 16 cm (64) elements of 10 cm, with 1 cm (1024) next to nothing.
    EXPECT_LT(error / sum, size == 64 ? 0.05 : size == 256 ? 0.01 : 0.003);
    // A neighbour's light at a border would be off by its own brightness.
    EXPECT_LT(largest, 0.5 * sum / static_cast<double>(count));
  }
}

TEST(Lightmap, ChartsLieApartAndUseOneSizeOfTexel) {
  const Baked& b = plain();
  const std::vector<std::uint8_t> wanted(2 * b.result.field.facets.size(), 1);
  const radiosity::LightmapCharts charts(b.result.field, wanted, 256);
  std::vector<std::uint8_t> used(256 * 256, 0);
  std::size_t texels = 0;
  for (const auto& c : charts.charts()) {
    const auto& f = b.result.field.facets[c.facet];
    const double width = f.nx / static_cast<double>(f.axis_u.norm());
    if (c.width > 2) {
      EXPECT_NEAR((c.width - 1) * charts.texel_size(), width, charts.texel_size());
    }
    constexpr std::uint32_t kPad = radiosity::LightmapCharts::kPadding;
    for (std::uint32_t y = c.y - kPad; y < c.y + c.height + kPad; ++y)
      for (std::uint32_t x = c.x - kPad; x < c.x + c.width + kPad; ++x) {
        ASSERT_LT(std::max(x, y), 256U);
        EXPECT_EQ(used[y * 256 + x]++, 0);
        ++texels;
      }
  }
  EXPECT_GT(texels, 256U * 256U / 2);  // of the atlas is used
  try {
    (void)radiosity::LightmapCharts(b.result.field, wanted, 16);
    ADD_FAILURE() << "22 charts of at least 4 x 4 texels do not fit";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("32 has"), std::string::npos) << e.what();
  }
}

// A wall whose light rises slowly in the dark, 16 texels for a step of 8 bits: means over 16 x 16
// texels are right within a tenth of a step (rounded values would be half a step off), so nothing
// of bands is left, whatever a viewer's exposure makes of the picture. White and black stay exact.
TEST(Lightmap, DarkGradientsHaveNoBands) {
  if (!scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  constexpr int kSize = 256;
  const auto encoded = [](int x) { return 10.0 + x / 16.0; };  // steps of 8-bit sRGB
  BakedModel model;
  model.atlas.width = model.atlas.height = kSize;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double v = std::pow((encoded(x) / 255.0 + 0.055) / 1.055, 2.4);
      const double exact = encoded(x) / 255.0 <= 0.04045 ? encoded(x) / 255.0 / 12.92 : v;
      model.atlas.radiance.push_back(Rgb(static_cast<float>(y == 0 ? x % 2 : exact)));
    }
  const test::Glb glb = test::parse_glb(encode(model, 1.0));
  const auto& view = glb.json.at("bufferViews").at(0);
  const auto first = glb.bin.begin() + view.value("byteOffset", std::ptrdiff_t{0});
  const material::Texture t = scene::decode_texture(
      {first, first + view.at("byteLength").get<std::ptrdiff_t>()}, "light.png");
  ASSERT_EQ(t.width, kSize);
  const auto channels = static_cast<std::size_t>(t.channels);
  const auto at = [&](int x, int y) {
    return t.pixels[static_cast<std::size_t>(y * kSize + x) * channels];
  };
  for (int x = 0; x < kSize; ++x) EXPECT_EQ(at(x, 0), x % 2 == 0 ? 0 : 255);
  double worst = 0.0;
  for (int block = 0; block < kSize; block += 16)
    for (int row = 16; row < kSize; row += 16) {
      double sum = 0.0, expected = 0.0;
      for (int x = block; x < block + 16; ++x)
        for (int y = row; y < row + 16; ++y) {
          sum += at(x, y) / 256.0;
          expected += encoded(x) / 256.0;
        }
      worst = std::max(worst, std::abs(sum - expected));
    }
  RecordProperty("worst_step", std::to_string(worst));
  EXPECT_LT(worst, 0.1);
}

// In the file itself: 16 bits of each, so COLOR_1 + COLOR_2 is COLOR_0 but for roundings of half a
// step each.
TEST(Bake, GroupsOfTheFileSumToTheWhole) {
  const double white = 60.0;
  const test::Glb glb = test::parse_glb(encode(plain().model({.group_light = true}), white));
  test::check_glb(glb);
  EXPECT_EQ(glb.json.at("asset").at("extras").at("atrium").at("light_groups").size(), 2U);
  double share = 0.0;
  for (const auto& mesh : glb.json.at("meshes")) {
    const auto& a = mesh.at("primitives").at(0).at("attributes");
    const auto c = [&](const char* name) { return glb.numbers(a.at(name)); };
    const std::vector<double> whole = c("COLOR_0"), one = c("COLOR_1"), two = c("COLOR_2");
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (i % 4 == 3) continue;  // alpha
      EXPECT_NEAR(one[i] + two[i], whole[i], 1.6 / 65535.0);
      share = std::max(share, two[i]);
    }
  }
  EXPECT_NEAR(share, 5.0 / white, 1e-4);
}

// Unlit viewers show none, so the file says what was left out.
TEST(Bake, GlossIsNamed) {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  material::Material lacquer = test::diffuse(0.4);
  lacquer.k_df = 0.8;
  lacquer.k_rg = 0.2;
  lacquer.n = 1.5;
  lacquer.c = 25.0;
  maker.room({0, 0, 0}, {2, 2, 2}, {wall, maker.material(lacquer), wall, wall, wall, wall});
  maker.point_light({0.5, 1, 1}, 10.0);
  const test::Solved s(maker.take(), {.max_elements = 300});
  const test::Glb glb = test::parse_glb(encode(
      bake(s.scene, s.result.elements, s.result.field, material::SpectralBasis::grey()), 1.0));
  int glossy = 0;
  for (const auto& m : glb.json.at("materials")) {
    EXPECT_TRUE(m.at("extensions").contains("KHR_materials_unlit"));
    const double roughness = m.at("pbrMetallicRoughness").at("roughnessFactor");
    if (!m.contains("extras")) {
      EXPECT_NEAR(roughness, 0.9, 1e-6);
      continue;
    }
    ++glossy;
    EXPECT_NEAR(roughness, 0.2, 1e-6);  // 1 / sqrt(25)
    const auto& lobe = m.at("extras").at("atrium");
    EXPECT_NEAR(lobe.at("lobe_reflectance").at(0).get<double>(), 0.2 * 0.04, 1e-5);
    EXPECT_NEAR(lobe.at("lobe_roughness").get<double>(), 0.2, 1e-6);
  }
  EXPECT_EQ(glossy, 1);
}

// What viewers draw beside a mesh: all that has no elements, each object by itself, and the sky.
TEST(BakePlain, IsWhatHasNoElements) {
  const scene::Scene s = room(false);
  std::vector<std::uint8_t> with(s.objects.size(), 1);
  with.back() = 0;
  const BakedModel lamp = radiosity::bake_plain(s, kRgb, with, plain().result.groups);
  ASSERT_EQ(lamp.primitives.size(), 1U);
  EXPECT_EQ(lamp.primitives[0].name, s.objects.back().name);
  ASSERT_EQ(lamp.primitives[0].groups.size(), 2U);
  EXPECT_NEAR(lamp.primitives[0].groups[0][0].radiance[0], 0.0f, 1e-6f);
  EXPECT_NEAR(lamp.primitives[0].groups[1][0].radiance[0], 5.0f, 1e-4f);
  EXPECT_EQ(lamp.origin, s.origin);
  EXPECT_THROW((void)radiosity::bake_plain(s, kRgb, {}), std::invalid_argument);
}

// Groups of the page sum to the whole within the steps of 0.4 %.
TEST(Bake, GroupsOfThePageSumToTheWhole) {
  const BakedModel model = plain().model({.group_light = true});
  double largest = 0.0;
  for (const auto& p : model.primitives)
    for (std::size_t i = 0; i < p.radiance.size(); ++i) {
      ASSERT_EQ(p.groups.size(), 2U);
      const double sum =
          static_cast<double>((p.groups[0][i].radiance + p.groups[1][i].radiance)[0]);
      const double whole = static_cast<double>(p.radiance[i][0]);
      EXPECT_NEAR(sum, whole, 1e-5 * whole + 1e-7);
      largest = std::max(largest, static_cast<double>(p.groups[1][i].radiance[0]));
    }
  EXPECT_NEAR(largest, 5.0, 1e-4);
}

// Mirrors and panes are what they are; nothing is lost on the way through a file.
TEST(Bake, MirrorsAndPanesKeepTheirKind) {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  material::Material mirror;
  mirror.k_df = 0.0;
  mirror.k_rg = 1.0;
  mirror.n = 0.2;
  mirror.kappa = 15.0;
  material::Material pane;
  pane.medium = material::Material::Medium::Pane;
  pane.k_df = 0.0;
  pane.k_rg = 1.0;
  pane.k_tp_rg = 1.0;
  pane.n = 1.5;
  maker.room({0, 0, 0}, {2, 2, 2}, {wall, maker.material(mirror), wall, wall, wall, wall});
  maker.quad(maker.material(pane), {1, 0, 0}, {1, 2, 0}, {1, 2, 2}, {1, 0, 2});
  maker.point_light({0.5, 1, 1}, 10.0);
  const test::Solved s(maker.take(), {.max_elements = 300});
  const BakedModel model =
      bake(s.scene, s.result.elements, s.result.field, material::SpectralBasis::grey(), {}, {});
  std::map<Kind, int> kinds;
  for (const auto& p : model.primitives) {
    const BakedModel::Material& m = model.materials[p.material];
    ++kinds[m.kind];
    if (m.kind == Kind::Metal) {
      EXPECT_NEAR(m.color[0], 0.96, 0.05);
    }
    if (m.kind == Kind::Glass) {
      EXPECT_NEAR(m.color[0], 0.92, 0.03);
    }
    EXPECT_EQ(p.normals.empty(), m.kind == Kind::Unlit);
  }
  EXPECT_EQ(kinds[Kind::Metal], 1);
  EXPECT_EQ(kinds[Kind::Glass], 1);
  EXPECT_EQ(kinds[Kind::Unlit], 5);
  test::check_glb(test::parse_glb(encode(model, 1.0)));
}

// Fans from any corner would pass corners in the middle of an edge over.
TEST(TriangulatePolygon, KeepsEveryCornerAndTheArea) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(0.1f, 0.9f);
  for (int round = 0; round < 200; ++round) {
    std::vector<Vec3f> p;
    const std::array<Vec3f, 4> square{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0),
                                      Vec3f(0, 1, 0)};
    for (std::size_t k = 0; k < 4; ++k) {
      p.push_back(square[k]);
      if ((round >> k & 1) != 0) {
        const float t = place(random);
        p.push_back((1 - t) * square[k] + t * square[(k + 1) % 4]);
      }
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    radiosity::triangulate_polygon(p, triangles);
    ASSERT_EQ(triangles.size(), p.size() - 2);
    float area = 0.0f;
    for (const auto& t : triangles) {
      const Vec3f n = 0.5f * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
      EXPECT_GT(n.z(), 1e-3f);
      area += n.z();
    }
    EXPECT_NEAR(area, 1.0f, 1e-5f);
  }
}

// A stored field has no pieces: they are cut anew, the same ones where no wall divides triangles.
TEST(ElementsOfField, AreThoseOfTheSolve) {
  const Baked& b = plain();
  const radiosity::Elements again = radiosity::elements_of_field(b.scene, b.result.field);
  const radiosity::Elements& once = b.result.elements;
  ASSERT_EQ(again.layout.element_count(), once.layout.element_count());
  ASSERT_GT(*std::max_element(once.layout.element_level.begin(), once.layout.element_level.end()),
            0);
  for (std::size_t e = 0; e < once.layout.element_count(); ++e) {
    double areas[2] = {0.0, 0.0};
    for (std::uint32_t p = once.first_piece[e]; p < once.first_piece[e + 1]; ++p)
      areas[0] += static_cast<double>(once.pieces[p].area);
    for (std::uint32_t p = again.first_piece[e]; p < again.first_piece[e + 1]; ++p) {
      areas[1] += static_cast<double>(again.pieces[p].area);
      EXPECT_EQ(again.pieces[p].object, once.pieces[once.first_piece[e]].object);
    }
    EXPECT_NEAR(areas[0], areas[1], 1e-5 * areas[0] + 1e-9);
  }
  const scene::Scene other = test::SceneMaker().take();
  EXPECT_THROW((void)radiosity::elements_of_field(other, b.result.field), std::invalid_argument);
}

}  // namespace
