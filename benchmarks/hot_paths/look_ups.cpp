// What a ray costs that reads the solved field where it ends.
#include <benchmark/benchmark.h>

#include "building.h"
#include "hot_paths.h"
#include "radiosity/solve.h"
#include "ray_sets.h"

namespace atrium::bench {
namespace {

constexpr int kLanes = 3;

/// A building solved roughly, and places on its surfaces in no order.
struct Solved {
  Solved() {
    const RaySets sets = make_rays(query, {0.8, 0.8, 1.6}, {4.0, 3.0, 0.8});
    for (const scene::Hit& hit : hits_of(query, sets.incoherent))
      points.push_back(scene::surface_point(scene, hit));
    for (const scene::SurfacePoint& p : points)
      spots.push_back(field.spot(scene, p.object, p.triangle, p.position));
  }
  scene::Scene scene = make_building();
  scene::RayQuery query{scene};
  scene::SurfaceField field =
      radiosity::solve(
          query, material::SpectralBasis::rgb(),
          {.max_elements = 60000, .row_rays = 16, .gather_rays = 0, .direct_samples = 2})
          .field;
  std::vector<scene::SurfacePoint> points;
  std::vector<scene::SurfaceField::Spot> spots;
};
const Solved& solved() {
  static const Solved s;
  return s;
}

template <class LookUp>
void add(const char* name, const LookUp& look_up) {
  benchmark::RegisterBenchmark(name, [look_up](benchmark::State& state) {
    const Solved& s = solved();
    std::size_t i = 0;
    for (auto _ : state) {
      auto value = look_up(s, i);
      benchmark::DoNotOptimize(value);
      if (++i == s.points.size()) i = 0;
    }
    state.SetItemsProcessed(state.iterations());
  });
}

}  // namespace

void register_look_ups() {
  add("field/place of a point", [](const Solved& s, std::size_t i) {
    const scene::SurfacePoint& p = s.points[i];
    return s.field.spot(s.scene, p.object, p.triangle, p.position);
  });
  add("field/value of the element, 3 lanes", [](const Solved& s, std::size_t i) {
    return s.spots[i].element == scene::SurfaceField::kNone
               ? Spectrum<kLanes>()
               : s.field.value<kLanes>(s.field.irradiance.indirect, s.spots[i].element,
                                       scene::Side::Front);
  });
  add("field/weights of interpolation", [](const Solved& s, std::size_t i) {
    return s.field.stencil(s.spots[i], scene::Side::Front);
  });
  add("field/all of it, interpolated, 3 lanes", [](const Solved& s, std::size_t i) {
    const scene::SurfacePoint& p = s.points[i];
    const auto spot = s.field.spot(s.scene, p.object, p.triangle, p.position);
    return s.field.interpolate<kLanes>(
        s.field.irradiance.indirect, s.field.stencil(spot, scene::Side::Front), scene::Side::Front);
  });
}

}  // namespace atrium::bench
