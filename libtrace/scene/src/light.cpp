#include "scene/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::scene {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

struct Interval {
  std::size_t lower;
  std::size_t upper;
  double t;  // position between them
};

// Bracket of `value`, which lies within the grid; a grid of one value is constant.
Interval bracket(const std::vector<double>& grid, double value) {
  if (grid.size() == 1) return {0, 0, 0.0};
  const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, value);
  const auto upper = static_cast<std::size_t>(above - grid.begin());
  const double width = grid[upper] - grid[upper - 1];
  return {upper - 1, upper, std::clamp((value - grid[upper - 1]) / width, 0.0, 1.0)};
}

// Integral of the row's piecewise linear intensity times sin(theta) d theta, by parts.
double polar_integral(const std::vector<double>& theta_deg, const double* candela) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < theta_deg.size(); ++i) {
    const double a = theta_deg[i] * kRadians;
    const double b = theta_deg[i + 1] * kRadians;
    const double slope = (candela[i + 1] - candela[i]) / (b - a);
    sum += candela[i] * std::cos(a) - candela[i + 1] * std::cos(b);
    sum += slope * (std::sin(b) - std::sin(a));
  }
  return sum;
}

}  // namespace

double IntensityProfile::at(double theta_deg_value, double phi_deg_value) const {
  if (theta_deg.empty() || phi_deg.empty()) return 0.0;
  if (!(theta_deg_value >= theta_deg.front() && theta_deg_value <= theta_deg.back())) return 0.0;
  if (!std::isfinite(phi_deg_value)) return 0.0;
  double phi = std::fmod(phi_deg_value, 360.0);
  if (phi < 0.0) phi += 360.0;
  const Interval t = bracket(theta_deg, theta_deg_value);
  const Interval p = bracket(phi_deg, phi);
  const auto row = [&](std::size_t plane) {
    const double* c = candela.data() + plane * theta_deg.size();
    return c[t.lower] + t.t * (c[t.upper] - c[t.lower]);
  };
  const double low = row(p.lower);
  return low + p.t * (row(p.upper) - low);
}

double IntensityProfile::flux() const {
  if (phi_deg.size() == 1) {
    return 2.0 * std::numbers::pi * polar_integral(theta_deg, candela.data());
  }
  double sum = 0.0;  // trapezoid in phi is exact for a bilinear table
  for (std::size_t p = 0; p + 1 < phi_deg.size(); ++p) {
    const double* row = candela.data() + p * theta_deg.size();
    const double mean =
        0.5 * (polar_integral(theta_deg, row) + polar_integral(theta_deg, row + theta_deg.size()));
    sum += mean * (phi_deg[p + 1] - phi_deg[p]) * kRadians;
  }
  return sum;
}

}  // namespace atrium::scene
