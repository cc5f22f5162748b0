#include "error_measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "point_reference.h"

namespace atrium::bench {
namespace {

/// An |e| with its share of the weights and of the reference's variance.
struct Size {
  double e, weight, variance;
};

/// Quantile and mean square below the quantile of errors that are sorted.
double quantile(const std::vector<Size>& sizes, double share) {
  double sum = 0.0;
  for (const Size& s : sizes)
    if ((sum += s.weight) >= share) return s.e;
  return sizes.empty() ? 0.0 : sizes.back().e;
}
double square_below(const std::vector<Size>& sizes, double limit) {
  double sum = 0.0;
  double weight = 0.0;
  for (const Size& s : sizes) {
    if (s.e > limit) break;
    sum += s.weight * (s.e * s.e - s.variance);
    weight += s.weight;
  }
  return weight > 0.0 ? std::max(0.0, sum / weight) : 0.0;
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
  double differences = 0.0;
  double values = 0.0;
  std::vector<Size> sizes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double scale = std::max(reference[i], floor);
    const double e = scale > 0.0 ? (x[i] - reference[i]) / scale : 0.0;
    const double v = scale > 0.0 ? variance[i] / (scale * scale) : 0.0;
    const double w = weights[i] / total;
    m.bias += w * e;
    square += w * (e * e - v);
    spread += w * w * std::pow(e * e - v, 2);
    noise += w * v;
    differences += w * (std::pow(x[i] - reference[i], 2) - variance[i]);
    values += w * std::pow(reference[i], 2);
    m.worst = std::max(m.worst, std::abs(e));
    sizes.push_back({std::abs(e), w, v});
  }
  const double deviation = 1.96 * std::sqrt(std::max(0.0, spread));
  m.rms = std::sqrt(std::max(0.0, square));
  m.low = std::sqrt(std::max(0.0, square - deviation));
  m.high = std::sqrt(std::max(0.0, square + deviation));
  m.noise = std::sqrt(noise);
  m.absolute = values > 0.0 ? std::sqrt(std::max(0.0, differences) / values) : 0.0;
  std::sort(sizes.begin(), sizes.end(), [](const Size& a, const Size& b) { return a.e < b.e; });
  m.p95 = quantile(sizes, 0.95);
  m.most = std::sqrt(square_below(sizes, quantile(sizes, 0.99)));
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

}  // namespace atrium::bench
