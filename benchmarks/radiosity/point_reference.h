#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "receivers.h"
#include "scene/sampler.h"

namespace atrium::bench {

/// One sample of the irradiance [unit of the scene] that arrives at a receiver: a path from it with
/// light sampling at every vertex, weighted against the hits by the power heuristic (Veach 1997,
/// Eq. 9.13), Russian roulette after four vertices. Unbiased; knows nothing of elements.
[[nodiscard]] double irradiance_sample(const scene::Shading<1>& shading, const Receiver& receiver,
                                       scene::Sampler& sampler, scene::Counters& counters);

/// Irradiance of receivers with the variance of each value.
struct PointValues {
  std::vector<double> mean, variance;
  std::uint64_t rays = 0;

  /// Mean over the receivers; as they are uniform by area, the area mean.
  [[nodiscard]] double area_mean() const;
  /// RMS of the standard errors, relative as relative_error() counts.
  [[nodiscard]] double noise() const;
};

/// The same number of paths for every receiver, in independent randomised groups.
/// \param paths  rounded up to a multiple of the groups.
[[nodiscard]] PointValues trace_receivers(const Workload& workload,
                                          const std::vector<Receiver>& receivers,
                                          std::uint32_t paths, std::uint64_t seed);

struct ReferenceOptions {
  double noise = 0.003;                ///< of the whole, see PointValues::noise()
  std::uint64_t max_rays = 300000000;  ///< about; then the noise is what it is
  std::uint64_t seed = 0x5eedf00d;
  std::filesystem::path cache;  ///< folder for finished references; empty: none
};

/// Reference values: a pilot says how noisy each receiver is, fresh paths in proportion make the
/// value, so that what stops the sampling is no part of the result.
/// \throws RuntimeFailure  if the cache cannot be written.
[[nodiscard]] PointValues reference_values(const Workload& workload,
                                           const std::vector<Receiver>& receivers,
                                           const ReferenceOptions& options);

}  // namespace atrium::bench
