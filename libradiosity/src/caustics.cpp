#include "follow.h"
#include "passes.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

template <int N>
struct Deposit {
  SideIndex side;
  std::uint32_t group;
  Spectrum<N> flux;
  Spectrum<N> body;  // flux * B(mu) / B-bar
};

/// What a batch of photons did; added up in the order of the batches.
template <int N>
struct Batch {
  std::vector<Deposit<N>> deposits;
  LaneValues<N> escaped{}, in_medium{}, absorbed{};
  double squares = 0.0;
};

template <int N>
class PhotonTracer {
 public:
  explicit PhotonTracer(const Problem<N>& problem) : problem_(problem) {}

  void trace(std::uint32_t photon, Batch<N>& batch, Counters& counters) const {
    scene::Sampler sampler(problem_.options.seed ^ 0xca05U, 0, photon);
    const float choice = sampler.next_1d();
    const Vec2f position = sampler.next_2d();
    const auto e = problem_.shading.lights().sample_emission(choice, position, sampler.next_2d());
    if (!e) return;
    Spectrum<N> left = e->weight;
    const PathEnd<N> end = follow<N>(
        problem_, {e->origin, e->direction}, e->weight, sampler, material::Transport::Flux,
        Counter::RaysPhoton, counters, [&](const Landing<N>& at, const Spectrum<N>& flux) {
          left -= flux;
          if (at.specular)
            batch.deposits.push_back(
                {at.side, problem_.group_of(e->source), flux, flux * at.body_weight()});
        });
    for (std::size_t lane = 0; lane < N; ++lane) {
      const int l = static_cast<int>(lane);
      const double escaped = static_cast<double>(end.escaped[l]);
      const double in_medium = static_cast<double>(end.in_medium[l]);
      batch.escaped[lane] += escaped;
      batch.in_medium[lane] += in_medium;
      batch.absorbed[lane] += static_cast<double>(left[l]) - escaped - in_medium;
    }
    const double mean = static_cast<double>(left.mean());
    batch.squares += mean * mean;
  }

 private:
  const Problem<N>& problem_;
};

template <int N>
void add_deposits(const Problem<N>& problem, const Batch<N>& batch, double photons,
                  std::vector<std::vector<std::uint32_t>>& arrived, Photons<N>& result) {
  for (const Deposit<N>& d : batch.deposits) {
    ++arrived[d.group][d.side];
    const float scale =
        static_cast<float>(1.0 / (photons * static_cast<double>(problem.area(d.side))));
    Estimate<N>& caustic = result.caustic[d.group];
    Irradiance<N>& e = caustic.irradiance;
    e.plain[d.side] += d.flux * scale;
    if (!e.body.empty()) e.body[d.side] += d.body * scale;
    const float mean = d.flux.mean() * scale;
    caustic.variance[d.side] += mean * mean;  // of a sum of independent arrivals
  }
}

}  // namespace

template <int N>
std::uint64_t photons_that_fit(const MemoryBudget& memory, std::uint64_t wanted) {
  // Every photon is deposited once or twice; a growing array has up to twice its size.
  constexpr std::uint64_t kEach = 4 * sizeof(Deposit<N>);
  constexpr std::uint64_t kFewest = 1024, kMost = 0xffffffffU;
  return std::min(
      {wanted, kMost, std::max(kFewest, memory.room(MemoryBudget::Part::Photons) / kEach)});
}

template <int N>
Photons<N> trace_photons(const Problem<N>& problem, Work& work, Counters& counters) {
  // Without specular surfaces only the flux balance needs some.
  constexpr std::uint64_t kBalancePhotons = 32768;
  if (!problem.specular) return trace_photons(problem, kBalancePhotons, work, counters);
  const std::uint64_t wanted = std::max(kBalancePhotons, problem.options.caustic_photons);
  const std::uint64_t fit = photons_that_fit<N>(work.memory(), wanted);
  if (fit < wanted)
    work.memory().give_up(std::to_string(fit) + " photons instead of " + std::to_string(wanted));
  return trace_photons(problem, fit, work, counters);
}

template <int N>
Photons<N> trace_photons(const Problem<N>& problem, std::uint64_t count, Work& work,
                         Counters& counters) {
  constexpr std::size_t kGrain = 1024;
  Photons<N> result;
  result.caustic.assign(problem.group_count(),
                        Estimate<N>(problem.side_count(), problem.sides.any_coupled));
  if (problem.shading.lights().empty()) return result;
  const auto wanted = std::min<std::uint64_t>(0xffffffffU, count);
  const PhotonTracer<N> tracer(problem);
  std::vector<Batch<N>> batches((wanted + kGrain - 1) / kGrain);
  std::vector<std::uint8_t> done(batches.size(), 0);
  work.run(wanted, kGrain, counters, [&](std::size_t begin, std::size_t end, Counters& c) {
    Batch<N>& batch = batches[begin / kGrain];
    for (std::size_t i = begin; i < end; ++i) tracer.trace(static_cast<std::uint32_t>(i), batch, c);
    done[begin / kGrain] = 1;
  });
  std::uint64_t photons = 0;
  for (std::size_t b = 0; b < batches.size(); ++b)
    if (done[b] != 0) photons += std::min<std::uint64_t>(kGrain, wanted - b * kGrain);
  result.count = photons;
  std::uint64_t deposits = 0;
  for (const Batch<N>& batch : batches) deposits += bytes_of(batch.deposits);
  work.memory().hold(MemoryBudget::Part::Photons, deposits);
  work.memory().hold(MemoryBudget::Part::Photons, 0);
  if (photons == 0) return result;
  const double n = static_cast<double>(photons);
  double squares = 0.0;
  std::vector<std::vector<std::uint32_t>> arrived(
      problem.group_count(), std::vector<std::uint32_t>(problem.side_count(), 0));
  for (const Batch<N>& batch : batches) {
    add_deposits(problem, batch, n, arrived, result);
    for (std::size_t lane = 0; lane < N; ++lane) {
      result.escaped[lane] += batch.escaped[lane] / n;
      result.in_medium[lane] += batch.in_medium[lane] / n;
      result.absorbed[lane] += batch.absorbed[lane] / n;
    }
    squares += batch.squares / n;
  }
  if (problem.specular)
    for (std::size_t g = 0; g < result.caustic.size(); ++g)
      smooth_photons(problem, arrived[g], result.caustic[g]);
  const double mean =
      lane_mean(result.escaped) + lane_mean(result.in_medium) + lane_mean(result.absorbed);
  // What none of them met may still happen to one of as many: light that grazes a floor.
  const double unseen = mean / n;
  result.variance = std::max(0.0, squares - mean * mean) / n + unseen * unseen;
  return result;
}

#define ATRIUM_INSTANTIATE(N)                                                     \
  template std::uint64_t photons_that_fit<N>(const MemoryBudget&, std::uint64_t); \
  template Photons<N> trace_photons(const Problem<N>&, Work&, Counters&);         \
  template Photons<N> trace_photons(const Problem<N>&, std::uint64_t, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
