#include "scene/light_groups.h"

#include <cmath>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/light_sampler.h"
#include "scene/scene_io.h"
#include "scene/solution_io.h"
#include "support/temp_folder.h"

namespace {

using namespace atrium;
using scene::find_light_groups;
using scene::GroupField;
using scene::Grouping;
using scene::LightGroups;
using scene::SurfaceField;

constexpr const char* kScene = R"(atrium: 1
materials:
  white: {body: 0.5}
  lamp: {body: 0, emission: 100}
objects:
  - {name: floor, box: {size: [4, 0.1, 4]}, material: white}
  - {name: panel, box: {size: [1, 0.1, 1]}, material: lamp, translate: [0, 3, 0], light_group: north}
  - {name: panel, box: {size: [1, 0.1, 1]}, material: lamp, translate: [2, 3, 0]}
lights:
  - {name: desk, point: {position: [0, 1, 0], intensity: 10}, repeat: {count: 3, step: [1, 0, 0]}}
  - {name: desk, point: {position: [0, 1, 1], intensity: 10}, light_group: north}
environment: {radiance: 1, light_group: day}
sun: {azimuth: 180, elevation: 40, irradiance: 100}
)";

scene::Scene load(const std::string& yaml) {
  const test::TempFolder folder;
  folder.write("s.yaml", yaml);
  return scene::build_scene(scene::read_model({folder / "s.yaml"}, {}));
}

std::string group_of(const LightGroups& groups, std::uint32_t source) {
  return groups.names.at(groups.group.at(source));
}

TEST(LightGroups, DeclaredByNameOrOne) {
  const scene::Scene s = load(kScene);
  ASSERT_EQ(s.lights.size(), 5u);
  EXPECT_EQ(find_light_groups(s, Grouping::One).names, std::vector<std::string>{"all"});

  const LightGroups declared = find_light_groups(s, Grouping::Declared);
  EXPECT_EQ(declared.names, (std::vector<std::string>{"other", "north", "day"}));
  EXPECT_EQ(group_of(declared, 3), "north");
  EXPECT_EQ(group_of(declared, environment_source(s)), "day");

  const LightGroups named = find_light_groups(s, Grouping::ByName);
  EXPECT_EQ(named.names, (std::vector<std::string>{"desk", "north", "sun", "panel", "day"}));
  for (const std::uint32_t i : {0u, 1u, 2u}) EXPECT_EQ(group_of(named, i), "desk");
  int panels = 0;
  for (std::size_t o = 0; o < s.objects.size(); ++o)
    if (s.objects[o].name == "panel") {
      const std::string group = group_of(named, light_source(s, scene::ObjectId(o)));
      EXPECT_EQ(group, panels++ == 0 ? "north" : "panel");
    }
  EXPECT_EQ(panels, 2);

  scene::Scene bare = s;
  for (scene::Light& light : bare.lights) light.light_group.clear();
  for (scene::Object& object : bare.objects) object.light_group.clear();
  bare.environment->light_group.clear();
  EXPECT_EQ(find_light_groups(bare, Grouping::Declared).names, std::vector<std::string>{"all"});
  for (std::size_t i = 0; i <= scene::kMostLightGroups; ++i) {
    bare.lights.push_back(bare.lights[0]);
    bare.lights.back().name = std::to_string(i);
  }
  EXPECT_THROW((void)find_light_groups(bare, Grouping::ByName), Error);
}

// Whoever sends a sample is who would send it alone: in a scene of that source only, the radiance
// of the same direction is the same.
TEST(LightGroups, SamplesKnowTheirSource) {
  scene::Scene s = load(kScene);
  std::get<scene::DirectionalLight>(s.lights[4].kind).angular_radius = 0.3f;
  const auto basis = material::SpectralBasis::grey();
  const scene::LightSampler<1> all(s, basis);
  const Vec3f p(0.3f, 0.5f, 0.2f);
  std::vector<int> seen(environment_source(s) + 1, 0);
  double before_sun = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / 4000.0f;
    const Vec2f u(std::fmod(c * 77.7f, 1.0f), std::fmod(c * 1234.5f, 1.0f));
    const auto sample = all.sample(p, Vec3f::Zero(), c, u);
    if (!sample) continue;
    ++seen[sample->source];
    if (sample->source < s.lights.size()) {
      EXPECT_NEAR((s.lights[sample->source].to_scene.translation().cast<float>() - p).norm(),
                  sample->distance, 1e-5);
    }
    if (sample->source != environment_source(s)) continue;
    Spectrum<1> sum;
    double parts = 0.0;
    all.sky_parts(*sample, [&](std::uint32_t source, const Spectrum<1>& radiance) {
      sum += radiance;
      parts += 1.0;
      EXPECT_TRUE(source == 4 || source == environment_source(s));
    });
    EXPECT_FLOAT_EQ(sum[0], sample->radiance[0]);
    before_sun += parts - 1.0;
  }
  EXPECT_GT(before_sun, 0.0);
  for (const std::uint32_t i : {0u, 1u, 2u, 3u}) EXPECT_GT(seen[i], 0) << i;
  std::vector<int> emitted(seen.size(), 0);
  for (int i = 0; i < 4000; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / 4000.0f;
    const auto e = all.sample_emission(c, {0.3f, 0.4f}, {0.6f, 0.7f});
    if (e) ++emitted[e->source];
  }
  for (const std::uint32_t i : {0u, 3u, 4u, environment_source(s)}) EXPECT_GT(emitted[i], 0) << i;
}

/// One element, two groups.
scene::Solution two_groups() {
  scene::Solution s;
  s.field.lanes = 1;
  s.field.facets.resize(1);
  s.field.facets[0].nx = s.field.facets[0].ny = 1;
  s.field.facets[0].origin = Vec3f::Zero();
  s.field.facets[0].axis_u = Vec3f::UnitX();
  s.field.facets[0].axis_v = Vec3f::UnitY();
  s.field.valid = {1, 1};
  s.field.nodes = {0};
  s.field.triangle_facet = {0};
  s.field.element_facet = {0};
  s.field.element_level = {0};
  s.field.element_x = s.field.element_y = {0};
  s.field.element_area = {1.0f};
  s.groups.resize(2);
  s.groups[0] = {"a", 1.0, {{1.0f, 2.0f}, {}, {3.0f, 4.0f}}, {}, {0.3f, 0.0f}, {0.1f, 0.0f}};
  s.groups[1] = {"b", 1.0,          {{5.0f, 6.0f}, {7.0f, 8.0f}, {0.0f, 1.0f}},
                 {},  {0.4f, 0.0f}, {0.2f, 0.0f}};
  s.field = reweight(s.field, s.groups, std::vector<double>{1.0, 1.0});
  return s;
}

TEST(Reweight, IsTheWeightedSumWithBoundsOfItsError) {
  const scene::Solution s = two_groups();
  const SurfaceField f = reweight(s.field, s.groups, std::vector<double>{2.0, 0.5});
  EXPECT_EQ(f.irradiance.direct, (std::vector<float>{4.5f, 7.0f}));
  EXPECT_EQ(f.irradiance.caustic, (std::vector<float>{3.5f, 4.0f}));
  EXPECT_EQ(f.irradiance.indirect, (std::vector<float>{6.0f, 8.5f}));
  EXPECT_FLOAT_EQ(f.standard_error[0], std::sqrt(0.36f + 0.04f + 0.09f));
  EXPECT_THROW((void)reweight(s.field, s.groups, std::vector<double>{1.0}), std::invalid_argument);
  EXPECT_THROW((void)reweight(s.field, s.groups, std::vector<double>{1.0, -1.0}),
               std::invalid_argument);
  EXPECT_THROW((void)reweight(s.field, s.groups, std::vector<double>{1.0, std::nan("")}),
               std::invalid_argument);
}

TEST(Reweight, FilesKeepGroupsAndFactors) {
  const test::TempFolder folder;
  scene::Solution s = two_groups();
  dim(s, {{"b", 0.0}});
  EXPECT_EQ(s.field.irradiance.direct, (std::vector<float>{1.0f, 2.0f}));
  write_solution(s, folder / "a.atrium");
  scene::Solution back = scene::read_solution(folder / "a.atrium");
  ASSERT_EQ(back.groups.size(), 2u);
  EXPECT_EQ(back.groups[1].name, "b");
  EXPECT_EQ(back.groups[1].factor, 0.0);
  EXPECT_EQ(back.groups[1].irradiance.caustic, s.groups[1].irradiance.caustic);
  EXPECT_EQ(back.groups[0].light_error, s.groups[0].light_error);
  dim(back, {{"b", 1.0}});  // of the light as it was solved, not of what is left
  EXPECT_EQ(back.field.irradiance.direct, two_groups().field.irradiance.direct);
  EXPECT_THROW(dim(back, {{"c", 1.0}}), Error);
  back.groups[1].name = "a";
  write_solution(back, folder / "b.atrium");
  EXPECT_THROW((void)scene::read_solution(folder / "b.atrium"), Error);
}

}  // namespace
