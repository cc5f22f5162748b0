#pragma once

#include <vector>

namespace atrium::bench {

struct PointValues;

/// Errors are relative to the value, but never to less than 1 % of the area mean.
[[nodiscard]] inline double error_floor(double area_mean) { return 0.01 * area_mean; }

/// How far values are from a reference: e_i = (x_i - r_i) / max(r_i, 1 % of the mean of r).
struct ErrorMeasure {
  double rms = 0.0;  ///< without the reference's noise (its variance is subtracted); >= 0
  double low = 0.0, high = 0.0;  ///< 95 % interval of rms
  double absolute = 0.0;         ///< RMS of x - r over RMS of r, noise as in rms
  double bias = 0.0;             ///< mean of e
  double most = 0.0;             ///< rms without the largest 1 % of the errors
  double p95 = 0.0;              ///< of |e|, the reference's noise included
  double worst = 0.0;            ///< likewise
  double noise = 0.0;            ///< RMS of the reference's own standard errors
};

/// \param values  one for each receiver; all stand for the same area.
[[nodiscard]] ErrorMeasure measure_error(const std::vector<double>& values,
                                         const PointValues& reference);

/// The same with weights (areas) and a reference without noise.
[[nodiscard]] ErrorMeasure measure_error(const std::vector<double>& values,
                                         const std::vector<double>& reference,
                                         const std::vector<double>& weights);

}  // namespace atrium::bench
