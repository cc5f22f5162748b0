#pragma once

#include <vector>

#include "passes.h"
#include "smoothing.h"

namespace atrium::radiosity {

/// Sides of a mesh by those of the mesh that it was divided from.
class SideParents {
 public:
  /// \param parent  by element; empty: the same elements. \param sides  of the new mesh.
  SideParents(const std::vector<std::uint32_t>& parent, std::size_t sides);

  [[nodiscard]] std::size_t old_sides() const { return whole_.size() * 2; }
  [[nodiscard]] SideIndex of(SideIndex i) const {
    return parent_.empty() ? i : 2 * parent_[i / 2] + (i & 1U);
  }
  /// Is a side all of its parent?
  [[nodiscard]] bool whole(SideIndex i) const { return whole_[of(i) / 2] != 0; }
  /// Values of the new sides, given those of the old ones.
  template <class T>
  [[nodiscard]] std::vector<T> spread(const std::vector<T>& old) const {
    std::vector<T> values(sides_);
    for (SideIndex i = 0; i < sides_; ++i) values[i] = old[of(i)];
    return values;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> whole_;  ///< by old element
  std::size_t sides_;
};

/// What a side's row says of a field x and of the change y of a field: variances of the means of
/// its rays, and their covariance. Rays count as independent: an upper bound for stratified ones.
struct RowMoments {
  double x = 0.0, y = 0.0, xy = 0.0;
};

/// What hemisphere rays read of one group: exchange irradiance by side, and how much of it the
/// rows' hot sums stand for instead (the light of hot patches straight from the lights).
template <int N>
struct ReadField {
  SideValues<N> all;                  ///< everything
  SideValues<N> entries;              ///< what is read through the rows' entries
  std::vector<Spectrum<N>> hot_sums;  ///< Rows::hot of this group: plain and body by active side
};

/// The field without the light that hot patches got first.
template <int N>
[[nodiscard]] SideValues<N> without_first_light(SideValues<N> field, const HotPatches<N>& hot,
                                                std::size_t group);
/// Hot sums of one group.
template <int N>
[[nodiscard]] std::vector<Spectrum<N>> hot_sums_of(const std::vector<Spectrum<N>>& hot,
                                                   std::size_t groups, std::size_t group,
                                                   std::size_t active);

/// Brings samples of light straight from the lights up to date where others of the scene's lights
/// (one group) have changed: what is gone is taken off and what was added is put on, from few
/// samples of these alone. Far from them that is 0, so that only sides that they light are sampled
/// again. Whether the difference adds more noise than the samples have say a side's neighbours.
/// \param before  the lights that the samples of `direct` are of.
/// \return  the sides that start again; their samples are forgotten.
template <int N>
[[nodiscard]] std::vector<SideIndex> bring_direct(const Problem<N>& problem,
                                                  const Neighbours& neighbours,
                                                  const std::vector<scene::Light>& before,
                                                  Tally<N>& direct, Work& work,
                                                  scene::Counters& counters);

/// Samples that read a field which has changed since, brought up to date through the rows: the same
/// as if a control variate of known change had been added. It costs no ray, and it is worth it as
/// long as the rows' noise on the change adds no more than what samples of a side have.
template <int N>
class BroughtSamples {
 public:
  /// Shifts the samples of `gathered` from `before` to `now` (by group), and starts the sides again
  /// where that is not worth it. Whether it is say the rows of a side's neighbours, never its own:
  /// a row that found what has changed by chance would be replaced, one that missed it would stay.
  BroughtSamples(const Problem<N>& problem, const Neighbours& neighbours, const Rows<N>& rows,
                 const std::vector<ReadField<N>>& before, const std::vector<ReadField<N>>& now,
                 Tally<N>& gathered);
  BroughtSamples() = default;

  /// What that adds to the variance of a side's pooled estimate.
  /// \param gathered  the samples now, \param fresh  their share in it.
  /// \param group  of the groups; as many as there are: of their sum.
  [[nodiscard]] double variance(SideIndex i, std::size_t group, double fresh,
                                const Tally<N>& gathered) const;
  /// To be called before the first round of `gathered` ends.
  void end_first_round(const Tally<N>& gathered);

  [[nodiscard]] std::size_t groups() const { return moments_.size(); }
  template <class Archive>
  void archive(Archive& a) {
    auto groups = static_cast<std::uint64_t>(moments_.size());
    a(groups);
    moments_.resize(std::min<std::uint64_t>(groups, scene::kMostLightGroups + 1));
    for (std::vector<RowMoments>& m : moments_) a(m);
    a(count_);
    a(part_);
  }
  [[nodiscard]] bool is_for(std::size_t sides, std::size_t groups) const;

 private:
  std::vector<std::vector<RowMoments>> moments_;  ///< by group, the last of their sum; by side
  std::vector<std::uint32_t> count_;              ///< samples that were shifted
  std::vector<float> part_;  ///< of the first round, after its end: share of these
};

}  // namespace atrium::radiosity
