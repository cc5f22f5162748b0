#include "passes.h"

namespace atrium::radiosity {

using scene::Counter;
using scene::Counters;

double Replicates::variance_of_mean() const {
  int groups = 0;
  int samples = 0;
  double total = 0.0;
  for (std::size_t g = 0; g < sum_.size(); ++g) {
    groups += count_[g] > 0 ? 1 : 0;
    samples += count_[g];
    total += sum_[g];
  }
  if (groups < 2) return 0.0;
  const double mean = total / samples;
  double squares = 0.0;
  for (std::size_t g = 0; g < sum_.size(); ++g) {
    if (count_[g] == 0) continue;
    const double d = sum_[g] - mean * count_[g];
    squares += d * d;
  }
  return squares * groups / ((groups - 1.0) * samples * samples);
}

namespace {

/// Light samples of one side.
template <int N>
class SideLight {
 public:
  SideLight(const Problem<N>& problem, int samples, DirectLights which)
      : problem_(problem),
        samples_(samples),
        which_(which),
        light_count_(problem.shading.scene().lights.size()) {}

  void measure(SideIndex i, Estimate<N>& result, Counters& counters) const {
    const bool coupled = problem_.sides.coupled[i / 2] != 0;
    const float share = 1.0f / static_cast<float>(samples_);
    Spectrum<N> plain, body;
    Replicates spread;
    for (int k = 0; k < samples_; ++k) {
      const Arrival a = arrive(i, k, coupled, counters);
      plain += a.irradiance;
      body += a.irradiance * a.body_weight;
      spread.add(k, samples_, static_cast<double>(a.irradiance.mean()));
    }
    result.irradiance.plain[i] = plain * share;
    if (!result.irradiance.body.empty()) result.irradiance.body[i] = body * share;
    result.variance[i] = static_cast<float>(spread.variance_of_mean());
  }

 private:
  struct Arrival {
    Spectrum<N> irradiance;
    Spectrum<N> body_weight = Spectrum<N>::one();
  };

  Arrival arrive(SideIndex i, int k, bool coupled, Counters& counters) const {
    scene::Sampler sampler(problem_.options.seed ^ 0xd17ec7U, i, static_cast<std::uint32_t>(k));
    const scene::SurfacePoint p = problem_.points.sample(i / 2, sampler.next_2d());
    const Vec3f normal = side_of(i) == scene::Side::Front ? p.ng : Vec3f(-p.ng);
    const float choice = sampler.next_1d();
    const auto s = problem_.shading.lights().sample(p.position, normal, choice, sampler.next_2d());
    Arrival result;
    if (!s || !(s->pdf > 0.0f)) return result;
    const bool is_surface = !s->dirac && s->light >= light_count_ && std::isfinite(s->distance);
    if (which_ == DirectLights::NoSurfaces && is_surface) return result;
    const float cosine = s->wi.dot(normal);
    if (!(cosine > 0.0f) || s->radiance.is_zero()) return result;
    const Spectrum<N> arriving =
        problem_.shading.visibility(p, *s, counters, Counter::RaysDirect) * s->radiance;
    result.irradiance = arriving * (cosine / s->pdf);
    if (coupled) result.body_weight = problem_.shading.interact(p, normal).bsdf.body_weight(cosine);
    return result;
  }

  const Problem<N>& problem_;
  int samples_;
  DirectLights which_;
  std::size_t light_count_;
};

}  // namespace

template <int N>
Estimate<N> direct_light(const Problem<N>& problem, int samples, DirectLights which, Work& work,
                         Counters& counters) {
  Estimate<N> result(problem.side_count(), problem.sides.any_coupled);
  if (problem.shading.lights().empty()) return result;
  const SideLight<N> light(problem, std::max(1, samples), which);
  const std::vector<SideIndex>& active = problem.sides.active;
  work.run(active.size(), 32, counters, [&](std::size_t begin, std::size_t end, Counters& c) {
    for (std::size_t k = begin; k < end; ++k) light.measure(active[k], result, c);
  });
  return result;
}

#define ATRIUM_INSTANTIATE(N) \
  template Estimate<N> direct_light(const Problem<N>&, int, DirectLights, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
