#include "range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace atrium::view {
namespace {

constexpr double kDecades = 4.0;  // of a logarithmic range, at most

double power_below(double value) { return std::pow(10.0, std::floor(std::log10(value))); }

/// The next round number that is not less.
double round_up(double value) {
  const double power = power_below(value);
  for (const double m : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (m * power >= value * (1.0 - 1e-9)) return m * power;
  return 10.0 * power;
}
double round_down(double value) {
  const double power = power_below(value);
  for (const double m : {8.0, 6.0, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5})
    if (m * power <= value * (1.0 + 1e-9)) return m * power;
  return power;
}

/// Value that a share of the area is below. \param sorted  by value, not empty.
double percentile(const std::vector<Weighted>& sorted, double share) {
  double total = 0.0;
  for (const Weighted& w : sorted) total += w.area;
  double sum = 0.0;
  for (const Weighted& w : sorted) {
    sum += w.area;
    if (sum >= share * total) return w.value;
  }
  return sorted.back().value;
}

template <std::size_t N>
std::vector<double> decade_levels(const Range& range, const std::array<double, N>& series) {
  std::vector<double> levels;
  for (double power = power_below(range.low); power <= range.high; power *= 10.0)
    for (const double m : series)
      if (m * power > range.low * 1.0001 && m * power < range.high * 0.9999)
        levels.push_back(m * power);
  return levels;
}

std::vector<double> logarithmic_levels(const Range& range, int count) {
  const std::vector<double> choices[] = {
      decade_levels(range, std::array{1.0}), decade_levels(range, std::array{1.0, 3.0}),
      decade_levels(range, std::array{1.0, 2.0, 5.0}),
      decade_levels(range, std::array{1.0, 1.5, 2.0, 3.0, 5.0, 7.5})};
  const auto miss = [count](const std::vector<double>& levels) {
    return std::abs(static_cast<int>(levels.size()) - count);
  };
  return *std::min_element(std::begin(choices), std::end(choices),
                           [&](const auto& a, const auto& b) { return miss(a) < miss(b); });
}

}  // namespace

double Range::position(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  if (!(value > 0.0)) return std::isnan(value) ? value : -std::numeric_limits<double>::infinity();
  return std::log(value / low) / std::log(high / low);
}

Range automatic_range(std::span<const Weighted> values, bool logarithmic) {
  std::vector<Weighted> sorted;
  for (const Weighted& w : values)
    if (std::isfinite(w.value) && w.area > 0.0 && (!logarithmic || w.value > 0.0))
      sorted.push_back(w);
  std::sort(sorted.begin(), sorted.end(),
            [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  if (sorted.empty()) return {logarithmic ? 0.1 : 0.0, 1.0, logarithmic};
  const double high = percentile(sorted, 0.99);
  if (logarithmic) {
    const double top = round_up(high);
    const double low =
        round_down(std::max(percentile(sorted, 0.01), high / std::pow(10.0, kDecades)));
    return {low < top ? low : 0.1 * top, top, true};
  }
  if (sorted.front().value < 0.0) {
    const double low = sorted.front().value;
    return {low, std::max(sorted.back().value, low + 1e-6 * std::abs(low)), false};
  }
  return {0.0, high > 0.0 ? round_up(high) : 1.0, false};
}

std::vector<double> round_levels(const Range& range, int count) {
  if (count < 1) return {};
  if (range.logarithmic) return logarithmic_levels(range, count);
  const double wanted = (range.high - range.low) / (count + 1);
  const double power = power_below(wanted);
  double step = 10.0 * power;
  for (const double m : {5.0, 2.5, 2.0, 1.0})
    if (std::abs(std::log(m * power / wanted)) < std::abs(std::log(step / wanted)))
      step = m * power;
  std::vector<double> levels;
  for (double k = std::floor(range.low / step) + 1.0; k * step < range.high - 1e-6 * step; k += 1.0)
    if (k * step > range.low + 1e-6 * step) levels.push_back(k * step);
  return levels;
}

const char* level_format() { return "%.6g"; }

}  // namespace atrium::view
