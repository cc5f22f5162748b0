#include "material/smith.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "material/gauss_legendre.h"
#include "material/microfacet.h"

namespace atrium::material {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

// sin p - p cos p, without cancellation for small p.
double crescent(double p) {
  if (p > 0.3) return std::sin(p) - p * std::cos(p);
  const double q = p * p;
  double term = p * q / 3.0, sum = 0.0;
  for (int i = 1; i < 12; ++i) {
    sum += term;
    term *= -q / (2.0 * i * (2.0 * i + 3.0));
  }
  return sum;
}

// Lambda cos(theta) = 2 sin(theta) * integral of D sin^2(d) (sin p - p cos p) over the facets
// that turn away, d from pi/2 - theta; p the azimuth at which they begin to,
// 1 - cos p = sin(d - first) / (sin(theta) sin(d)). d = first + t^2 takes the root away.
double lambda_cosine(double c, double theta) {
  const double first = kHalfPi - theta;
  const double reach =
      c > 0.0 ? 45.0 / (c * c) / (first + std::sqrt(first * first + 45.0 / (c * c))) : theta;
  const double end = std::sqrt(std::min(theta, reach));
  const double norm = gaussian_facets_norm(c);
  const auto integrand = [&](double t) {
    const double d = first + t * t;
    const double sine = std::sin(d);
    const double half_chord = std::sin(t * t) / (2.0 * std::sin(theta) * sine);
    const double p = 2.0 * std::asin(std::sqrt(std::min(half_chord, 1.0)));
    return 2.0 * t * std::exp(-c * c * d * d) * sine * sine * crescent(p);
  };
  double sum = 0.0;
  constexpr int kPanels = 4;
  for (int i = 0; i < kPanels; ++i)
    sum += gauss_legendre_32(end * i / kPanels, end * (i + 1) / kPanels, integrand);
  return 2.0 * std::sin(theta) * norm * sum;
}

}  // namespace

SmithTerms smith(double c, double theta) {
  theta = std::clamp(theta, 0.0, kHalfPi);
  if (theta == 0.0) return {0.0, 1.0};
  const double x = lambda_cosine(c, theta);
  const double mu = theta < kHalfPi ? std::sin(kHalfPi - theta) : 0.0;
  const double lambda = mu > 0.0 ? x / mu : std::numeric_limits<double>::infinity();
  return {lambda, mu / (mu + x)};
}

SmithTable::SmithTable(double c) {
  const double width = 1.0 / std::max(c, 1.0);
  width_ = static_cast<float>(width);
  scale_ = static_cast<float>((1.0 + width) * kSteps);
  for (int i = 0; i <= kSteps; ++i) {
    const double w = static_cast<double>(i) / kSteps / (1.0 + width);
    const double mu = std::min(1.0, width * w / (1.0 - w));
    table_[static_cast<std::size_t>(i)] = static_cast<float>(smith(c, std::acos(mu)).g1);
  }
}

float SmithTable::g1(float mu) const {
  mu = std::min(std::abs(mu), 1.0f);
  const float x = mu / (mu + width_) * scale_;
  const int i = std::min(static_cast<int>(x), kSteps - 1);
  const float f = x - static_cast<float>(i);
  const auto at = static_cast<std::size_t>(i);
  return table_[at] + f * (table_[at + 1] - table_[at]);
}

float SmithTable::reflection(float mu_o, float mu_i) const {
  const float o = g1(mu_o), i = g1(mu_i);
  const float sum = o + i - o * i;
  return sum > 0.0f ? o * i / sum : 0.0f;
}

}  // namespace atrium::material
