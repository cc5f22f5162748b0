#include "hemisphere.h"
#include "passes.h"
#include "scene/segment.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

template <int N>
class Gatherer {
 public:
  Gatherer(const Problem<N>& problem, const std::vector<SideValues<N>>& field,
           const HotPatches<N>& hot, const HemisphereGuide& guide, std::uint32_t sequence)
      : problem_(problem), field_(field), hot_(hot), guide_(guide), sequence_(sequence) {}

  /// \return  how many of the rays started outside closed bodies.
  std::uint32_t sample(SideIndex i, int replicate, std::uint32_t first, std::uint32_t count,
                       SideSums<N>& sums, Counters& counters) const {
    constexpr std::uint32_t kMost = HemisphereRays<N>::kMost;
    const scene::SquareDensity towards = guide_.side(i);
    std::uint32_t valid = 0;
    for (std::uint32_t done = 0; done < count; done += kMost) {
      const HemisphereRays<N> rays(
          problem_, i, replicate_seed(problem_.options.seed, 0x6a74e5U, replicate, sequence_),
          problem_.stream(i), first + done, static_cast<int>(std::min(kMost, count - done)),
          towards);
      rays.follow_all(
          counters,
          [&](std::size_t k, const Landing<N>& at, const Spectrum<N>& weight) {
            const float share = share_of_chance(hot_, rays, k, at);
            for (std::size_t g = 0; g < field_.size(); ++g) {
              const Spectrum<N> arriving = weight * radiosity_at(at, g, share);
              if (!arriving.is_zero())
                sums.add(g, replicate, arriving, arriving * rays.body_weight(k));
            }
          },
          [&](std::size_t, const PathEnd<N>& end) {
            valid += end.inside_solid ? 0 : 1;
            sums.end_sample();
          });
    }
    return valid;
  }

 private:
  /// Of the light that hot patches got first, only `share`.
  Spectrum<N> radiosity_at(const Landing<N>& at, std::size_t group, float share) const {
    Spectrum<N> own = field_[group][at.side];
    if (share != 1.0f) own -= (1.0f - share) * hot_.source(at.side, group);
    return at.leaving(problem_.sides, own, field_[group][at.side ^ 1U]);
  }

  const Problem<N>& problem_;
  const std::vector<SideValues<N>>& field_;
  const HotPatches<N>& hot_;
  const HemisphereGuide& guide_;
  std::uint32_t sequence_;
};

template <int N>
class HotSampler {
 public:
  HotSampler(const Problem<N>& problem, const HotPatches<N>& hot, const SightTable& table,
             std::uint32_t sequence)
      : problem_(problem), hot_(hot), table_(table), sequence_(sequence) {}

  /// \return  false if the point lies inside a closed body; asked only where `mixed`.
  bool sample(SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
              Counters& counters, bool mixed) const {
    scene::Sampler sampler(replicate_seed(problem_.options.seed, 0x407caU, replicate, sequence_),
                           problem_.stream(i), index);
    const scene::SurfacePoint from = problem_.points.sample(i / 2, sampler.next_2d());
    const SideIndex j = patch_for(i, sampler.next_2d());
    const scene::SurfacePoint to = problem_.points.sample(j / 2, sampler.next_2d());
    const Vec3f normal = normal_of(i, from.ng);
    if (mixed && is_buried(problem_, from, normal, sampler.next_2d(), counters)) return false;
    const Vec3f facing = normal_of(j, to.ng);
    const Vec3f d = to.position - from.position;
    if (!(d.squaredNorm() > 0.0f)) return true;
    const Vec3f wi = d.normalized();
    const float receiver_cosine = wi.dot(normal);
    const float sender_cosine = -wi.dot(facing);
    // What rounding alone lifts out of the other's plane exchanges nothing.
    const float least = 2.0f * (from.error + to.error) / d.norm();
    if (!(receiver_cosine > least) || !(sender_cosine > least)) return true;
    const Spectrum<N> seen =
        problem_.shading.transmittance(segment(from, to), counters, Counter::RaysRow);
    if (seen.is_zero()) return true;
    // cos / pi over the density, times the share of this strategy.
    const float weight = hot_.share_of_chance(j, d, receiver_cosine, sender_cosine) /
                         density_of_group(i, hot_.group_of(j));
    const scene::Interaction<N> at = problem_.shading.interact(to, -wi);
    const Spectrum<N> body =
        problem_.sides.coupled[i / 2] != 0
            ? problem_.shading.interact(from, normal).bsdf.body_weight(receiver_cosine)
            : Spectrum<N>::one();
    for (std::size_t g = 0; g < hot_.groups(); ++g) {
      const Spectrum<N> reflectance = at.bsdf.coupled()
                                          ? problem_.sides.reflectance[j]
                                          : at.bsdf.diffuse_reflectance(at.to_local(-wi));
      const Spectrum<N> arriving = seen * reflectance * hot_.source(j, g) * weight;
      if (!arriving.is_zero()) sums.add(g, replicate, arriving, arriving * body);
    }
    sums.end_sample();
    return true;
  }

 private:
  static constexpr float kByFlux = 0.3f;  ///< share of patches that flux alone chooses

  /// Mostly of the groups that the side's region sees.
  SideIndex patch_for(SideIndex i, const Vec2f& u) const {
    if (!table_.knows(i)) return hot_.sample(u.x());
    if (u.x() < kByFlux) return hot_.sample(std::min(u.x() / kByFlux, 0x1.fffffep-1f));
    return hot_.sample_in(table_.choose(i, (u.x() - kByFlux) / (1.0f - kByFlux)), u.y());
  }
  /// How much likelier that makes the patches of a group.
  float density_of_group(SideIndex i, std::uint32_t group) const {
    if (!table_.knows(i)) return 1.0f;
    return kByFlux + (1.0f - kByFlux) * table_.probability(i, group) / hot_.share_of(group);
  }

  const Problem<N>& problem_;
  const HotPatches<N>& hot_;
  const SightTable& table_;
  std::uint32_t sequence_;
};

}  // namespace

template <int N>
bool sample_gather(const Problem<N>& problem, const std::vector<SideValues<N>>& field,
                   const HotPatches<N>& hot, const HemisphereGuide& guide,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work, Counters& counters) {
  const Gatherer<N> gatherer(problem, field, hot, guide, tally.sequence());
  return draw_samples(
      plan, tally, work, counters,
      [&](SideIndex i, int replicate, std::uint32_t first, std::uint32_t count, SideSums<N>& sums,
          Counters& c) { return gatherer.sample(i, replicate, first, count, sums, c); });
}

template <int N>
bool sample_hot(const Problem<N>& problem, const HotPatches<N>& hot, const SightTable& table,
                const std::vector<std::uint8_t>& mixed, const std::vector<Draw>& plan,
                Tally<N>& tally, Work& work, Counters& counters) {
  if (hot.empty()) return true;
  const HotSampler<N> sampler(problem, hot, table, tally.sequence());
  return draw_one_by_one(
      plan, tally, work, counters,
      [&](SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums, Counters& c) {
        return sampler.sample(i, replicate, index, sums, c, mixed[i] != 0);
      });
}

#define ATRIUM_INSTANTIATE(N)                                                                     \
  template bool sample_gather(const Problem<N>&, const std::vector<SideValues<N>>&,               \
                              const HotPatches<N>&, const HemisphereGuide&,                       \
                              const std::vector<Draw>&, Tally<N>&, Work&, Counters&);             \
  template bool sample_hot(const Problem<N>&, const HotPatches<N>&, const SightTable&,            \
                           const std::vector<std::uint8_t>&, const std::vector<Draw>&, Tally<N>&, \
                           Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
