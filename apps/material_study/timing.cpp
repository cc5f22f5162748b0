#include "material_study/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "material/bsdf.h"
#include "material/paper.h"

namespace atrium::study {

namespace {

constexpr int kCalls = 4096, kRuns = 7;

struct Directions {
  std::vector<Vec3f> wo, wi;
  std::vector<Vec2f> u;

  Directions() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto direction = [&] {
      const float z = 0.02f + 0.98f * uniform(random);
      const float r = std::sqrt(1.0f - z * z);
      const float phi = 2.0f * std::numbers::pi_v<float> * uniform(random);
      return Vec3f(r * std::cos(phi), r * std::sin(phi), z);
    };
    for (int i = 0; i < kCalls; ++i) {
      wo.push_back(direction());
      // Around the mirror direction, where lobes are not zero.
      const Vec3f spread = 0.2f * direction();
      wi.push_back((Vec3f(-wo.back().x(), -wo.back().y(), wo.back().z()) + spread).normalized());
      u.emplace_back(uniform(random), uniform(random));
    }
  }
};

/// Nanoseconds of one call of f(i).
template <class F>
double time_of(F&& f) {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  static volatile float sink;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = Clock::now();
    float sum = 0.0f;
    for (std::size_t i = 0; i < kCalls; ++i) sum += f(i);
    sink = sink + sum;
    const std::chrono::duration<double, std::nano> passed = Clock::now() - start;
    least = std::min(least, passed.count() / kCalls);
  }
  return least;
}

Timing measure(const std::string& name, const material::Material& m, trace::Mode mode) {
  static const Directions d;
  using Lanes = Spectrum<3>;
  const auto basis = material::SpectralBasis::rgb();
  const auto resolved = material::resolve_material<3>(m, basis);
  Timing t{.name = name};
  if (mode == trace::Mode::Paper) {
    const material::PaperSurface<3> paper(resolved, true, Lanes::one(), Lanes::one(), 1.0f);
    t.eval = time_of([&](std::size_t i) { return paper.direct(d.wo[i], d.wi[i])[0]; });
    return t;
  }
  const material::Bsdf<3> bsdf(resolved, true, Lanes::one(), Lanes::one(), 1.0f);
  t.eval = time_of([&](std::size_t i) { return bsdf.eval(d.wo[i], d.wi[i]).sum()[0]; });
  t.sample = time_of([&](std::size_t i) {
    const auto s = bsdf.sample(d.wo[i], d.u[i].x(), d.u[i]);
    return s ? s->weight[0] : 0.0f;
  });
  return t;
}

}  // namespace

std::vector<Timing> measure_timings(const Roughness& roughness) {
  const Substance& metal = find_substance("aluminium");
  std::vector<Timing> timings;
  for (const Model model : all_models(metal))
    timings.push_back(
        measure(name_of(model), make_material(metal, roughness, model), mode_of(model)));
  // What the parts of our own model cost.
  material::Material m = make_material(metal, roughness, Model::Facets);
  m.sigma.reset();
  timings.insert(timings.begin() + 1,
                 measure("facets, no mirror part", m, trace::Mode::Radiometric));
  m.masking = material::Masking::Smith;
  timings.insert(timings.begin() + 2,
                 measure("facets, Smith masking", m, trace::Mode::Radiometric));
  m.masking = material::Masking::VCavity;
  m.facet_interreflection = true;
  timings.insert(timings.begin() + 3,
                 measure("facets, interreflection", m, trace::Mode::Radiometric));
  return timings;
}

}  // namespace atrium::study
