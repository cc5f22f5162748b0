#pragma once

#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// The few sides that hold so much of the first-bounce light that hemisphere rays would rarely
/// find it (a sun patch, a wall next to a lamp). Receivers sample them like lights, and combine
/// that with what their hemisphere rays hit by chance (balance heuristic, Veach 1995): the
/// Monte Carlo form of shooting the hottest patches first (Southwell; Cohen et al. 1988).
template <int N>
class HotPatches {
 public:
  /// Samples of hot patches for each hemisphere ray of a receiver.
  static constexpr float kSamplesPerRay = 0.5f;

  HotPatches() = default;
  /// \param source  exchange irradiance from lights, by group and side.
  /// Empty if no small set of sides would carry most of the variance.
  HotPatches(const Problem<N>& problem, const std::vector<SideValues<N>>& source);

  [[nodiscard]] bool empty() const { return sides_.empty(); }
  [[nodiscard]] std::size_t size() const { return sides_.size(); }
  [[nodiscard]] bool contains(SideIndex i) const { return !empty() && density_[i] > 0.0f; }
  /// Density [1/m^2] with which sample() finds points on a side; 0 for sides that are not hot.
  [[nodiscard]] float density(SideIndex i) const { return density_[i]; }
  [[nodiscard]] SideIndex sample(float u) const;

 private:
  std::vector<SideIndex> sides_;
  std::vector<double> until_;   ///< cumulated share
  std::vector<float> density_;  ///< by side
};

}  // namespace atrium::radiosity
