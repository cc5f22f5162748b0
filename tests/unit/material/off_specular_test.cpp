#include "material/off_specular.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr long double kPi = std::numbers::pi_v<long double>;

// f_s over F N from vectors in the plane of incidence, independent of the half angles used.
long double lobe(long double c, long double theta_i, long double theta_r) {
  const long double lx = -std::sin(theta_i), lz = std::cos(theta_i);
  const long double bx = std::sin(theta_r), bz = std::cos(theta_r);
  const long double length = std::hypot(lx + bx, lz + bz);
  const long double hx = (lx + bx) / length, hz = (lz + bz) / length;
  const long double delta = std::atan2(std::abs(hx), hz), bh = bx * hx + bz * hz;
  const long double g = std::min(1.0L, 2 * hz * std::min(lz, bz) / bh);
  return std::exp(-c * c * delta * delta) * g / (4 * lz * bz);
}

// No direction of a fine grid, on either side, returns more than the peak.
TEST(OffSpecularPeak, IsTheMaximumOverAllDirections) {
  for (const double c : {0.0, 0.5, 1.0, 1.4, 1.5, 3.0, 5.0, 10.0, 30.0}) {
    for (const double degrees : {0.0, 1e-3, 10.0, 30.0, 60.0, 80.0, 89.0}) {
      SCOPED_TRACE("c " + std::to_string(c) + ", theta_i " + std::to_string(degrees));
      const double theta_i = degrees * std::numbers::pi / 180.0;
      const double peak = off_specular_peak(c, theta_i);
      EXPECT_GE(peak, theta_i * (1.0 - 1e-12));
      EXPECT_LE(peak, 0.5 * std::numbers::pi);
      const long double at_peak = lobe(c, theta_i, peak);
      for (int i = -8999; i < 9000; i += 3)
        EXPECT_LE(lobe(c, theta_i, i * kPi / 18000.0L), at_peak * (1.0L + 1e-12L)) << i;
    }
  }
}

// Unmasked facets: d ln f / d theta_r = tan(theta_r) - c^2 (theta_r - theta_i) / 2 = 0.
TEST(OffSpecularPeak, SolvesTheEquationOfOpenFacets) {
  for (const double c : {5.0, 10.0, 100.0, 1e4}) {
    const double theta_i = std::numbers::pi / 6.0;
    const double peak = off_specular_peak(c, theta_i);
    EXPECT_GT(peak, theta_i);
    EXPECT_NEAR(0.5 * c * c * (peak - theta_i) / std::tan(peak), 1.0, 1e-7) << c;
  }
}

TEST(OffSpecularPeak, RefusesWhatItCannotDo) {
  EXPECT_THROW((void)off_specular_peak(-1.0, 0.5), std::invalid_argument);
  EXPECT_THROW((void)off_specular_peak(std::nan(""), 0.5), std::invalid_argument);
  EXPECT_THROW((void)off_specular_peak(5.0, 1.6), std::invalid_argument);
  EXPECT_THROW((void)off_specular_peak(5.0, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace atrium::material
