#pragma once

#include <optional>
#include <vector>

#include "regions.h"
#include "tally.h"

namespace atrium::radiosity {

/// How much a squared error of each side counts: area share over squared irradiance, which has a
/// floor of 1 % of the mean. Sides that no light reaches do not count: they would only make the
/// mean look better. The RMS over these is "the error" (docs/radiosity.md, Eq. 8).
/// \param irradiance  lane means by side; 0: unlit. \param share  of the area that counts, by side;
/// empty: all.
template <int N>
[[nodiscard]] std::vector<double> error_weights(const Problem<N>& problem,
                                                const std::vector<double>& irradiance,
                                                const std::vector<float>& share = {});

using GroupChoice = std::optional<std::size_t>;
inline constexpr GroupChoice kAllGroups = std::nullopt;

/// Mean of one group or of the sum of all (lane mean).
template <int N>
[[nodiscard]] double total_of(const Tally<N>& tally, SideIndex i, GroupChoice group) {
  return group ? static_cast<double>(tally.mean(i, *group).mean()) : tally.total(i);
}

/// Variance of each side's mean (lane mean, of all groups or one). The spread of a few replicates
/// is unsteady, so it is put together with the relative variance of the region's sides.
template <int N>
[[nodiscard]] std::vector<double> mean_variance(const Problem<N>& problem, const Regions& regions,
                                                const Tally<N>& tally,
                                                GroupChoice group = kAllGroups);

/// Variance of one further sample of each side, as far as the samples so far let expect: what low
/// discrepancy leaves of the spread of a side's samples and, the more the fewer these are, of its
/// region's. To that comes what all of them may have missed: of a region's n samples the next one
/// finds something new with probability 1 / (n + 1) at most (Laplace's rule of succession).
/// \param strongest  value of a sample that finds what is strongest, by region.
template <int N>
[[nodiscard]] std::vector<double> expected_variance(const Problem<N>& problem,
                                                    const Regions& regions, const Tally<N>& tally,
                                                    const std::vector<double>& strongest);

/// One kind of sampling.
template <int N>
struct Stratum {
  const Tally<N>* tally;
  std::vector<double> variance;  ///< expected_variance()
  double cost;                   ///< rays per sample
};

/// Effort of a round by Neyman allocation: a side gets effort * root(weight * variance / cost)
/// samples. The least that brings the sum over strata to `squared_error`, where the round's
/// estimate joins earlier ones in proportion to their reciprocal variances, but no more than
/// `most_cost`. \param weights  error_weights(). \param exposed  share of points outside closed
/// bodies, by side: a sample costs as many draws more. \param so_far  weighted variance of each
/// stratum.
template <int N>
[[nodiscard]] double round_effort(const Problem<N>& problem, const std::vector<double>& weights,
                                  const std::vector<float>& exposed,
                                  const std::vector<Stratum<N>>& strata,
                                  const std::vector<double>& so_far, double squared_error,
                                  double most_cost);

/// The round's samples: no side gets more than eight times the samples that it has had, and none
/// fewer than one in each replicate. Sides that have had none take no part.
template <int N>
[[nodiscard]] std::vector<Draw> plan_round(const Problem<N>& problem,
                                           const std::vector<double>& weights,
                                           const std::vector<float>& exposed,
                                           const Stratum<N>& stratum, double effort);

}  // namespace atrium::radiosity
