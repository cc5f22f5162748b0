#pragma once

#include <optional>
#include <vector>

#include "tally.h"

namespace atrium::radiosity {

/// Which sides lie next to each other in the same surface, on the same side: neighbours have
/// nearly the same light but samples of their own.
class Neighbours {
 public:
  explicit Neighbours(const scene::SurfaceField& layout);
  template <class F>
  void visit(SideIndex i, F&& f) const {
    for (std::uint32_t k = first_[i / 2]; k < first_[i / 2 + 1]; ++k)
      f(side_index(element_[k], side_of(i)));
  }

 private:
  std::vector<std::uint32_t> first_, element_;
};

/// Weights of a smoothing over every side and its neighbours that takes noise off a field and
/// leaves what is more than noise: a neighbour counts less the more standard errors its value is
/// away, so more samples mean less smoothing.
template <int N>
class Smoothing {
 public:
  /// \param guide  noisy values by side. \param variance  of their lane means.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, const SideValues<N>& guide,
            const std::vector<double>& variance);
  /// \param weight  weights() of another one for the same sides.
  Smoothing(const Problem<N>& problem, const Neighbours& neighbours, std::vector<float> weight)
      : problem_(&problem), neighbours_(&neighbours), weight_(std::move(weight)) {}
  [[nodiscard]] SideValues<N> operator()(const SideValues<N>& values) const;
  [[nodiscard]] const std::vector<float>& weights() const { return weight_; }
  /// Are there as many weights as neighbours?
  [[nodiscard]] bool fits() const {
    std::size_t count = 0;
    for (const SideIndex i : problem_->sides.active)
      neighbours_->visit(i, [&](SideIndex) { ++count; });
    return weight_.size() == count;
  }

 private:
  const Problem<N>* problem_;
  const Neighbours* neighbours_;
  std::vector<float> weight_;  ///< in the order that Neighbours visits active sides
};

/// How much a squared error of each side counts: area share over squared irradiance, which has a
/// floor of 1 % of the mean. Only area outside closed bodies counts. Sides that no light reaches do not count: they would only make the
/// mean look better. The RMS over these is "the error" (docs/radiosity.md, Eq. 8).
template <int N>
[[nodiscard]] std::vector<double> error_weights(const Problem<N>& problem,
                                                const SideValues<N>& irradiance,
                                                const std::vector<float>& exposed);

/// Variance of one sample of each side (lane mean, of all groups or one), pooled as relative variance: of the
/// neighbours' samples for a decision about a side, which must not depend on the samples that it
/// stops; of its own and the neighbours' samples for the report, which four replicates alone would
/// make unsteady.
enum class Samples { Neighbours, All };
using GroupChoice = std::optional<std::size_t>;
inline constexpr GroupChoice kAllGroups = std::nullopt;
template <int N>
[[nodiscard]] std::vector<double> sample_variance(const Problem<N>& problem,
                                                  const Neighbours& neighbours,
                                                  const Tally<N>& tally, Samples whose,
                                                  GroupChoice group = kAllGroups);

/// One kind of sampling.
template <int N>
struct Stratum {
  const Tally<N>* tally;
  std::vector<double> variance;  ///< of one sample, Samples::Neighbours
  double cost;                   ///< rays per sample
};

/// What to draw next so that the root of the sum over strata of weight * variance / samples falls
/// to `share` of what it is, at the least cost (Neyman allocation: samples as the root of weighted
/// variance over cost); no side gets more than four times what it has. Where only a share of the
/// points lies outside closed bodies a sample costs as many draws more.
/// \param exposed  that share, by side.
template <int N>
[[nodiscard]] std::vector<std::vector<Draw>> plan_samples(const Problem<N>& problem,
                                                          const std::vector<double>& weights,
                                                          const std::vector<float>& exposed,
                                                          const std::vector<Stratum<N>>& strata,
                                                          double share);

}  // namespace atrium::radiosity
