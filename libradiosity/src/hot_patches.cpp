#include "hot_patches.h"

#include <algorithm>

namespace atrium::radiosity {
namespace {

/// A hemisphere ray's variance grows with area times squared radiosity. Hot is what lies far above
/// the mean; it is worth rays of its own if it holds most of that and few sides of the area.
constexpr double kFarAbove = 4.0;
constexpr double kWorthwhile = 0.3;
constexpr double kFew = 0.1;

}  // namespace

template <int N>
HotPatches<N>::HotPatches(const Problem<N>& problem, const Regions& regions,
                          std::vector<SideValues<N>> source) {
  const std::vector<SideIndex>& active = regions.order();
  std::vector<double> radiosity(active.size(), 0.0);
  double area = 0.0;
  double flux = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const SideIndex i = active[k];
    for (const SideValues<N>& s : source)
      radiosity[k] += static_cast<double>(
          (problem.sides.reflectance[i] * s[i] + problem.sides.transmittance[i] * s[i ^ 1U])
              .mean());
    const double a = static_cast<double>(problem.area(i));
    area += a;
    flux += a * radiosity[k];
    squares += a * radiosity[k] * radiosity[k];
  }
  if (!(flux > 0.0)) return;
  const double threshold = kFarAbove * flux / area;
  double hot_flux = 0.0;
  double hot_area = 0.0;
  double hot_squares = 0.0;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const SideIndex i = active[k];
    // Light that comes through a sheet stays with the hemisphere rays.
    if (!(radiosity[k] > threshold) || !problem.sides.transmittance[i].is_zero() ||
        !problem.sides.transmittance[i ^ 1U].is_zero())
      continue;
    const double a = static_cast<double>(problem.area(i));
    sides_.push_back(i);
    hot_flux += a * radiosity[k];
    hot_area += a;
    hot_squares += a * radiosity[k] * radiosity[k];
    until_.push_back(hot_flux);
  }
  if (sides_.empty() || hot_squares < kWorthwhile * squares || hot_area > kFew * area) {
    sides_.clear();
    return;
  }
  density_.assign(problem.side_count(), 0.0f);
  for (std::size_t h = 0; h < sides_.size(); ++h) {
    const double share = (until_[h] - (h > 0 ? until_[h - 1] : 0.0)) / hot_flux;
    density_[sides_[h]] = static_cast<float>(share / static_cast<double>(problem.area(sides_[h])));
  }
  for (double& u : until_) u /= hot_flux;
  strength_ = static_cast<float>(hot_squares / hot_flux);
  group(regions);
  source_ = std::move(source);
}

/// Neighbouring regions together, as many as it takes to have few groups.
template <int N>
void HotPatches<N>::group(const Regions& regions) {
  const std::size_t regions_of_one = (regions.size() + kMostGroups - 1) / kMostGroups;
  group_of_.assign(density_.size(), 0);
  std::size_t next = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (r % regions_of_one == 0 && (group_first_.empty() || group_first_.back() != next))
      group_first_.push_back(static_cast<std::uint32_t>(next));
    for (const SideIndex i : regions.members(r)) {
      if (!(density_[i] > 0.0f)) continue;
      group_of_[i] = static_cast<std::uint32_t>(group_first_.size() - 1);
      ++next;
    }
  }
  if (group_first_.back() != next) group_first_.push_back(static_cast<std::uint32_t>(next));
}

template <int N>
float HotPatches<N>::share_of(std::uint32_t group) const {
  const std::uint32_t first = group_first_[group];
  return static_cast<float>(until_[group_first_[group + 1] - 1] -
                            (first > 0 ? until_[first - 1] : 0.0));
}

template <int N>
SideIndex HotPatches<N>::sample_in(std::uint32_t group, float u) const {
  const std::uint32_t first = group_first_[group];
  const double from = first > 0 ? until_[first - 1] : 0.0;
  const auto end = until_.begin() + group_first_[group + 1];
  const double x = from + static_cast<double>(u) * (*(end - 1) - from);
  const auto it = std::upper_bound(until_.begin() + first, end - 1, x);
  return sides_[static_cast<std::size_t>(it - until_.begin())];
}

template <int N>
SideIndex HotPatches<N>::sample(float u) const {
  const auto it = std::upper_bound(until_.begin(), until_.end() - 1, static_cast<double>(u));
  return sides_[static_cast<std::size_t>(it - until_.begin())];
}

template class HotPatches<1>;
template class HotPatches<3>;
template class HotPatches<4>;
template class HotPatches<8>;

}  // namespace atrium::radiosity
