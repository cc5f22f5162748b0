#include "view_importance.h"

#include "follow.h"

namespace atrium::radiosity {
namespace {

using scene::Counter;
using scene::Counters;

constexpr std::size_t kRays = 65536;  ///< per view
constexpr std::size_t kGrain = 1024;

/// Shares of the views' rays that end on each side; 1 in all per view where nothing is lost.
template <int N>
std::vector<double> seen_from(const Problem<N>& problem, const View& view, std::uint32_t stream,
                              Counters& counters) {
  struct Batch {
    std::vector<std::pair<SideIndex, double>> landings;
    Counters counters;
  };
  std::vector<Batch> batches(kRays / kGrain);
  scene::parallel_for(kRays, kGrain, [&](std::size_t begin, std::size_t end) {
    Batch& batch = batches[begin / kGrain];
    for (std::size_t k = begin; k < end; ++k) {
      scene::Sampler sampler(problem.options.seed ^ 0x71e3U, stream, static_cast<std::uint32_t>(k));
      const Vec2f u = sampler.next_2d();
      const auto& [x0, y0, x1, y1] = view.crop;
      const Vec2d film(x0 + (x1 - x0) * static_cast<double>(u.x()),
                       y0 + (y1 - y0) * static_cast<double>(u.y()));
      const auto r = view.camera.ray(film, view.aspect);
      follow<N>(problem, {r.origin, r.direction}, Spectrum<N>::one(), sampler,
                material::Transport::Radiance, Counter::RaysProbe, batch.counters,
                [&](const Landing<N>& at, const Spectrum<N>& weight) {
                  batch.landings.emplace_back(at.side, static_cast<double>(weight.mean()));
                });
    }
  });
  std::vector<double> seen(problem.side_count(), 0.0);
  for (const Batch& b : batches) {
    counters += b.counters;
    for (const auto& [side, weight] : b.landings) seen[side] += weight / kRays;
  }
  return seen;
}

}  // namespace

template <int N>
std::vector<float> view_importance(const Problem<N>& problem, const Rows<N>& rows,
                                   Counters& counters) {
  constexpr double kLeast = 1.0 / 64.0;
  constexpr double kFull = 0.1;
  if (problem.options.views.empty()) return {};
  std::vector<double> seen(problem.side_count(), 0.0);
  for (std::size_t v = 0; v < problem.options.views.size(); ++v) {
    const std::vector<double> by_view =
        seen_from(problem, problem.options.views[v], static_cast<std::uint32_t>(v), counters);
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += by_view[i];
  }
  double area = 0.0;
  double all = 0.0;
  std::vector<double> total = seen;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SideIndex i = problem.sides.active[k];
    if (seen[i] == 0.0) continue;
    area += static_cast<double>(problem.area(i));
    all += seen[i];
    // Light that a translucent sheet shows came in at either side.
    const SideIndex o = i ^ 1U;
    const double through = static_cast<double>(problem.sides.transmittance[i].mean());
    if (through > 0.0) total[o] += through * seen[i];
    const double rho = static_cast<double>(problem.sides.reflectance[i].mean());
    if (rows.rays[k] == 0) continue;
    for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e)
      total[rows.entries[e].target & ~Rows<N>::kChromatic] +=
          seen[i] * rho * static_cast<double>(rows.entries[e].weight) / rows.rays[k];
  }
  std::vector<float> importance(problem.side_count(), static_cast<float>(kLeast));
  if (!(all > 0.0)) return importance;
  const double full = kFull * all / area;
  for (const SideIndex i : problem.sides.active)
    importance[i] = static_cast<float>(
        std::clamp(total[i] / (full * static_cast<double>(problem.area(i))), kLeast, 1.0));
  return importance;
}

#define ATRIUM_INSTANTIATE(N) \
  template std::vector<float> view_importance(const Problem<N>&, const Rows<N>&, Counters&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
