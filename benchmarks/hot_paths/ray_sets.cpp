#include "ray_sets.h"

#include <algorithm>
#include <random>

#include "scene/camera.h"
#include "scene/segment.h"

namespace atrium::bench {
namespace {

using scene::Counter;
using scene::Counters;
using scene::Hit;
using scene::Ray;
using scene::SurfacePoint;

struct Random {
  std::mt19937 engine{1};
  std::uniform_real_distribution<float> uniform{0.0f, 1.0f};
  Vec2f pair() {
    const float u = uniform(engine);
    return {u, uniform(engine)};
  }
};

std::vector<Ray> camera_rays(const Vec3d& eye, const Vec3d& target) {
  constexpr int kSize = 256, kTile = 8;
  static_assert(kSize * kSize == kRays);
  scene::Camera camera;
  camera.to_scene = scene::look_at(eye, target, Vec3d::UnitZ());
  camera.yfov = 1.2;
  std::vector<Ray> rays;
  for (int tile = 0; tile < (kSize / kTile) * (kSize / kTile); ++tile)
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = tile % (kSize / kTile) * kTile + i % kTile;
      const int y = tile / (kSize / kTile) * kTile + i / kTile;
      const auto r = camera.ray({(x + 0.5) / kSize, (y + 0.5) / kSize}, 1.0);
      rays.push_back({r.origin, r.direction});
    }
  return rays;
}

/// A ray by the cosine on the side that `from` comes from.
Ray hemisphere_ray(const SurfacePoint& p, const Vec3f& from, Random& random) {
  const Vec3f normal = p.ng.dot(from) < 0.0f ? p.ng : Vec3f(-p.ng);
  const Vec3f d = Frame(normal).to_world(sample_cosine_hemisphere(random.pair()));
  return {scene::offset_origin(p, d), d};
}

struct Seen {
  SurfacePoint point;
  Vec3f direction;  ///< of the ray that saw it
};
std::vector<Seen> seen_by(const scene::RayQuery& query, const std::vector<Ray>& rays) {
  Counters counters;
  std::vector<Seen> seen;
  for (const Ray& ray : rays)
    if (const auto hit = query.closest(ray, counters, Counter::RaysPrimary))
      seen.push_back({scene::surface_point(query.scene(), *hit), ray.direction});
  return seen;
}

}  // namespace

RaySets make_rays(const scene::RayQuery& query, const Vec3d& eye, const Vec3d& target) {
  Random random;
  RaySets sets;
  const Vec3d shift = query.scene().origin;
  sets.camera = camera_rays(eye - shift, target - shift);
  const std::vector<Seen> seen = seen_by(query, sets.camera);
  // Two bounces on, points are all over the place.
  std::vector<Ray> once;
  for (const Seen& s : seen) once.push_back(hemisphere_ray(s.point, s.direction, random));
  std::vector<Seen> far = seen_by(query, once);
  std::shuffle(far.begin(), far.end(), random.engine);
  for (std::size_t i = 0; i < kRays; ++i) {
    const Seen& one = far[i % far.size()];
    sets.incoherent.push_back(hemisphere_ray(one.point, one.direction, random));
    const Seen& point = far[i / kRaysOfAPoint];
    sets.hemisphere.push_back(hemisphere_ray(point.point, point.direction, random));
    sets.shadow.push_back(scene::segment(seen[i % seen.size()].point, one.point));
  }
  return sets;
}

std::vector<Hit> hits_of(const scene::RayQuery& query, const std::vector<Ray>& rays) {
  Counters counters;
  std::vector<Hit> hits;
  for (const Ray& ray : rays)
    if (const auto hit = query.closest(ray, counters, Counter::RaysGather)) hits.push_back(*hit);
  return hits;
}

}  // namespace atrium::bench
