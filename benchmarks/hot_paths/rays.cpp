// Rays by kind through scene::RayQuery and scene::Shading, and the same rays through Embree alone.
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "bare_embree.h"
#include "building.h"
#include "hot_paths.h"
#include "ray_sets.h"
#include "scene/scene_io.h"
#include "scene/shading.h"

namespace atrium::bench {
namespace {

using scene::Counter;
using scene::Counters;
using scene::Hit;
using scene::Ray;

/// A scene with everything that answers rays; made when a benchmark of it first runs.
struct Stage {
  explicit Stage(scene::Scene made, const Vec3d& eye, const Vec3d& target)
      : scene(std::move(made)), sets(make_rays(query, eye, target)) {}
  scene::Scene scene;
  scene::RayQuery query{scene};
  BareEmbree bare{scene};
  scene::Shading<3> shading{query, material::SpectralBasis::rgb()};
  RaySets sets;
};

/// A room of a building of diffuse surfaces.
const Stage& building() {
  static const Stage stage(make_building(), {0.8, 0.8, 1.6}, {4.0, 3.0, 0.8});
  return stage;
}

/// A hall under panes, trees and chairs as instances.
const Stage& atrium_hall() {
  const std::filesystem::path file =
      std::filesystem::path(ATRIUM_SOURCE_DIR) / "scenes/benchmark/daylit_atrium.yaml";
  static const Stage stage = [&] {
    scene::Scene made = scene::build_scene(scene::read_model({file}));
    const Eigen::Affine3d camera = made.cameras.at(0).to_scene;
    const Vec3d eye = camera.translation() + made.origin;
    return Stage(std::move(made), eye, eye - camera.linear().col(2));
  }();
  return stage;
}

using Rays = std::vector<Ray>;
using Trace = std::function<std::size_t(const Stage&, const Rays&)>;

/// Rays for which found(ray, counters) is true.
template <class Found>
std::size_t count(const Rays& rays, Found&& found) {
  Counters counters;
  std::size_t hits = 0;
  for (const Ray& r : rays) hits += found(r, counters) ? 1U : 0U;
  return hits;
}
std::size_t closest(const Stage& s, const Rays& rays) {
  return count(rays, [&](const Ray& r, Counters& c) {
    return s.query.closest(r, c, Counter::RaysGather).has_value();
  });
}
std::size_t occluded(const Stage& s, const Rays& rays) {
  return count(
      rays, [&](const Ray& r, Counters& c) { return s.query.occluded(r, c, Counter::RaysShadow); });
}
std::size_t surfaces(const Stage& s, const Rays& rays) {
  return count(rays, [&](const Ray& r, Counters& c) {
    return s.shading.closest(r, c, Counter::RaysGather).has_value();
  });
}
std::size_t transmittance(const Stage& s, const Rays& rays) {
  return count(rays, [&](const Ray& r, Counters& c) {
    return s.shading.transmittance(r, c, Counter::RaysShadow).is_zero();
  });
}
std::size_t closest_of_many(const Stage& s, const Rays& rays) {
  Counters counters;
  std::vector<Hit> hits(kRaysOfAPoint);
  std::size_t found = 0;
  for (std::size_t first = 0; first < rays.size(); first += hits.size()) {
    const std::span<const Ray> some(rays.data() + first, hits.size());
    s.query.closest(some, hits, counters, Counter::RaysGather);
    for (const Hit& h : hits) found += h.found() ? 1U : 0U;
  }
  return found;
}
void add(const std::string& name, const Stage& (*stage)(), Rays RaySets::*rays,
         const Trace& trace) {
  benchmark::RegisterBenchmark(("rays/" + name).c_str(), [=](benchmark::State& state) {
    const Stage& s = stage();
    for (auto _ : state) {
      std::size_t hits = trace(s, s.sets.*rays);
      benchmark::DoNotOptimize(hits);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>((s.sets.*rays).size()));
  })->Unit(benchmark::kMillisecond);
}

void add_closest(const std::string& kind, const Stage& (*stage)(), Rays RaySets::*rays) {
  add(kind + "/bare rtcIntersect1", stage, rays,
      [](const Stage& s, const Rays& r) { return s.bare.single(r); });
  add(kind + "/bare rtcIntersect8", stage, rays,
      [](const Stage& s, const Rays& r) { return s.bare.packets(r, kRaysOfAPoint); });
  add(kind + "/bare rtcIntersect1M", stage, rays,
      [](const Stage& s, const Rays& r) { return s.bare.stream(r, kRaysOfAPoint); });
  add(kind + "/RayQuery, one by one", stage, rays, closest);
  add(kind + "/RayQuery, many at once", stage, rays, closest_of_many);
  add(kind + "/Shading, surface points", stage, rays, surfaces);
}

void add_shadow(const std::string& kind, const Stage& (*stage)()) {
  add(kind + "/bare rtcOccluded1", stage, &RaySets::shadow,
      [](const Stage& s, const Rays& r) { return s.bare.occluded(r, scene::kOpaque); });
  add(kind + "/RayQuery", stage, &RaySets::shadow, occluded);
  add(kind + "/Shading, through panes", stage, &RaySets::shadow, transmittance);
}

}  // namespace

void register_rays() {
  add_closest("building, camera", building, &RaySets::camera);
  add_closest("building, 64 of a point", building, &RaySets::hemisphere);
  add_closest("building, incoherent", building, &RaySets::incoherent);
  add_shadow("building, shadow", building);
  add_closest("daylit_atrium, camera", atrium_hall, &RaySets::camera);
  add_closest("daylit_atrium, incoherent", atrium_hall, &RaySets::incoherent);
  add_shadow("daylit_atrium, shadow", atrium_hall);
}

}  // namespace atrium::bench
