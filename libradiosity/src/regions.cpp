#include "regions.h"

#include <algorithm>
#include <array>

namespace atrium::radiosity {
namespace {

struct Item {
  SideIndex side;
  std::array<float, 6> at;  ///< position, normal
};

template <int N>
std::vector<Item> items_of(const Problem<N>& problem) {
  std::vector<Item> items;
  items.reserve(problem.sides.active.size());
  for (const SideIndex i : problem.sides.active) {
    const ElementPoints::Spot spot = problem.points.spot(i / 2, 0.5f, 0.5f);
    const Vec3f n = normal_of(i, problem.points.ng(spot.fan));
    items.push_back(
        {i, {spot.position.x(), spot.position.y(), spot.position.z(), n.x(), n.y(), n.z()}});
  }
  return items;
}

/// The dimension in which the items differ most. Normals count by the size of the place: walls at a
/// right angle part before places do, a bent surface is parted by place.
std::size_t widest(std::span<const Item> items) {
  std::array<float, 6> low = items.front().at;
  std::array<float, 6> high = low;
  for (const Item& item : items)
    for (std::size_t d = 0; d < 6; ++d) {
      low[d] = std::min(low[d], item.at[d]);
      high[d] = std::max(high[d], item.at[d]);
    }
  std::array<float, 6> extent;
  for (std::size_t d = 0; d < 6; ++d) extent[d] = high[d] - low[d];
  const float size = std::max({extent[0], extent[1], extent[2]});
  for (std::size_t d = 3; d < 6; ++d) extent[d] *= 1.5f * size;
  return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
}

/// Puts the items that lie on one side first. \return  how many; neither none nor all.
std::size_t split(std::span<Item> items) {
  const std::size_t d = widest(items);
  const auto less = [d](const Item& a, const Item& b) {
    return a.at[d] != b.at[d] ? a.at[d] < b.at[d] : a.side < b.side;
  };
  if (d >= 3) {
    // In the middle between the normals: a median would cut through those of one wall.
    const auto [low, high] = std::minmax_element(items.begin(), items.end(), less);
    const float middle = 0.5f * (low->at[d] + high->at[d]);
    const auto end =
        std::partition(items.begin(), items.end(), [&](const Item& i) { return i.at[d] < middle; });
    const auto count = static_cast<std::size_t>(end - items.begin());
    if (count > 0 && count < items.size()) return count;
  }
  const auto half = static_cast<std::ptrdiff_t>(items.size() / 2);
  std::nth_element(items.begin(), items.begin() + half, items.end(), less);
  return static_cast<std::size_t>(half);
}

}  // namespace

template <int N>
Regions::Regions(const Problem<N>& problem) {
  std::vector<Item> items = items_of(problem);
  // The last range on the stack comes next, so regions are in the order of the tree.
  std::vector<std::span<Item>> todo;
  if (!items.empty()) todo.emplace_back(items);
  order_.reserve(items.size());
  while (!todo.empty()) {
    const std::span<Item> range = todo.back();
    todo.pop_back();
    if (range.size() <= kMost) {
      for (const Item& item : range) order_.push_back(item.side);
      first_.push_back(static_cast<std::uint32_t>(order_.size()));
      continue;
    }
    const auto half = static_cast<std::ptrdiff_t>(split(range));
    todo.push_back(range.subspan(static_cast<std::size_t>(half)));
    todo.push_back(range.first(static_cast<std::size_t>(half)));
  }
  // Members in ascending order, whatever the library's nth_element left.
  for (std::size_t r = 0; r < size(); ++r)
    std::sort(order_.begin() + first_[r], order_.begin() + first_[r + 1]);
}

template Regions::Regions(const Problem<1>&);
template Regions::Regions(const Problem<3>&);
template Regions::Regions(const Problem<4>&);
template Regions::Regions(const Problem<8>&);

}  // namespace atrium::radiosity
