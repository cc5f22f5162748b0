#include "error_measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "point_reference.h"

namespace atrium::measure {
namespace {

double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share) {
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0.0;
  for (const auto& [v, w] : value_weight) total += w;
  double sum = 0.0;
  for (const auto& [v, w] : value_weight)
    if ((sum += w) >= share * total) return v;
  return value_weight.empty() ? 0.0 : value_weight.back().first;
}

ErrorMeasure measure(const std::vector<double>& x, const std::vector<double>& reference,
                     const std::vector<double>& variance, const std::vector<double>& weights) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double mean = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) mean += weights[i] * reference[i] / total;
  const double floor = error_floor(mean);
  ErrorMeasure m;
  double square = 0.0;
  double noise = 0.0;
  double spread = 0.0;
  std::vector<std::pair<double, double>> sizes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double scale = std::max(reference[i], floor);
    const double e = scale > 0.0 ? (x[i] - reference[i]) / scale : 0.0;
    const double v = scale > 0.0 ? variance[i] / (scale * scale) : 0.0;
    const double w = weights[i] / total;
    m.bias += w * e;
    square += w * (e * e - v);
    spread += w * w * std::pow(e * e - v, 2);
    noise += w * v;
    m.worst = std::max(m.worst, std::abs(e));
    sizes.emplace_back(std::abs(e), w);
  }
  const double deviation = 1.96 * std::sqrt(std::max(0.0, spread));
  m.rms = std::sqrt(std::max(0.0, square));
  m.low = std::sqrt(std::max(0.0, square - deviation));
  m.high = std::sqrt(std::max(0.0, square + deviation));
  m.noise = std::sqrt(noise);
  m.p95 = weighted_quantile(std::move(sizes), 0.95);
  return m;
}

}  // namespace

ErrorMeasure measure_error(const std::vector<double>& values, const PointValues& reference) {
  return measure(values, reference.mean, reference.variance,
                 std::vector<double>(values.size(), 1.0));
}

ErrorMeasure measure_error(const std::vector<double>& values, const std::vector<double>& reference,
                           const std::vector<double>& weights) {
  return measure(values, reference, std::vector<double>(values.size(), 0.0), weights);
}

}  // namespace atrium::measure
