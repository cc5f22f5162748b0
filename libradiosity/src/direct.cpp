#include "hemisphere.h"
#include "passes.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

/// Light samples of one side.
template <int N>
class SideLight {
 public:
  SideLight(const Problem<N>& problem, Purpose purpose, DirectLights which, const SightTable& table,
            std::uint32_t round)
      : problem_(problem),
        table_(table),
        round_(round),
        purpose_(static_cast<std::uint64_t>(purpose)),
        which_(which),
        first_surface_(static_cast<std::uint32_t>(problem.shading.scene().lights.size())),
        sky_(scene::environment_source(problem.shading.scene())) {}

  /// \return  false if the point lies inside a closed body; asked only where `mixed`.
  bool measure(SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
               Counters& counters, bool mixed) const {
    scene::Sampler sampler(replicate_seed(problem_.options.seed, purpose_, replicate, round_),
                           problem_.stream(i), index);
    const scene::SurfacePoint p = problem_.points.sample(i / 2, sampler.next_2d());
    const Vec3f normal = side_of(i) == scene::Side::Front ? p.ng : Vec3f(-p.ng);
    const float choice = sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    if (mixed && is_buried(problem_, p, normal, sampler.next_2d(), counters)) return false;
    const auto s = light_for(i, p.position, normal, choice, u);
    if (!s || !(s->pdf > 0.0f)) return true;
    const bool is_surface = s->source >= first_surface_ && s->source < sky_;
    if (which_ == DirectLights::NoSurfaces && is_surface) return true;
    const float cosine = s->wi.dot(normal);
    if (!(cosine > 0.0f) || s->radiance.is_zero()) return true;
    const Spectrum<N> visible = problem_.shading.visibility(p, *s, counters, Counter::RaysDirect);
    if ((visible * s->radiance).is_zero()) return true;
    const bool coupled = problem_.sides.coupled[i / 2] != 0;
    const Spectrum<N> body = coupled ? problem_.shading.interact(p, normal).bsdf.body_weight(cosine)
                                     : Spectrum<N>::one();
    const auto add = [&](std::uint32_t source, const Spectrum<N>& radiance) {
      const Spectrum<N> irradiance = visible * radiance * (cosine / s->pdf);
      if (!irradiance.is_zero())
        sums.add(problem_.group_of(source), replicate, irradiance, irradiance * body);
    };
    if (s->source == sky_ && problem_.group_count() > 1)
      problem_.shading.lights().sky_parts(*s, add);
    else
      add(s->source, s->radiance);
    sums.end_sample();
    return true;
  }

 private:
  /// As LightSampler::sample, mostly one of the lights that the side's region sees.
  std::optional<scene::LightSample<N>> light_for(SideIndex i, const Vec3f& p, const Vec3f& normal,
                                                 float choice, const Vec2f& u) const {
    const scene::LightSampler<N>& lights = problem_.shading.lights();
    if (!table_.knows(i)) return lights.sample(p, normal, choice, u);
    constexpr float by_tree = 0.2f;
    const auto chance = [&](std::uint32_t number) {
      return by_tree * lights.choice_probability(p, normal, number) +
             (1.0f - by_tree) * table_.probability(i, number);
    };
    if (choice < by_tree) {
      auto s = lights.sample(p, normal, std::min(choice / by_tree, 0x1.fffffep-1f), u);
      if (!s) return s;
      const float tree = lights.choice_probability(p, normal, s->number);
      if (!(tree > 0.0f)) return std::nullopt;  // rounding
      s->pdf *= chance(s->number) / tree;
      return s;
    }
    const std::uint32_t number = table_.choose(i, (choice - by_tree) / (1.0f - by_tree));
    auto s = lights.sample_light(number, p, u);
    if (s) s->pdf *= chance(number);
    return s;
  }

  const Problem<N>& problem_;
  const SightTable& table_;
  std::uint32_t round_;
  std::uint64_t purpose_;
  DirectLights which_;
  std::uint32_t first_surface_, sky_;  ///< sources that are surfaces; the environment
};

}  // namespace

template <int N>
bool sample_direct(const Problem<N>& problem, Purpose purpose, DirectLights which,
                   const SightTable& table, const std::vector<std::uint8_t>& mixed,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work, Counters& counters) {
  if (problem.shading.lights().empty()) return true;
  const SideLight<N> light(problem, purpose, which, table, tally.round());
  return draw_one_by_one(
      plan, tally, work, counters,
      [&](SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums, Counters& c) {
        return light.measure(i, replicate, index, sums, c, !mixed.empty() && mixed[i] != 0);
      });
}

template <int N>
Estimate<N> estimate_of(const Tally<N>& tally, const Problem<N>& problem) {
  Estimate<N> result(problem.side_count(), problem.sides.any_coupled);
  for (const SideIndex i : problem.sides.active)
    for (std::size_t g = 0; g < tally.groups(); ++g) {
      result.irradiance.plain[i] += tally.mean(i, g);
      if (problem.sides.any_coupled) result.irradiance.body[i] += tally.mean_body(i, g);
    }
  for (const SideIndex i : problem.sides.active)
    result.variance[i] = static_cast<float>(tally.variance(i));
  return result;
}

template <int N>
Estimate<N> direct_light(const Problem<N>& problem, int samples, DirectLights which, Work& work,
                         Counters& counters) {
  Tally<N> tally(problem.side_count(), 1, problem.sides.any_coupled);
  sample_direct(problem, Purpose::Count, which, {}, {},
                top_up(problem, tally, problem.sides.active, samples), tally, work, counters);
  return estimate_of(tally, problem);
}

#define ATRIUM_INSTANTIATE(N)                                                              \
  template bool sample_direct(const Problem<N>&, Purpose, DirectLights, const SightTable&, \
                              const std::vector<std::uint8_t>&, const std::vector<Draw>&,  \
                              Tally<N>&, Work&, Counters&);                                \
  template Estimate<N> estimate_of(const Tally<N>&, const Problem<N>&);                    \
  template Estimate<N> direct_light(const Problem<N>&, int, DirectLights, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
