#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "problem.h"
#include "regions.h"

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
  HotPatches(const Problem<N>& problem, const Regions& regions, std::vector<SideValues<N>> source);

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
    a(group_first_);
    a(group_of_);
    a(strength_);
  }

  [[nodiscard]] bool is_for(std::size_t sides, std::size_t groups) const {
    if (sides_.empty()) return true;
    bool ok =
        until_.size() == sides_.size() && density_.size() == sides && source_.size() == groups;
    for (const SideIndex i : sides_) ok = ok && i < sides;
    ok = ok && group_of_.size() == sides && group_first_.size() > 1 && group_first_[0] == 0 &&
         group_first_.back() == sides_.size();
    for (std::size_t g = 0; ok && g < group_count(); ++g)
      ok = group_first_[g] < group_first_[g + 1];
    for (const std::uint32_t g : group_of_) ok = ok && g < group_count();
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
  /// Groups of patches close together, at most kMostGroups.
  static constexpr std::size_t kMostGroups = 256;
  [[nodiscard]] std::size_t group_count() const {
    return group_first_.empty() ? 0 : group_first_.size() - 1;
  }
  [[nodiscard]] std::uint32_t group_of(SideIndex i) const { return group_of_[i]; }
  /// Probability that sample() finds one of a group.
  [[nodiscard]] float share_of(std::uint32_t group) const;
  /// Like sample(), within a group.
  [[nodiscard]] SideIndex sample_in(std::uint32_t group, float u) const;
  /// First radiosity, lane mean over the flux.
  [[nodiscard]] float strength() const { return strength_; }
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
  void group(const Regions& regions);

  std::vector<SideValues<N>> source_;
  std::vector<SideIndex> sides_;
  std::vector<double> until_;               ///< cumulated share
  std::vector<float> density_;              ///< by side
  std::vector<std::uint32_t> group_first_;  ///< into sides_, by group; group_count() + 1
  std::vector<std::uint32_t> group_of_;     ///< by side; 0 for sides that are not hot
  float strength_ = 0.0f;
};

}  // namespace atrium::radiosity
