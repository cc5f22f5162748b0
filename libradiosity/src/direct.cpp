#include "hemisphere.h"
#include "light_places.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

/// Light samples of one side.
template <int N>
class SideLight {
 public:
  /// \param table  empty for lights that are not the scene's. \param sequence  of the samples.
  SideLight(const Problem<N>& problem, Purpose purpose, DirectLights which,
            const scene::LightSampler<N>& lights, const SightTable& table, std::uint32_t sequence)
      : problem_(problem),
        lights_(lights),
        own_(&lights == &problem.shading.lights()),
        table_(table),
        sequence_(sequence),
        purpose_(static_cast<std::uint64_t>(purpose)),
        which_(which),
        first_surface_(static_cast<std::uint32_t>(problem.shading.scene().lights.size())),
        sky_(scene::environment_source(problem.shading.scene())) {}

  /// \return  false if the point lies inside a closed body; asked only where `mixed`.
  bool measure(SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums,
               Counters& counters, bool mixed) const {
    scene::Sampler sampler(replicate_seed(problem_.options.seed, purpose_, replicate, sequence_),
                           problem_.stream(i), index);
    const scene::SurfacePoint p = problem_.points.sample(i / 2, sampler.next_2d());
    const Vec3f normal = normal_of(i, p.ng);
    const float choice = sampler.next_1d();
    const Vec2f u = sampler.next_2d();
    if (mixed && is_buried(problem_, p, normal, sampler.next_2d(), counters)) return false;
    arriving(i, p, normal, choice, u, Counter::RaysDirect, counters,
             [&](std::size_t group, const Spectrum<N>& irradiance, const Spectrum<N>& body) {
               sums.add(group, replicate, irradiance, irradiance * body);
             });
    sums.end_sample();
    return true;
  }

  /// A place with its light, see sample_places().
  LightPlace place(SideIndex i, std::uint32_t index, std::size_t samples, Counters& counters,
                   bool mixed) const {
    scene::Sampler sampler(problem_.options.seed ^ (purpose_ << 32) ^ 0x91aceU, problem_.stream(i),
                           index);
    const scene::SurfacePoint p = problem_.points.sample(i / 2, sampler.next_2d());
    const Vec3f normal = normal_of(i, p.ng);
    LightPlace result;
    if (mixed && is_buried(problem_, p, normal, sampler.next_2d(), counters)) return result;
    result.object = p.object;
    result.triangle = p.triangle;
    result.position = p.position;
    result.valid = true;
    for (std::size_t k = 0; k < samples; ++k) {
      const float choice = sampler.next_1d();
      arriving(i, p, normal, choice, sampler.next_2d(), Counter::RaysProbe, counters,
               [&](std::size_t, const Spectrum<N>& irradiance, const Spectrum<N>&) {
                 result.light[k] += irradiance.mean();
               });
    }
    return result;
  }

 private:
  /// One sample: add(group, irradiance, body weight) for every part of its light that arrives.
  template <class Add>
  void arriving(SideIndex i, const scene::SurfacePoint& p, const Vec3f& normal, float choice,
                const Vec2f& u, Counter kind, Counters& counters, Add&& add) const {
    const auto s = light_for(i, p.position, normal, choice, u);
    if (!s || !(s->pdf > 0.0f)) return;
    const bool is_surface = s->source >= first_surface_ && s->source < sky_;
    if (which_ == DirectLights::NoSurfaces && is_surface) return;
    const float cosine = s->wi.dot(normal);
    if (!(cosine > 0.0f) || s->radiance.is_zero()) return;
    const Spectrum<N> visible = problem_.shading.visibility(p, *s, counters, kind);
    if ((visible * s->radiance).is_zero()) return;
    const bool coupled = problem_.sides.coupled[i / 2] != 0;
    const Spectrum<N> body = coupled ? problem_.shading.interact(p, normal).bsdf.body_weight(cosine)
                                     : Spectrum<N>::one();
    const auto add_part = [&](std::uint32_t source, const Spectrum<N>& radiance) {
      const Spectrum<N> irradiance = visible * radiance * (cosine / s->pdf);
      if (!irradiance.is_zero()) add(own_ ? problem_.group_of(source) : 0U, irradiance, body);
    };
    if (own_ && s->source == sky_ && problem_.group_count() > 1)
      lights_.sky_parts(*s, add_part);
    else
      add_part(s->source, s->radiance);
  }

  /// As LightSampler::sample, mostly one of the lights that the side's region sees.
  std::optional<scene::LightSample<N>> light_for(SideIndex i, const Vec3f& p, const Vec3f& normal,
                                                 float choice, const Vec2f& u) const {
    if (!table_.knows(i)) return lights_.sample(p, normal, choice, u);
    constexpr float by_tree = 0.2f;
    const auto chance = [&](std::uint32_t number) {
      return by_tree * lights_.choice_probability(p, normal, number) +
             (1.0f - by_tree) * table_.probability(i, number);
    };
    if (choice < by_tree) {
      auto s = lights_.sample(p, normal, std::min(choice / by_tree, 0x1.fffffep-1f), u);
      if (!s) return s;
      const float tree = lights_.choice_probability(p, normal, s->number);
      if (!(tree > 0.0f)) return std::nullopt;  // rounding
      s->pdf *= chance(s->number) / tree;
      return s;
    }
    const std::uint32_t number = table_.choose(i, (choice - by_tree) / (1.0f - by_tree));
    auto s = lights_.sample_light(number, p, u);
    if (s) s->pdf *= chance(number);
    return s;
  }

  const Problem<N>& problem_;
  const scene::LightSampler<N>& lights_;
  bool own_;  ///< are they the scene's?
  const SightTable& table_;
  std::uint32_t sequence_;
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
  const SideLight<N> light(problem, purpose, which, problem.shading.lights(), table,
                           tally.sequence());
  return draw_one_by_one(
      plan, tally, work, counters,
      [&](SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums, Counters& c) {
        return light.measure(i, replicate, index, sums, c, !mixed.empty() && mixed[i] != 0);
      });
}

template <int N>
bool sample_lights(const Problem<N>& problem, const scene::LightSampler<N>& lights,
                   const std::vector<Draw>& plan, Tally<N>& tally, Work& work, Counters& counters) {
  const SightTable none;
  const SideLight<N> light(problem, Purpose::Compare, DirectLights::All, lights, none,
                           tally.sequence());
  return draw_one_by_one(
      plan, tally, work, counters,
      [&](SideIndex i, int replicate, std::uint32_t index, SideSums<N>& sums, Counters& c) {
        return light.measure(i, replicate, index, sums, c, false);
      });
}

template <int N>
std::vector<LightPlace> sample_places(const Problem<N>& problem, Purpose purpose,
                                      const std::vector<std::uint8_t>& mixed,
                                      const std::vector<SideIndex>& sides, std::size_t samples,
                                      Work& work, Counters& counters) {
  constexpr std::size_t kGrain = 64;
  std::vector<LightPlace> places(sides.size() * kLightPlaces, LightPlace());
  const SightTable none;
  const SideLight<N> light(problem, purpose, DirectLights::All, problem.shading.lights(), none, 0);
  work.run(sides.size(), kGrain, counters, [&](std::size_t begin, std::size_t end, Counters& c) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::uint32_t n = 0; n < kLightPlaces; ++n)
        places[k * kLightPlaces + n] =
            light.place(sides[k], n, samples, c, !mixed.empty() && mixed[sides[k]] != 0);
  });
  return places;
}

template <int N>
HalfFields halves_of(const Problem<N>& problem, const Tally<N>& tally) {
  HalfFields halves{std::vector<float>(problem.side_count(), 0.0f),
                    std::vector<float>(problem.side_count(), 0.0f)};
  for (const SideIndex i : problem.sides.active)
    for (std::size_t g = 0; g < tally.groups(); ++g) {
      halves.first[i] += tally.half_mean(i, g, false);
      halves.second[i] += tally.half_mean(i, g, true);
    }
  for (SideIndex i = 0; i < problem.side_count(); ++i)
    if (const SideIndex cover = problem.sides.cover[i]; cover != kNoSide) {
      halves.first[i] = halves.first[cover];
      halves.second[i] = halves.second[cover];
    }
  return halves;
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

#define ATRIUM_INSTANTIATE(N)                                                                      \
  template bool sample_direct(const Problem<N>&, Purpose, DirectLights, const SightTable&,         \
                              const std::vector<std::uint8_t>&, const std::vector<Draw>&,          \
                              Tally<N>&, Work&, Counters&);                                        \
  template bool sample_lights(const Problem<N>&, const scene::LightSampler<N>&,                    \
                              const std::vector<Draw>&, Tally<N>&, Work&, Counters&);              \
  template std::vector<LightPlace> sample_places(                                                  \
      const Problem<N>&, Purpose, const std::vector<std::uint8_t>&, const std::vector<SideIndex>&, \
      std::size_t, Work&, Counters&);                                                              \
  template HalfFields halves_of(const Problem<N>&, const Tally<N>&);                               \
  template Estimate<N> estimate_of(const Tally<N>&, const Problem<N>&);                            \
  template Estimate<N> direct_light(const Problem<N>&, int, DirectLights, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
