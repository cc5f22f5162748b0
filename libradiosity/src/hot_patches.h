#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "problem.h"

namespace atrium::radiosity {

/// The few sides that hold so much of the first-bounce light that hemisphere rays would rarely
/// find it (a sun patch, a wall next to a lamp). Receivers sample them like lights, and combine
/// that with what their hemisphere rays hit by chance (balance heuristic, Veach 1995): the
/// Monte Carlo form of shooting the hottest patches first (Southwell; Cohen et al. 1988). Sides of
/// translucent sheets are never hot.
template <int N>
class HotPatches {
 public:
  HotPatches() = default;
  /// \param source  exchange irradiance from lights, by group and side.
  /// Empty if no small set of sides would carry most of the variance.
  HotPatches(const Problem<N>& problem, std::vector<SideValues<N>> source);

  /// For both directions, see scene/archive.h.
  template <class Archive>
  void archive(Archive& a) {
    auto groups = static_cast<std::uint64_t>(source_.size());
    a(groups);
    source_.resize(std::min<std::uint64_t>(groups, scene::kMostLightGroups));
    for (SideValues<N>& s : source_) a(s);
    a(sides_);
    a(until_);
    a(density_);
  }

  [[nodiscard]] bool is_for(std::size_t sides, std::size_t groups) const {
    if (sides_.empty()) return true;
    bool ok =
        until_.size() == sides_.size() && density_.size() == sides && source_.size() == groups;
    for (const SideIndex i : sides_) ok = ok && i < sides;
    for (const SideValues<N>& s : source_) ok = ok && s.size() == sides;
    return ok;
  }

  [[nodiscard]] bool empty() const { return sides_.empty(); }
  [[nodiscard]] std::size_t size() const { return sides_.size(); }
  [[nodiscard]] const std::vector<SideIndex>& sides() const { return sides_; }
  /// Their light is known better now: groups of sources by side.
  void set_source(std::vector<SideValues<N>> source) { source_ = std::move(source); }
  /// Hot sides read as dark by whoever counts their first light on its own.
  [[nodiscard]] SideValues<N> without_hot(SideValues<N> source) const {
    for (const SideIndex i : sides_) source[i] = {};
    return source;
  }
  [[nodiscard]] bool contains(SideIndex i) const { return !empty() && density_[i] > 0.0f; }
  /// Density [1/m^2] with which sample() finds points on a side; 0 for sides that are not hot.
  [[nodiscard]] float density(SideIndex i) const { return density_[i]; }
  [[nodiscard]] SideIndex sample(float u) const;
  [[nodiscard]] std::size_t groups() const { return source_.size(); }
  /// Exchange irradiance of a side straight from the lights: what is shot.
  [[nodiscard]] const Spectrum<N>& source(SideIndex i, std::size_t group) const {
    return source_[group][i];
  }
  /// Balance heuristic: the part of the shot light of side j that a hemisphere ray accounts for
  /// which found it by chance; samples of the patches account for the rest. One without hot sides.
  /// \param d  from receiver to the point hit. \param cosines  at the receiver, at the point; > 0.
  [[nodiscard]] float share_of_chance(SideIndex j, const Vec3f& d, float receiver_cosine,
                                      float sender_cosine) const {
    if (!contains(j) || !(sender_cosine > 0.0f)) return 1.0f;
    const float chance = receiver_cosine * std::numbers::inv_pi_v<float>;
    return chance / (chance + density_[j] * d.squaredNorm() / sender_cosine);
  }

 private:
  std::vector<SideValues<N>> source_;
  std::vector<SideIndex> sides_;
  std::vector<double> until_;   ///< cumulated share
  std::vector<float> density_;  ///< by side
};

}  // namespace atrium::radiosity
