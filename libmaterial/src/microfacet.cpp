#include "material/microfacet.h"

#include <cassert>

#include "material/gauss_legendre.h"

namespace atrium::material {
namespace {

// Integral of exp(-c^2 d^2) sin(2 d) from 0 to delta. Beyond c d = 6.8 the Gaussian is below 1e-20
// of its peak; within, one rule of degree 63 resolves it for every c.
double projected_area(double c, double delta) {
  const double end = std::min(delta, 6.8 / std::max(c, 1e-9));
  return gauss_legendre_32(0.0, end,
                           [c](double d) { return std::exp(-c * c * d * d) * std::sin(2.0 * d); });
}

constexpr double kHalfPi = 0.5 * std::numbers::pi;

}  // namespace

double gaussian_facets_norm(double c) {
  assert(c >= 0.0 && c <= 1e6);
  return 1.0 / (std::numbers::pi * projected_area(c, kHalfPi));
}

double gaussian_facets_cdf(double c, double delta) {
  if (!(delta > 0.0)) return 0.0;
  if (delta >= kHalfPi) return 1.0;
  return std::min(1.0, projected_area(c, delta) / projected_area(c, kHalfPi));
}

}  // namespace atrium::material
