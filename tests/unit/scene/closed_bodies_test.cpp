#include "scene/closed_bodies.h"

#include <gtest/gtest.h>

#include "unit/radiosity/box_scene.h"

namespace atrium::scene {
namespace {

using Inside = std::vector<std::uint32_t>;

// Corner k of a box is (k & 1, k & 2, k & 4); wound outwards.
const std::vector<Triangle> kBox{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

std::vector<Vec3f> corners(const Vec3f& low, const Vec3f& high) {
  std::vector<Vec3f> p;
  for (int k = 0; k < 8; ++k)
    p.emplace_back((k & 1) != 0 ? high.x() : low.x(), (k & 2) != 0 ? high.y() : low.y(),
                   (k & 4) != 0 ? high.z() : low.z());
  return p;
}

Inside inside(const ClosedBodies& bodies, const Vec3f& p) {
  return bodies.containing(p, bodies.near(Eigen::AlignedBox3f(p)));
}

TEST(ClosedBodies, FindsThemWhateverTheWinding) {
  test::SceneMaker maker;
  const MaterialId m = maker.material(test::diffuse(0.5));
  maker.object(m, corners({0, 0, 0}, {2, 2, 2}), kBox);
  std::vector<Triangle> turned = kBox;
  for (Triangle& t : turned) std::swap(t[1], t[2]);
  maker.object(m, corners({1, 0, 0}, {3, 2, 2}), turned);  // overlaps the first
  std::vector<Triangle> mixed = kBox;
  for (std::size_t t = 0; t < 6; ++t) std::swap(mixed[t][1], mixed[t][2]);
  maker.object(m, corners({10, 0, 0}, {11, 1, 1}), mixed);
  const Scene scene = maker.take();
  const ClosedBodies bodies(scene);
  ASSERT_EQ(bodies.bodies().size(), 3U);
  EXPECT_NEAR(bodies.bodies()[0].volume, 8.0, 1e-5);
  EXPECT_NEAR(bodies.bodies()[1].volume, -8.0, 1e-5);
  EXPECT_EQ(bodies.bodies()[2].volume, 0.0);
  EXPECT_EQ(inside(bodies, {0.5f, 1, 1}), Inside({0}));
  EXPECT_EQ(inside(bodies, {1.5f, 1, 1}), Inside({0, 1}));
  EXPECT_EQ(inside(bodies, {2.5f, 1, 1}), Inside({1}));
  EXPECT_EQ(inside(bodies, {3.5f, 1, 1}), Inside());
  EXPECT_EQ(inside(bodies, {10.5f, 0.5f, 0.5f}), Inside({2}));
  EXPECT_EQ(inside(bodies, {1e-6f, 1, 1}), Inside({0}));
  EXPECT_EQ(inside(bodies, {-1e-6f, 1, 1}), Inside());
}

// The top is divided in the middle, the sides below it are not.
TEST(ClosedBodies, TJunctionsCloseBodiesPartByPart) {
  std::vector<Vec3f> p = corners({0, 0, 0}, {2, 2, 2});
  p.insert(p.end(), {{1, 0, 2}, {1, 2, 2}});
  std::vector<Triangle> t = kBox;
  t.erase(t.begin() + 2, t.begin() + 4);
  t.insert(t.end(), {{4, 8, 9}, {4, 9, 6}, {8, 5, 7}, {8, 7, 9}});
  for (const bool open : {false, true}) {
    if (open) t.pop_back();
    test::SceneMaker maker;
    maker.object(maker.material(test::diffuse(0.5)), p, t);
    const Scene scene = maker.take();
    const ClosedBodies bodies(scene);
    ASSERT_EQ(bodies.bodies().size(), open ? 0U : 1U);
    if (open) continue;
    EXPECT_NEAR(bodies.bodies()[0].volume, 8.0, 1e-5);
    EXPECT_EQ(inside(bodies, {0.7f, 1.1f, 0.9f}), Inside{0});
    EXPECT_EQ(inside(bodies, {0.7f, 1.1f, 2.1f}), Inside{});
  }
}

TEST(ClosedBodies, OpenOrTransparentOnesAreNone) {
  test::SceneMaker maker;
  const MaterialId wall = maker.material(test::diffuse(0.5));
  material::Material glass;
  glass.medium = material::Material::Medium::Solid;
  const MaterialId solid = maker.material(glass);
  std::vector<Triangle> open = kBox;
  open.pop_back();
  maker.object(wall, corners({0, 0, 0}, {1, 1, 1}), open);
  maker.object(solid, corners({2, 0, 0}, {3, 1, 1}), kBox);
  const Scene scene = maker.take();
  EXPECT_TRUE(ClosedBodies(scene).bodies().empty());
}

// One mesh of a shell and its cavity: the cavity is in both and so is no wall.
TEST(ClosedBodies, PartsOfOneMeshAndInstances) {
  test::SceneMaker maker;
  const MaterialId m = maker.material(test::diffuse(0.5));
  std::vector<Vec3f> p = corners({0, 0, 0}, {4, 4, 4});
  std::vector<Triangle> t = kBox;
  for (const Vec3f& v : corners({1, 1, 1}, {3, 3, 3})) p.push_back(v);
  for (const Triangle& b : kBox) t.push_back({b[0] + 8, b[2] + 8, b[1] + 8});
  maker.object(m, p, t);
  Scene scene = maker.take();
  Object copy = scene.objects[0];
  copy.instanced = true;
  copy.first_triangle = t.size();
  copy.to_scene.translation() = Vec3f(10, 0, 0);
  scene.objects.push_back(copy);
  const ClosedBodies bodies(scene);
  ASSERT_EQ(bodies.bodies().size(), 4U);
  EXPECT_EQ(inside(bodies, {0.5f, 2, 2}), Inside({0}));
  EXPECT_EQ(inside(bodies, {2, 2, 2}), Inside({0, 1}));
  EXPECT_EQ(inside(bodies, {10.5f, 2, 2}), Inside({2}));
  EXPECT_EQ(inside(bodies, {12, 2, 2}), Inside({2, 3}));
}

}  // namespace
}  // namespace atrium::scene
