#include "material/error.h"
#include "memory_plan.h"
#include "solvers.h"

namespace atrium::radiosity {
namespace {

using scene::Counters;

/// Lane by lane: where the air or a gas is coloured, what is bright and what is absorbed there go
/// together, and means of both say nothing about their product.
template <int N>
LaneValues<N> lanes_of(const Spectrum<N>& s) {
  LaneValues<N> lanes;
  for (int lane = 0; lane < N; ++lane)
    lanes[static_cast<std::size_t>(lane)] = static_cast<double>(s[lane]);
  return lanes;
}

/// Summed weight of a row.
template <int N>
LaneValues<N> row_sum(const Rows<N>& rows, std::size_t k) {
  LaneValues<N> sum{};
  for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e) {
    const auto& entry = rows.entries[e];
    const bool chromatic = (entry.target & Rows<N>::kChromatic) != 0;
    for (std::size_t lane = 0; lane < N; ++lane)
      sum[lane] +=
          static_cast<double>(entry.weight) *
          (chromatic ? static_cast<double>(rows.spectral[entry.spectral][static_cast<int>(lane)])
                     : 1.0);
  }
  return sum;
}

}  // namespace

template <int N>
FluxBalance flux_balance(const Problem<N>& problem, const Solution<N>& s, const Photons<N>& photons,
                         const Rows<N>& rows) {
  FluxBalance f{.emitted = static_cast<double>(problem.shading.lights().flux().mean()),
                .absorbed = lane_mean(photons.absorbed),
                .escaped = lane_mean(photons.escaped),
                .in_medium = lane_mean(photons.in_medium)};
  double variance = photons.variance;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows.rays[k] == 0) continue;
    const SideIndex i = problem.sides.active[k];
    const double rays = rows.rays[k];
    const double exposed = rays / (rays + rows.dropped[k]);
    const double area = static_cast<double>(problem.area(i)) * exposed;
    const LaneValues<N> b = lanes_of(leaving(problem.sides, i, total_exchange(problem, s, i),
                                             total_exchange(problem, s, i ^ 1U)));
    const LaneValues<N> escaped = lanes_of(rows.escaped[k]);
    const LaneValues<N> in_medium = lanes_of(rows.in_medium[k]);
    const LaneValues<N> found = row_sum(rows, k);
    for (std::size_t lane = 0; lane < N; ++lane) {
      const double per_ray = area * b[lane] / (N * rays);
      f.escaped += per_ray * escaped[lane];
      f.in_medium += per_ray * in_medium[lane];
      f.absorbed += per_ray * (rays - found[lane] - escaped[lane] - in_medium[lane]);
    }
    f.absorbed += area * absorbed_per_area(problem, s, i);
    variance +=
        area * area *
        static_cast<double>(s.direct.variance[i] + s.caustic.variance[i] + s.indirect.variance[i]);
  }
  f.standard_error = std::sqrt(variance);
  return f;
}

template <int N>
std::vector<Beyond<N>> beyond_sides(const Problem<N>& problem, Work& work, Counters& counters) {
  const std::size_t n = problem.sides.active.size();
  const Rows<N> rows = trace_rows<N>(problem, {}, {}, std::vector<std::uint8_t>(n, 1), 0,
                                     kBalanceRays, work, counters);
  std::vector<Beyond<N>> all(n);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const LaneValues<N> escaped = lanes_of(rows.escaped[k]);
    const LaneValues<N> in_medium = lanes_of(rows.in_medium[k]);
    const LaneValues<N> found = row_sum(rows, k);
    for (std::size_t lane = 0; lane < N; ++lane) {
      double absorbed = rows.rays[k] - found[lane] - escaped[lane] - in_medium[lane];
      if (!(absorbed > 0.5)) absorbed = 0.0;  // of rounding: less than one ray
      const double sum = escaped[lane] + in_medium[lane] + absorbed;
      if (sum > 0.0) {
        all[k].escaped[lane] = escaped[lane] / sum;
        all[k].absorbed[lane] = absorbed / sum;
        all[k].in_medium[lane] = in_medium[lane] / sum;
      }
    }
  }
  return all;
}

template <int N>
Spectrum<N> ambient_irradiance(const Problem<N>& problem, const Solution<N>& solution,
                               const SideValues<N>& unshot) {
  Spectrum<N> left, absorbed_share;
  for (const SideIndex i : problem.sides.active) {
    if (total_plain(solution, i).is_zero()) continue;
    const float a = problem.area(i);
    left += unshot[i] * a;
    absorbed_share +=
        (Spectrum<N>::one() - problem.sides.reflectance[i] - problem.sides.transmittance[i ^ 1U]) *
        a;
  }
  Spectrum<N> ambient;
  for (int lane = 0; lane < N; ++lane)
    ambient[lane] = absorbed_share[lane] > 0.0f ? left[lane] / absorbed_share[lane] : 0.0f;
  return ambient;
}

template <int N>
void require_diffuse(const Problem<N>& problem, const char* solver) {
  if (problem.specular)
    throw Error(std::string("radiosity: solver '") + solver +
                "' is for diffuse surfaces only and this scene has mirrors, glass or glossy "
                "materials; use solver 'rows'");
}

#define ATRIUM_INSTANTIATE(N)                                                                 \
  template FluxBalance flux_balance(const Problem<N>&, const Solution<N>&, const Photons<N>&, \
                                    const Rows<N>&);                                          \
  template std::vector<Beyond<N>> beyond_sides(const Problem<N>&, Work&, Counters&);          \
  template Spectrum<N> ambient_irradiance(const Problem<N>&, const Solution<N>&,              \
                                          const SideValues<N>&);                              \
  template void require_diffuse(const Problem<N>&, const char*);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
