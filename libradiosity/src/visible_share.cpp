#include "visible_share.h"

#include <numbers>

#include "scene/segment.h"

namespace atrium::radiosity {

namespace {

/// Sums of the exchange's kernel [1/m^2] over the samples of a pair: all of it, and what arrives.
template <int N>
struct KernelSums {
  double all = 0.0;
  LaneValues<N> seen{};
};

template <int N>
KernelSums<N> sum_kernel(const Problem<N>& problem, const Patch& a, const Patch& b,
                         const PairSamples& samples, scene::Counters& counters) {
  const scene::Scene& scene = problem.shading.scene();
  KernelSums<N> sums;
  for (int k = 0; k < samples.rays; ++k) {
    scene::Sampler sampler(samples.seed, samples.stream, static_cast<std::uint32_t>(k));
    const scene::SurfacePoint p = sample_patch(scene, problem.points, a, sampler.next_2d());
    const scene::SurfacePoint q = sample_patch(scene, problem.points, b, sampler.next_2d());
    const Vec3f d = q.position - p.position;
    const float here = (a.back ? -1.0f : 1.0f) * p.ng.dot(d);
    const float there = (b.back ? 1.0f : -1.0f) * q.ng.dot(d);
    if (!(here > 0.0f) || !(there > 0.0f)) continue;
    const double r2 = static_cast<double>(d.squaredNorm());
    const double kernel = static_cast<double>(here) * static_cast<double>(there) / (r2 * r2);
    sums.all += kernel;
    const Spectrum<N> t =
        problem.shading.transmittance(segment(p, q), counters, scene::Counter::RaysRow);
    for (int lane = 0; lane < N; ++lane)
      sums.seen[static_cast<std::size_t>(lane)] += kernel * static_cast<double>(t[lane]);
  }
  return sums;
}

}  // namespace

template <int N>
LaneValues<N> visible_share(const Problem<N>& problem, const Patch& a, const Patch& b,
                            const PairSamples& samples, scene::Counters& counters) {
  KernelSums<N> sums = sum_kernel(problem, a, b, samples, counters);
  for (double& s : sums.seen) s = sums.all > 0.0 ? s / sums.all : 0.0;
  return sums.seen;
}

template <int N>
LaneValues<N> sampled_exchange_area(const Problem<N>& problem, const Patch& a, const Patch& b,
                                    const PairSamples& samples, scene::Counters& counters) {
  LaneValues<N> seen = sum_kernel(problem, a, b, samples, counters).seen;
  for (double& s : seen) s *= a.area * b.area / (std::numbers::pi * samples.rays);
  return seen;
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template LaneValues<N> visible_share<N>(const Problem<N>&, const Patch&, const Patch&,         \
                                          const PairSamples&, scene::Counters&);                 \
  template LaneValues<N> sampled_exchange_area<N>(const Problem<N>&, const Patch&, const Patch&, \
                                                  const PairSamples&, scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
