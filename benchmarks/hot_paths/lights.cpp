// Choosing one of many lights for a point, by the hierarchy of LightSampler.
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "hot_paths.h"
#include "scene/light_sampler.h"
#include "support/scenes.h"

namespace atrium::bench {
namespace {

constexpr double kSide = 40.0, kHeight = 3.0;

/// A hall with `count` lamps of 10 cm in rows below its ceiling.
scene::Scene hall(int count) {
  testing::SceneMaker maker;
  maker.box(maker.diffuse(0.7), {0, 0, 0}, {kSide, kHeight, kSide}, true);
  const scene::MaterialId lamp = maker.diffuse(0.0, 100.0);
  const int across = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    const double step = kSide / across;
    const int column = i % across, row = i / across;
    maker.quad(lamp, {(column + 0.4) * step, kHeight - 0.1, (row + 0.4) * step},
               {0.1, 0, 0}, {0, 0, 0.1});
  }
  return scene::build_scene(maker.model());
}

struct Place {
  Vec3f position;
  Vec2f u;
  float choice;
};
std::vector<Place> places(const scene::Scene& scene) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const auto next = [&] { return uniform(random); };
  std::vector<Place> result;
  for (int i = 0; i < 4096; ++i) {
    const Vec3d p(kSide * static_cast<double>(next()), 0.5, kSide * static_cast<double>(next()));
    const Vec3f at = (p - scene.origin).cast<float>();
    const float x = next();
    result.push_back({at, {x, next()}, next()});
  }
  return result;
}

/// Density that another way of sampling asks for, of the lamp that the place's own sample found.
struct Found {
  Vec3f position;
  scene::SurfacePoint hit;
  float distance;
};

void run_sample(benchmark::State& state, int count) {
  const scene::Scene scene = hall(count);
  const scene::LightSampler<3> lights(scene, material::SpectralBasis::rgb());
  const std::vector<Place> all = places(scene);
  const Vec3f up = Vec3f::UnitY();
  std::size_t i = 0;
  for (auto _ : state) {
    const Place& p = all[i++ & 4095U];
    auto sample = lights.sample(p.position, up, p.choice, p.u);
    benchmark::DoNotOptimize(sample);
  }
  state.SetItemsProcessed(state.iterations());
}

void run_pdf(benchmark::State& state, int count) {
  const scene::Scene scene = hall(count);
  const scene::RayQuery query(scene);
  const scene::LightSampler<3> lights(scene, material::SpectralBasis::rgb());
  const Vec3f up = Vec3f::UnitY();
  scene::Counters counters;
  std::vector<Found> found;
  for (const Place& p : places(scene)) {
    const auto sample = lights.sample(p.position, up, p.choice, p.u);
    if (!sample) continue;
    if (const auto hit =
            query.closest({p.position, sample->wi}, counters, scene::Counter::RaysShadow))
      found.push_back({p.position, scene::surface_point(scene, *hit), hit->t});
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const Found& f = found[i];
    auto density = lights.pdf(f.position, up, f.hit, f.distance);
    benchmark::DoNotOptimize(density);
    if (++i == found.size()) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

void register_lights() {
  for (const int count : {1, 100, 10000}) {
    benchmark::RegisterBenchmark(("lights/sample/" + std::to_string(count)).c_str(), run_sample,
                                 count);
    benchmark::RegisterBenchmark(("lights/density/" + std::to_string(count)).c_str(), run_pdf,
                                 count);
  }
}

}  // namespace atrium::bench
