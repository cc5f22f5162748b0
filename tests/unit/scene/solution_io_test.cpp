#include "scene/solution_io.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "material/error.h"
#include "support/temp_folder.h"

namespace {

using atrium::Error;
using atrium::scene::hash_scene;
using atrium::scene::read_solution;
using atrium::scene::Scene;
using atrium::scene::Solution;
using atrium::scene::SurfaceField;
using atrium::scene::write_solution;
using atrium::test::TempFolder;

/// Two facets of 2x1 cells, three elements, three lanes. One cell is empty, one has a single
/// occupied child.
Solution sample_solution() {
  Solution s;
  s.scene_hash = 0x0123456789abcdefULL;
  s.basis = "3 RGB lanes";
  s.state = {'a', '\0', 'b'};
  s.options = "solver rows";
  SurfaceField& f = s.field;
  f.lanes = 3;
  f.unit = "lx";
  f.facets.resize(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    f.facets[i].origin = atrium::Vec3f(1.0f, 2.0f, static_cast<float>(i));
    f.facets[i].axis_u = atrium::Vec3f::UnitX();
    f.facets[i].axis_v = atrium::Vec3f::UnitY();
    f.facets[i].nx = 2;
    f.facets[i].ny = 1;
    f.facets[i].first_cell = 2 * i;
  }
  constexpr std::uint32_t kNone = SurfaceField::kNone;
  f.nodes = {0, 1, SurfaceField::kInner | 4U, kNone, kNone, 2, kNone, kNone};
  f.triangle_facet = {0, SurfaceField::kCut | 0, kNone};
  f.cuts = {{{1, 2, 3}, {0, 1, 0}, {1, SurfaceField::kCut | 1}},
            {{4, 5, 6}, {1, 0, 0}, {kNone, 0}}};
  f.element_facet = {0, 0, 1};
  f.element_level = {0, 0, 1};
  f.element_x = {0, 1, 1};
  f.element_y = {0, 0, 0};
  f.element_area = {1.0f, 0.5f, 0.25f};
  for (int i = 0; i < 18; ++i) f.irradiance.direct.push_back(static_cast<float>(i));
  f.irradiance.indirect.assign(18, 7.0f);
  f.standard_error.assign(6, 0.1f);
  f.valid.assign(6, 1);
  return s;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SolutionIo, RoundTrip) {
  const TempFolder folder;
  const Solution a = sample_solution();
  write_solution(a, folder / "a.atrium");
  const Solution b = read_solution(folder / "a.atrium");
  EXPECT_EQ(a.scene_hash, b.scene_hash);
  EXPECT_EQ(a.basis, b.basis);
  EXPECT_EQ(a.options, b.options);
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.field.unit, b.field.unit);
  EXPECT_EQ(a.field.nodes, b.field.nodes);
  EXPECT_EQ(a.field.element_level, b.field.element_level);
  EXPECT_EQ(a.field.irradiance.direct, b.field.irradiance.direct);
  EXPECT_TRUE(b.field.irradiance.caustic.empty());
  EXPECT_EQ(a.field.valid, b.field.valid);
  EXPECT_EQ(a.field.facets[1].origin, b.field.facets[1].origin);
  // Written again the file is the same: nothing was lost.
  write_solution(b, folder / "b.atrium");
  EXPECT_EQ(bytes_of(folder / "a.atrium"), bytes_of(folder / "b.atrium"));
}

TEST(SolutionIo, EveryTruncationIsAnError) {
  const TempFolder folder;
  write_solution(sample_solution(), folder / "a.atrium");
  const std::string whole = bytes_of(folder / "a.atrium");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    folder.write("cut.atrium", whole.substr(0, size));
    EXPECT_THROW((void)read_solution(folder / "cut.atrium"), Error) << size;
  }
}

TEST(SolutionIo, EveryChangedByteIsAnError) {
  const TempFolder folder;
  write_solution(sample_solution(), folder / "a.atrium");
  const std::string whole = bytes_of(folder / "a.atrium");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 0x40);
    folder.write("bad.atrium", changed);
    EXPECT_THROW((void)read_solution(folder / "bad.atrium"), Error) << i;
  }
}

// The checksum is right here: what is refused is the content.
TEST(SolutionIo, IndicesOutOfRangeAreErrors) {
  const TempFolder folder;
  const auto refused = [&](auto&& change) {
    Solution s = sample_solution();
    change(s.field);
    write_solution(s, folder / "a.atrium");
    EXPECT_THROW((void)read_solution(folder / "a.atrium"), Error);
  };
  refused([](SurfaceField& f) { f.nodes[0] = 3; });
  refused([](SurfaceField& f) { f.nodes[2] = SurfaceField::kInner | 5U; });  // past the end
  refused([](SurfaceField& f) { f.nodes[5] = SurfaceField::kInner | 4U; });  // backwards
  refused([](SurfaceField& f) { f.nodes[3] = SurfaceField::kInner | 4U; });  // two parents
  refused([](SurfaceField& f) { f.element_level[2] = 0; });                  // not where it is
  refused([](SurfaceField& f) { f.element_level[2] = 13; });
  refused([](SurfaceField& f) { f.element_x[1] = 2; });
  refused([](SurfaceField& f) { f.element_facet[0] = 7; });
  refused([](SurfaceField& f) { f.triangle_facet[0] = 2; });
  refused([](SurfaceField& f) { f.triangle_facet[0] = SurfaceField::kCut | 2; });
  refused(
      [](SurfaceField& f) { f.cuts[1].child[0] = SurfaceField::kCut | 1; });  // round in circles
  refused([](SurfaceField& f) { f.cuts[0].child[0] = 2; });
  refused([](SurfaceField& f) { f.facets[1].first_cell = 7; });
  refused([](SurfaceField& f) { f.facets[1].nx = 0; });
  refused([](SurfaceField& f) { f.irradiance.direct.pop_back(); });
  refused([](SurfaceField& f) { f.lanes = 5; });
}

TEST(HashScene, SeesGeometryMaterialsAndLights) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.meshes[0].triangles = {{0, 1, 2}};
  scene.objects.resize(1);
  scene.materials.resize(1);
  scene.lights.resize(1);
  const std::uint64_t base = hash_scene(scene);
  const auto changed = [&](auto&& change) {
    Scene other = scene;
    change(other);
    return hash_scene(other) != base;
  };
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].positions[1].x() = 1.0000001f; }));
  EXPECT_TRUE(changed([](Scene& s) { s.materials[0].k_df = 0.999; }));
  EXPECT_TRUE(changed([](Scene& s) { s.materials[0].emission = atrium::make_rgb(0, 0, 1); }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].to_scene.translation().z() = 1.0; }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].kind = atrium::scene::SpotLight{}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.environment.emplace(); }));
  std::set<std::uint64_t> skies;
  const auto add_sky = [&](int type, const atrium::Vec3d& sun, double ground) {
    Scene other = scene;
    other.environment.emplace().pattern =
        atrium::scene::SkyDome(atrium::scene::cie_sky(type), sun, ground);
    skies.insert(hash_scene(other));
  };
  const atrium::Vec3d up = atrium::Vec3d::UnitY(), side = atrium::Vec3d(1, 1, 0).normalized();
  add_sky(12, up, 0.2);
  add_sky(12, up, 0.3);
  add_sky(12, side, 0.2);
  add_sky(13, up, 0.2);
  add_sky(16, up, 0.2);
  EXPECT_EQ(skies.size(), 5u);
  EXPECT_TRUE(changed([](Scene& s) { s.medium_extinction = 0.1; }));
  EXPECT_FALSE(changed([](Scene& s) { s.meshes[0].name = "renamed"; }));
}

TEST(HashParts, SayWhatDiffers) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].medium = atrium::material::Material::Medium::Opaque;
  scene.materials[0].k_df = 1.0;
  scene.materials[0].k_rg = 0.0;
  scene.materials[0].body_reflectance = 0.5;
  scene.lights.resize(1);
  const atrium::scene::SceneHashes base = atrium::scene::hash_parts(scene);
  const auto changed = [&](auto&& change) {
    Scene other = scene;
    change(other);
    EXPECT_NE(hash_scene(other), hash_scene(scene));
    const atrium::scene::SceneHashes h = atrium::scene::hash_parts(other);
    std::string parts;
    if (h.geometry != base.geometry) parts += "g";
    if (h.materials != base.materials) parts += "m";
    if (h.reflectance != base.reflectance) parts += "r";
    if (h.lights != base.lights) parts += "l";
    if (h.emission != base.emission) parts += "e";
    return parts;
  };
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].body_reflectance = 0.4; }), "r");
  // Then there is no diffuse surface any more.
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].body_reflectance = 0.0; }), "mr");
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].emission = 1.0; }), "e");
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].one_sided = true; }), "m");
  EXPECT_EQ(changed([](Scene& s) { s.lights[0].to_scene.translation().x() += 1.0; }), "l");
  EXPECT_EQ(changed([](Scene& s) { s.lights.clear(); }), "l");
  EXPECT_EQ(changed([](Scene& s) { s.environment.emplace(); }), "e");
  EXPECT_EQ(changed([](Scene& s) { s.medium_extinction = 0.1; }), "m");
  EXPECT_EQ(changed([](Scene& s) { s.objects.emplace_back(); }), "g");
}

}  // namespace
