#include "sight_table.h"

#include <algorithm>

#include "scene/parallel.h"
#include "scene/segment.h"

namespace atrium::radiosity {
namespace {

/// What a source that no ray reached counts, of what it would give if nothing stood between.
constexpr double kUnseen = 0.01;
/// How much of what the regions beside see counts.
constexpr double kBeside = 0.25;
/// A region that sees this share of all light is served better by the tree, which knows each point.
constexpr double kMostlySeen = 0.5;
/// Sources that hardly count are left to the tree.
constexpr double kLeast = 1e-4;

scene::Sampler sampler_of(std::uint64_t seed, SideIndex i, std::uint32_t source,
                          std::uint32_t ray) {
  return {seed ^ (std::uint64_t{0x51947ab} << 32), scene::hash32(i) ^ source, ray};
}

}  // namespace

SightTable::SightTable(const Regions& regions, std::size_t sides, std::size_t sources,
                       const ReachOf& reach_of, scene::Counters& counters) {
  if (sources < 2 || sources > kMostSources || regions.size() == 0) return;
  std::vector<Reach> reach(regions.size() * sources);
  constexpr std::size_t kGrain = 8;
  std::vector<scene::Counters> parts((regions.size() + kGrain - 1) / kGrain);
  scene::parallel_for(regions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      for (std::size_t s = 0; s < sources; ++s)
        for (std::uint32_t k = 0; k < kRays; ++k) {
          // Sides spread over the region, others for the next source.
          const auto members = regions.members(r);
          const SideIndex i = members[(k * members.size() / kRays + s) % members.size()];
          const Reach found = reach_of(i, static_cast<std::uint32_t>(s), k, parts[begin / kGrain]);
          reach[r * sources + s].seen += found.seen / kRays;
          reach[r * sources + s].open += found.open / kRays;
        }
  });
  for (const scene::Counters& c : parts) counters += c;

  region_of_.assign(sides, 0);
  first_.assign(1, 0);
  std::vector<double> weight(sources);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const SideIndex i : regions.members(r)) region_of_[i] = static_cast<std::uint32_t>(r);
    double sum = 0.0;
    double open = 0.0;
    double seen = 0.0;
    for (std::size_t s = 0; s < sources; ++s) {
      const Reach& own = reach[r * sources + s];
      open += own.open;
      seen += own.seen;
      weight[s] = own.seen + kUnseen * own.open;
      for (const std::size_t beside : {r - 1, r + 1})
        if (beside < regions.size()) weight[s] += 0.5 * kBeside * reach[beside * sources + s].seen;
      sum += weight[s];
    }
    open_.push_back(open);
    double until = 0.0;
    const bool useful = seen < kMostlySeen * open && sum > 0.0;
    for (std::size_t s = 0; s < sources && useful; ++s)
      if (weight[s] > kLeast * sum) {
        until += weight[s] / sum;
        seen_.push_back({static_cast<std::uint32_t>(s), static_cast<float>(until)});
      }
    first_.push_back(static_cast<std::uint32_t>(seen_.size()));
  }
}

std::uint32_t SightTable::choose(SideIndex i, float u) const {
  const std::uint32_t region = region_of_[i];
  const auto begin = seen_.begin() + first_[region];
  const auto end = seen_.begin() + first_[region + 1];
  return std::upper_bound(begin, end - 1, u, [](float v, const Seen& e) { return v < e.until; })
      ->source;
}

float SightTable::probability(SideIndex i, std::uint32_t source) const {
  const std::uint32_t region = region_of_[i];
  const auto begin = seen_.begin() + first_[region];
  const auto end = seen_.begin() + first_[region + 1];
  const auto it = std::lower_bound(begin, end, source,
                                   [](const Seen& e, std::uint32_t s) { return e.source < s; });
  if (it == end || it->source != source) return 0.0f;
  // The last one has what rounding and sources that hardly count leave.
  return (it + 1 == end ? 1.0f : it->until) - (it == begin ? 0.0f : (it - 1)->until);
}

bool SightTable::is_for(std::size_t sides, std::size_t sources) const {
  if (empty()) return true;
  bool ok = region_of_.size() == sides && !first_.empty() && first_.front() == 0 &&
            first_.back() == seen_.size() && open_.size() + 1 == first_.size();
  for (std::size_t r = 0; ok && r + 1 < first_.size(); ++r) ok = first_[r] <= first_[r + 1];
  for (const std::uint32_t r : region_of_) ok = ok && r + 1 < first_.size();
  for (const Seen& s : seen_) ok = ok && s.source < sources;
  return ok;
}

template <int N>
SightTable sight_of_lights(const Problem<N>& problem, const Regions& regions,
                           scene::Counters& counters) {
  const scene::LightSampler<N>& lights = problem.shading.lights();
  // How much comes from far away the table does not know.
  if (lights.has_sky()) return {};
  const auto reach = [&](SideIndex i, std::uint32_t light, std::uint32_t ray, scene::Counters& c) {
    scene::Sampler sampler = sampler_of(problem.options.seed, i, light, ray);
    const scene::SurfacePoint p = problem.points.sample(i / 2, sampler.next_2d());
    const auto s = lights.sample_light(light, p.position, sampler.next_2d());
    SightTable::Reach found;
    if (!s || !(s->pdf > 0.0f)) return found;
    const float cosine = s->wi.dot(normal_of(i, p.ng));
    if (!(cosine > 0.0f) || s->radiance.is_zero()) return found;
    found.open = static_cast<double>(s->radiance.mean() * cosine / s->pdf);
    const Spectrum<N> visible = problem.shading.visibility(p, *s, c, scene::Counter::RaysDirect);
    found.seen = found.open * static_cast<double>(visible.mean());
    return found;
  };
  return {regions, problem.side_count(), lights.finite_count(), reach, counters};
}

template <int N>
SightTable sight_of_hot(const Problem<N>& problem, const Regions& regions, const HotPatches<N>& hot,
                        scene::Counters& counters) {
  const auto reach = [&](SideIndex i, std::uint32_t group, std::uint32_t ray, scene::Counters& c) {
    scene::Sampler sampler = sampler_of(problem.options.seed, i, ~group, ray);
    const scene::SurfacePoint from = problem.points.sample(i / 2, sampler.next_2d());
    const SideIndex j = hot.sample_in(group, sampler.next_1d());
    const scene::SurfacePoint to = problem.points.sample(j / 2, sampler.next_2d());
    const Vec3f d = to.position - from.position;
    SightTable::Reach found;
    if (!(d.squaredNorm() > 0.0f)) return found;
    const Vec3f wi = d.normalized();
    const float receiver = wi.dot(normal_of(i, from.ng));
    const float sender = -wi.dot(normal_of(j, to.ng));
    if (!(receiver > 0.0f) || !(sender > 0.0f)) return found;
    // As HotPatches::share_of_chance has it: bounded next to the patch.
    found.open = static_cast<double>(hot.share_of(group) * hot.strength() *
                                     hot.share_of_chance(j, d, receiver, sender));
    const Spectrum<N> seen =
        problem.shading.transmittance(segment(from, to), c, scene::Counter::RaysRow);
    found.seen = found.open * static_cast<double>(seen.mean());
    return found;
  };
  return {regions, problem.side_count(), hot.group_count(), reach, counters};
}

#define ATRIUM_INSTANTIATE(N)                                                               \
  template SightTable sight_of_lights(const Problem<N>&, const Regions&, scene::Counters&); \
  template SightTable sight_of_hot(const Problem<N>&, const Regions&, const HotPatches<N>&, \
                                   scene::Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
