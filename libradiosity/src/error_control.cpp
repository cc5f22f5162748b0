#include "error_control.h"

#include <algorithm>

namespace atrium::radiosity {

using scene::SurfaceField;

Neighbours::Neighbours(const SurfaceField& layout) {
  std::vector<std::uint32_t> near;
  first_.push_back(0);
  for (std::uint32_t e = 0; e < layout.element_count(); ++e) {
    const SurfaceField::Facet& f = layout.facets[layout.element_facet[e]];
    const std::uint32_t x = layout.element_cell[e] % f.nx;
    const std::uint32_t y = layout.element_cell[e] / f.nx;
    const auto visit = [&](bool inside, std::uint32_t cell) {
      if (!inside) return;
      const std::uint32_t n = layout.cell_element[f.first_cell + cell];
      if (n != SurfaceField::kNone) element_.push_back(n);
    };
    visit(x > 0, layout.element_cell[e] - 1);
    visit(x + 1 < f.nx, layout.element_cell[e] + 1);
    visit(y > 0, layout.element_cell[e] - f.nx);
    visit(y + 1 < f.ny, layout.element_cell[e] + f.nx);
    first_.push_back(static_cast<std::uint32_t>(element_.size()));
  }
}

template <int N>
std::vector<double> error_weights(const Problem<N>& problem, const Neighbours& neighbours,
                                  const SideValues<N>& irradiance) {
  double area = 0.0;
  double flux = 0.0;
  for (const SideIndex i : problem.sides.active) {
    area += static_cast<double>(problem.area(i));
    flux += static_cast<double>(problem.area(i)) * static_cast<double>(irradiance[i].mean());
  }
  std::vector<double> weights(problem.side_count(), 0.0);
  if (!(flux > 0.0)) return weights;
  const double least = 0.01 * flux / area;
  for (const SideIndex i : problem.sides.active) {
    double sum = static_cast<double>(irradiance[i].mean());
    double count = 1.0;
    neighbours.visit(i, [&](SideIndex j) {
      sum += static_cast<double>(irradiance[j].mean());
      count += 1.0;
    });
    const double scale = std::max(least, sum / count);
    weights[i] = static_cast<double>(problem.area(i)) / (area * scale * scale);
  }
  return weights;
}

template <int N>
std::vector<double> sample_variance(const Problem<N>& problem, const Neighbours& neighbours,
                                    const Tally<N>& tally, Samples whose) {
  std::vector<double> own(problem.side_count(), 0.0);
  double all = 0.0;
  for (const SideIndex i : problem.sides.active) {
    own[i] = tally.variance(i) * tally.valid(i);
    all += own[i];
  }
  const double mean = problem.sides.active.empty()
                          ? 0.0
                          : all / static_cast<double>(problem.sides.active.size());
  std::vector<double> result(problem.side_count(), 0.0);
  for (const SideIndex i : problem.sides.active) {
    double sum = whose == Samples::All ? own[i] : 0.0;
    double count = whose == Samples::All ? 1.0 : 0.0;
    neighbours.visit(i, [&](SideIndex j) {
      sum += own[j];
      count += 1.0;
    });
    result[i] = count > 0.0 ? sum / count : mean;
  }
  return result;
}

template <int N>
std::vector<std::vector<Draw>> plan_samples(const Problem<N>& problem,
                                            const std::vector<double>& weights,
                                            const std::vector<Stratum<N>>& strata, double target) {
  constexpr double kGrowth = 4.0;
  // Lagrange: n = lambda sqrt(weight * variance / cost); the sum of weight * variance / n is then
  // root_costs / lambda.
  double root_costs = 0.0;
  for (const Stratum<N>& s : strata)
    for (const SideIndex i : problem.sides.active)
      root_costs += std::sqrt(weights[i] * s.variance[i] * s.cost);
  const double lambda = root_costs / (target * target);
  std::vector<std::vector<Draw>> plans(strata.size());
  for (std::size_t c = 0; c < strata.size(); ++c) {
    const Stratum<N>& s = strata[c];
    for (const SideIndex i : problem.sides.active) {
      const double have = s.tally->valid(i);
      const double wanted = std::min(lambda * std::sqrt(weights[i] * s.variance[i] / s.cost),
                                     kGrowth * std::max(have, 1.0 * kReplicates));
      // Less than a quarter more is not worth a round.
      if (!(wanted > 1.25 * have)) continue;
      // Even numbers in each replicate; see HotPatches::kSamplesPerRay.
      const auto more = static_cast<std::uint32_t>(
          std::ceil((wanted - have) / (2.0 * kReplicates))) * 2;
      plans[c].push_back({i, more});
    }
  }
  return plans;
}

#define ATRIUM_INSTANTIATE(N)                                                                    \
  template std::vector<double> error_weights(const Problem<N>&, const Neighbours&,               \
                                             const SideValues<N>&);                              \
  template std::vector<double> sample_variance(const Problem<N>&, const Neighbours&,             \
                                               const Tally<N>&, Samples);                        \
  template std::vector<std::vector<Draw>> plan_samples(const Problem<N>&,                        \
                                                       const std::vector<double>&,               \
                                                       const std::vector<Stratum<N>>&, double);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
