#include <numbers>

#include "follow.h"
#include "hemisphere.h"
#include "passes.h"
#include "segment.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

template <int N>
class Gatherer {
 public:
  Gatherer(const Problem<N>& problem, const GatherField<N>& field)
      : problem_(problem), field_(field), hot_(field.hot != nullptr && !field.hot->empty()) {}

  bool sample(SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
              Counters& counters) const {
    scene::Sampler sampler(replicate_seed(problem_.options.seed, 0x6a74e5U, replicate),
                           problem_.stream(i), index);
    const HemisphereRay<N> start(problem_, i, sampler);
    const PathEnd<N> end = follow<N>(
        problem_, start.ray, Spectrum<N>::one(), sampler, material::Transport::Radiance,
        Counter::RaysRow, counters,
        [&](const scene::Interaction<N>& at, const Vec3f& wo, const Spectrum<N>& weight,
            bool specular) {
          const SideIndex j = problem_.side_at(at.point, at.side);
          if (j == kNoSide) return;
          const float share = specular ? 1.0f : share_of_chance(start, at, j);
          for (std::size_t g = 0; g < field_.exchange.size(); ++g) {
            const Spectrum<N> arriving = weight * radiosity_at(at, wo, j, g, share);
            if (!arriving.is_zero())
              sums.add(g, replicate, arriving, arriving * start.body_weight);
          }
        });
    if (end.inside_solid) return false;
    if (hot_ && index % 2 == 0) sample_hot(i, replicate, index / 2, sums, counters);
    return true;
  }

 private:
  static_assert(HotPatches<N>::kSamplesPerRay == 0.5f, "one hot sample for every second ray");

  /// Radiosity at a point of side j: reflectance of the very point (textures) times irradiance of
  /// its element. Of the light that hot patches got first, only `share`.
  Spectrum<N> radiosity_at(const scene::Interaction<N>& at, const Vec3f& wo, SideIndex j,
                           std::size_t group, float share) const {
    const SideValues<N>& field = field_.exchange[group];
    Spectrum<N> own = field[j];
    Spectrum<N> other = field[j ^ 1U];
    if (share != 1.0f) {
      own -= (1.0f - share) * field_.source[group][j];
      other -= (1.0f - share) * field_.source[group][j ^ 1U];
    }
    if (at.bsdf.coupled()) return leaving(problem_.sides, j, own, other);
    return at.bsdf.diffuse_reflectance(wo) * own + at.bsdf.diffuse_transmittance() * other;
  }

  /// Balance heuristic for a point of a hot patch that a hemisphere ray hit.
  float share_of_chance(const HemisphereRay<N>& start, const scene::Interaction<N>& at,
                        SideIndex j) const {
    if (!hot_ || !field_.hot->contains(j)) return 1.0f;
    const Vec3f d = at.point.position - start.ray.origin;
    const float cosine = std::abs(at.ng.dot(start.ray.direction));
    if (!(cosine > 0.0f)) return 1.0f;
    const float chosen = field_.hot->density(j) * d.squaredNorm() / cosine;
    return share(start.cosine, chosen);
  }
  static float share(float receiver_cosine, float chosen) {
    const float chance = receiver_cosine * std::numbers::inv_pi_v<float>;
    return chance / (chance + HotPatches<N>::kSamplesPerRay * chosen);
  }

  void sample_hot(SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
                  Counters& counters) const {
    scene::Sampler sampler(replicate_seed(problem_.options.seed, 0x407caU, replicate),
                           problem_.stream(i), index);
    const scene::SurfacePoint from = problem_.points.sample(i / 2, sampler.next_2d());
    const SideIndex j = field_.hot->sample(sampler.next_1d());
    const scene::SurfacePoint to = problem_.points.sample(j / 2, sampler.next_2d());
    const Vec3f normal = side_of(i) == scene::Side::Front ? from.ng : Vec3f(-from.ng);
    const Vec3f facing = side_of(j) == scene::Side::Front ? to.ng : Vec3f(-to.ng);
    const Vec3f d = to.position - from.position;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0.0f)) return;
    const Vec3f wi = d / std::sqrt(distance2);
    const float receiver_cosine = wi.dot(normal);
    const float sender_cosine = -wi.dot(facing);
    if (!(receiver_cosine > 0.0f) || !(sender_cosine > 0.0f)) return;
    const Spectrum<N> seen = problem_.shading.transmittance(
        segment(from, to), counters, Counter::RaysRow);
    if (seen.is_zero()) return;
    const float chosen = field_.hot->density(j) * distance2 / sender_cosine;
    const float weight = receiver_cosine * std::numbers::inv_pi_v<float> *
                         (1.0f - share(receiver_cosine, chosen)) /
                         (HotPatches<N>::kSamplesPerRay * chosen);
    const scene::Interaction<N> at = problem_.shading.interact(to, -wi);
    const Spectrum<N> body =
        problem_.sides.coupled[i / 2] != 0
            ? problem_.shading.interact(from, normal).bsdf.body_weight(receiver_cosine)
            : Spectrum<N>::one();
    for (std::size_t g = 0; g < field_.source.size(); ++g) {
      const SideValues<N>& source = field_.source[g];
      const Spectrum<N> radiosity =
          at.bsdf.coupled() ? leaving(problem_.sides, j, source[j], source[j ^ 1U])
                            : at.bsdf.diffuse_reflectance(at.to_local(-wi)) * source[j] +
                                  at.bsdf.diffuse_transmittance() * source[j ^ 1U];
      const Spectrum<N> arriving = seen * radiosity * weight;
      if (!arriving.is_zero()) sums.add(g, replicate, arriving, arriving * body);
    }
  }

  const Problem<N>& problem_;
  const GatherField<N>& field_;
  bool hot_;
};

}  // namespace

template <int N>
bool sample_gather(const Problem<N>& problem, const GatherField<N>& field,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work,
                   Counters& counters) {
  const Gatherer<N> gatherer(problem, field);
  return draw_samples(plan, tally, work, counters,
                      [&](SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
                          Counters& c) { return gatherer.sample(i, replicate, index, sums, c); });
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template bool sample_gather(const Problem<N>&, const GatherField<N>&, const std::vector<Draw>&, \
                              Tally<N>&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
