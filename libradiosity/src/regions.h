#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// The active sides in groups of at most kMost that lie close together and face alike, across
/// surfaces and objects: what a few samples of one side cannot say (a lamp that one of hundreds
/// finds), those of its region can.
class Regions {
 public:
  static constexpr std::size_t kMost = 32;

  template <int N>
  explicit Regions(const Problem<N>& problem);

  [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
  [[nodiscard]] std::span<const SideIndex> members(std::size_t region) const {
    return {order_.data() + first_[region], order_.data() + first_[region + 1]};
  }
  /// All active sides, those of a region behind each other, regions that are close too.
  [[nodiscard]] const std::vector<SideIndex>& order() const { return order_; }

 private:
  std::vector<SideIndex> order_;
  std::vector<std::uint32_t> first_{0};  ///< into order_, by region; size() + 1
};

}  // namespace atrium::radiosity
