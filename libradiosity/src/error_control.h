#pragma once

#include <optional>
#include <vector>

#include "smoothing.h"
#include "tally.h"

namespace atrium::radiosity {

/// How much a squared error of each side counts: area share over squared irradiance, which has a
/// floor of 1 % of the mean. Sides that no light reaches do not count: they would only make the
/// mean look better. The RMS over these is "the error" (docs/radiosity.md, Eq. 8).
/// \param share  of the area that counts, by side; empty: all.
template <int N>
[[nodiscard]] std::vector<double> error_weights(const Problem<N>& problem,
                                                const SideValues<N>& irradiance,
                                                const std::vector<float>& share = {});

/// Variance of one sample of each side (lane mean, of all groups or one), pooled as relative
/// variance: of the neighbours' samples for a decision about a side, which must not depend on the
/// samples that it stops; of its own and the neighbours' samples for the report, which four
/// replicates alone would make unsteady.
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
