#include "hemisphere.h"
#include "passes.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

template <int N>
class Gatherer {
 public:
  Gatherer(const Problem<N>& problem, const SideValues<N>& field)
      : problem_(problem), field_(field), count_(problem.options.gather_rays) {}

  void gather(SideIndex i, Gathered<N>& result, Counters& counters) const {
    Spectrum<N> plain, body;
    Replicates spread;
    std::uint32_t valid = 0;
    for (int first = 0; first < count_; first += HemisphereRays<N>::kMost) {
      const auto index = static_cast<std::uint32_t>(std::max(0, problem_.options.row_rays) + first);
      const HemisphereRays<N> rays(problem_, i, problem_.options.seed, i, index,
                                   std::min(HemisphereRays<N>::kMost, count_ - first));
      Spectrum<N> arriving;
      rays.follow_all(
          counters,
          [&](std::size_t, const Landing<N>& at, const Spectrum<N>& weight) {
            arriving += weight * at.leaving(problem_.sides, field_[at.side], field_[at.side ^ 1U]);
          },
          [&](std::size_t k, const PathEnd<N>& end) {
            if (!end.inside_solid) {
              ++valid;
              plain += arriving;
              body += arriving * rays.body_weight(k);
              spread.add(first + static_cast<int>(k), count_, static_cast<double>(arriving.mean()));
            }
            arriving = {};
          });
    }
    store(i, plain, body, valid, spread, result);
  }

 private:
  static void store(SideIndex i, const Spectrum<N>& plain, const Spectrum<N>& body,
                    std::uint32_t valid, const Replicates& spread, Gathered<N>& result) {
    result.rays[i] = valid;
    if (valid == 0) return;
    const float share = 1.0f / static_cast<float>(valid);
    result.estimate.irradiance.plain[i] = plain * share;
    if (!result.estimate.irradiance.body.empty()) result.estimate.irradiance.body[i] = body * share;
    result.estimate.variance[i] = static_cast<float>(spread.variance_of_mean());
  }

  const Problem<N>& problem_;
  const SideValues<N>& field_;
  int count_;
};

}  // namespace

template <int N>
Gathered<N> gather(const Problem<N>& problem, const SideValues<N>& field, Work& work,
                   Counters& counters) {
  const std::size_t n = problem.side_count();
  Gathered<N> result{.estimate = Estimate<N>(n, problem.sides.any_coupled),
                     .rays = std::vector<std::uint32_t>(n, 0)};
  const std::vector<SideIndex>& active = problem.sides.active;
  std::vector<SideIndex> lit;
  for (const SideIndex i : active)
    if (!field[i].is_zero()) lit.push_back(i);
  const Gatherer<N> gatherer(problem, field);
  work.run(lit.size(), 32, counters, [&](std::size_t begin, std::size_t end, Counters& c) {
    for (std::size_t k = begin; k < end; ++k) gatherer.gather(lit[k], result, c);
  });
  return result;
}

#define ATRIUM_INSTANTIATE(N) \
  template Gathered<N> gather(const Problem<N>&, const SideValues<N>&, Work&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
