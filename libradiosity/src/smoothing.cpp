#include "smoothing.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace atrium::radiosity {

using scene::SurfaceField;

Neighbours::Neighbours(const SurfaceField& layout)
    : edges_(edge_neighbours(layout)), level_(layout.element_level) {}

namespace {

/// What the neighbours along one axis say about a side.
struct Interpolation {
  struct Part {
    SideIndex side;
    double share;
  };
  std::array<Part, 4> parts;
  int count = 0;
  bool both = false;  ///< neighbours on both sides
};

/// Along axis 0 (edges 0 and 1) or 1 (edges 2 and 3). Neighbours without samples take no part.
template <class Usable>
Interpolation interpolation(const Neighbours& neighbours, SideIndex i, int axis, Usable&& usable) {
  Interpolation result;
  std::array<int, 2> count{};
  std::array<double, 2> distance{};
  neighbours.visit(i, [&](SideIndex j, int edge) {
    if (edge / 2 != axis || !usable(j)) return;
    const auto end = static_cast<std::size_t>(edge % 2);
    ++count[end];
    distance[end] = neighbours.distance(i, j);
    result.parts[static_cast<std::size_t>(result.count++)] = {j, static_cast<double>(end)};
  });
  result.both = count[0] > 0 && count[1] > 0;
  for (int k = 0; k < result.count; ++k) {
    double& share = result.parts[static_cast<std::size_t>(k)].share;
    const std::size_t end = share > 0.5 ? 1 : 0;
    const double whole = result.both ? distance[1 - end] / (distance[0] + distance[1]) : 1.0;
    share = whole / count[end];
  }
  return result;
}

}  // namespace

template <int N>
Smoothing<N>::Smoothing(const Problem<N>& problem, const Neighbours& neighbours,
                        const SideValues<N>& guide, const std::vector<double>& variance)
    : problem_(&problem), neighbours_(&neighbours) {
  const auto usable = [&](SideIndex j) {
    return problem.sides.is_active[j] != 0 && variance[j] > 0.0;
  };
  struct Said {
    double variance = 0.0;
    double miss = 0.0;  ///< squared, with the noise in it
    int ends = 0;
  };
  std::vector<std::array<Said, 2>> said(problem.side_count());
  for (const SideIndex i : problem.sides.active) {
    if (!(variance[i] > 0.0)) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const Interpolation p = interpolation(neighbours, i, axis, usable);
      if (p.count == 0) continue;
      Said& s = said[i][static_cast<std::size_t>(axis)];
      double d = static_cast<double>(guide[i].mean());
      for (int k = 0; k < p.count; ++k) {
        const auto [j, share] = p.parts[static_cast<std::size_t>(k)];
        d -= share * static_cast<double>(guide[j].mean());
        s.variance += share * share * variance[j];
      }
      s.miss = d * d;
      s.ends = p.both ? 2 : 1;
    }
  }
  for (const SideIndex i : problem.sides.active) {
    std::array<double, 2> precision{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Said& s = said[i][axis];
      if (s.ends == 0) continue;
      double sum = s.miss;
      double count = 1.0;
      neighbours.visit(i, [&](SideIndex j, int) {
        const Said& other = said[j][axis];
        if (other.ends != s.ends) return;
        sum += other.miss;
        count += 1.0;
      });
      precision[axis] = 1.0 / (s.variance + sum / count);
    }
    const double own = variance[i] > 0.0 ? 1.0 / variance[i] : 0.0;
    const double all = own + precision[0] + precision[1];
    std::array<Interpolation, 2> along;
    for (int axis = 0; axis < 2; ++axis)
      if (precision[static_cast<std::size_t>(axis)] > 0.0)
        along[static_cast<std::size_t>(axis)] = interpolation(neighbours, i, axis, usable);
    neighbours.visit(i, [&](SideIndex j, int edge) {
      const auto axis = static_cast<std::size_t>(edge / 2);
      double weight = 0.0;
      for (int k = 0; k < along[axis].count; ++k) {
        const auto& part = along[axis].parts[static_cast<std::size_t>(k)];
        if (part.side == j) weight = part.share * precision[axis] / all;
      }
      weight_.push_back(static_cast<float>(weight));
    });
  }
  complete();
}

template <int N>
Smoothing<N>::Smoothing(const Problem<N>& problem, const Neighbours& neighbours,
                        std::vector<float> weight)
    : problem_(&problem), neighbours_(&neighbours), weight_(std::move(weight)) {
  std::size_t count = 0;
  for (const SideIndex i : problem.sides.active)
    neighbours.visit(i, [&](SideIndex, int) { ++count; });
  if (weight_.size() != count) throw std::invalid_argument("Smoothing: weights of other sides");
  complete();
}

template <int N>
void Smoothing<N>::complete() {
  own_.assign(problem_->side_count(), 1.0f);
  std::size_t at = 0;
  for (const SideIndex i : problem_->sides.active) {
    neighbours_->visit(i, [&](SideIndex, int) { own_[i] -= weight_[at++]; });
    own_[i] = std::max(0.0f, own_[i]);  // rounding
  }
}

template <int N>
SideValues<N> Smoothing<N>::operator()(const SideValues<N>& values) const {
  SideValues<N> result(values.size());
  std::size_t at = 0;
  for (const SideIndex i : problem_->sides.active) {
    result[i] = own_[i] * values[i];
    neighbours_->visit(i, [&](SideIndex j, int) { result[i] += weight_[at++] * values[j]; });
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
