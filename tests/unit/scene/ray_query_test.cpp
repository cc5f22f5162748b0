#include "scene/ray_query.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "scene/sampler.h"
#include "unit/radiosity/box_scene.h"

namespace atrium::scene {
namespace {

// A room with a sphere, and the sphere again as mirrored, stretched instances.
Scene instances() {
  test::SceneMaker maker;
  const auto m = maker.material(test::diffuse(0.5));
  maker.room({-5, -5, -5}, {5, 5, 5}, m);
  maker.sphere(m, 1.0f, 2, false);
  Scene scene = maker.take();
  for (const float x : {-3.0f, 3.0f}) {
    Object o = scene.objects.back();
    o.instanced = true;
    o.to_scene = Eigen::Translation3f(x, 1, 0) * Eigen::AngleAxisf(0.7f, Vec3f::UnitZ()) *
                 Eigen::Scaling(x < 0 ? -1.5f : 1.5f, 0.5f, 1.0f);
    o.first_triangle += scene.meshes[o.mesh.value].triangles.size();
    scene.objects.push_back(o);
  }
  return scene;
}

std::vector<Ray> rays_from_the_middle(int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Sampler sampler(1, 0, static_cast<std::uint32_t>(i));
    Vec3f d = sample_cosine_hemisphere(sampler.next_2d());
    if (i % 2 != 0) d = -d;
    rays.push_back({Vec3f(0, -2.5f, 0.3f), Vec3f(d.z(), d.x(), d.y())});
  }
  return rays;
}

// Hit::ng by the winding, as surface_point() makes it of the moved corners.
TEST(RayQuery, NormalOfAHitIsThatOfTheTriangle) {
  const Scene scene = instances();
  const RayQuery query(scene);
  Counters counters;
  int on_instances = 0;
  for (const Ray& ray : rays_from_the_middle(2000)) {
    const auto hit = query.closest(ray, counters, Counter::RaysProbe);
    ASSERT_TRUE(hit);
    const SurfacePoint point = surface_point(scene, *hit);
    EXPECT_NEAR(hit->ng.normalized().dot(point.ng), 1.0f, 1e-5f);
    on_instances += scene.objects[hit->object.value].instanced ? 1 : 0;
  }
  EXPECT_GT(on_instances, 20);
}

// A batch answers as its rays one by one; refused rays are misses and counted as such.
TEST(RayQuery, BatchesAnswerLikeSingleRays) {
  const Scene scene = instances();
  const RayQuery query(scene);
  std::vector<Ray> rays = rays_from_the_middle(150);
  rays[3].direction.x() = std::numeric_limits<float>::quiet_NaN();
  rays[70].origin.y() = 1e30f;
  rays[71].tmin = -1.0f;
  rays[80].tmax = 0.01f;  // ends before anything
  std::vector<Hit> hits(rays.size());
  Counters one, many;
  query.closest(rays, hits, many, Counter::RaysRow);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = query.closest(rays[i], one, Counter::RaysRow);
    ASSERT_EQ(hits[i].found(), hit.has_value()) << i;
    if (!hit) continue;
    EXPECT_EQ(hits[i].t, hit->t);
    EXPECT_EQ(hits[i].object, hit->object);
    EXPECT_EQ(hits[i].triangle, hit->triangle);
    EXPECT_EQ(hits[i].u, hit->u);
    EXPECT_EQ(hits[i].ng, hit->ng);
  }
  EXPECT_EQ(one.value, many.value);
  EXPECT_EQ(many[Counter::RaysRefused], 3U);
  EXPECT_EQ(many[Counter::RaysRow], 147U);
  EXPECT_FALSE(hits[80].found());
}

// The cross product of edges as they are over- or underflows at the ends of this range.
TEST(SurfacePoint, FacetsOfAnySizeHaveTheirNormal) {
  for (const float size : {1e-25f, 1e-18f, 1e-12f, 1e-6f, 1.0f, 1e6f, 1e12f, 1e18f})
    for (const float height : {1.0f, 1e-5f}) {
      test::SceneMaker maker;
      const auto m = maker.material(test::diffuse(0.5));
      maker.object(m, {{0, 0, 0}, {size, 0, 0}, {0.5f * size, height * size, 0}}, {{0, 1, 2}});
      const SurfacePoint p = surface_point(maker.take(), ObjectId(std::size_t{0}), 0, 0.3f, 0.3f);
      EXPECT_LT((p.ng - Vec3f::UnitZ()).norm(), 1e-6f) << size << ' ' << height;
    }
}

}  // namespace
}  // namespace atrium::scene
