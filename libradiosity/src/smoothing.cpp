#include "smoothing.h"

#include <algorithm>
#include <stdexcept>

namespace atrium::radiosity {

Neighbours::Neighbours(const scene::SurfaceField& layout) : edges_(edge_neighbours(layout)) {}

template <int N>
Smoothing<N>::Smoothing(const Problem<N>& problem, const Neighbours& neighbours,
                        const SideValues<N>& guide, const std::vector<double>& variance)
    : problem_(&problem), neighbours_(&neighbours) {
  for (const SideIndex i : problem.sides.active)
    neighbours.visit(i, [&](SideIndex j) {
      const double d = static_cast<double>(guide[i].mean()) - static_cast<double>(guide[j].mean());
      const double v = variance[i] + variance[j];
      const bool takes_part = problem.sides.is_active[j] != 0 && v > 0.0;
      // What i gives to j it takes from j: area times weight is the same in both directions. Four
      // neighbours of the same size that are no more than noise away make a mean of five.
      const float share = std::min(problem.area(i), problem.area(j)) / (5.0f * problem.area(i));
      weight_.push_back(takes_part ? share * static_cast<float>(v / (v + d * d)) : 0.0f);
    });
}

template <int N>
Smoothing<N>::Smoothing(const Problem<N>& problem, const Neighbours& neighbours,
                        std::vector<float> weight)
    : problem_(&problem), neighbours_(&neighbours), weight_(std::move(weight)) {
  std::size_t count = 0;
  for (const SideIndex i : problem.sides.active) neighbours.visit(i, [&](SideIndex) { ++count; });
  if (weight_.size() != count) throw std::invalid_argument("Smoothing: weights of other sides");
}

template <int N>
SideValues<N> Smoothing<N>::operator()(const SideValues<N>& values) const {
  SideValues<N> result(values.size());
  std::size_t at = 0;
  for (const SideIndex i : problem_->sides.active) {
    result[i] = values[i];
    neighbours_->visit(i,
                       [&](SideIndex j) { result[i] += weight_[at++] * (values[j] - values[i]); });
  }
  return result;
}

template <int N>
std::vector<double> Smoothing<N>::variance(const std::vector<double>& of_values, double share,
                                           double rest) const {
  std::vector<double> result(of_values.size(), 0.0);
  std::size_t at = 0;
  for (const SideIndex i : problem_->sides.active) {
    double given = 0.0;
    double others = 0.0;
    neighbours_->visit(i, [&](SideIndex j) {
      const auto w = static_cast<double>(weight_[at++]);
      given += w;
      others += w * w * of_values[j];
    });
    const double own = share * (1.0 - given) + rest;
    result[i] = own * own * of_values[i] + share * share * others;
  }
  return result;
}

#define ATRIUM_INSTANTIATE(N) template class Smoothing<N>;
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
