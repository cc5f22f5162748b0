#pragma once

#include <cmath>
#include <numbers>

namespace atrium::material {

/// Share of light that a rough surface of rms height sigma still reflects as a mirror, at a cosine
/// of incidence: exp(-(4 pi n1 sigma cos / lambda)^2). sigma and the vacuum wavelength lambda in
/// one unit.  Source: Davies 1954, Bennett & Porteus 1961; MATERIAL_MODEL 5.4.
[[nodiscard]] inline double coherent_reflection(double cosine, double sigma, double lambda,
                                                double n1 = 1.0) {
  const double x = 4.0 * std::numbers::pi * n1 * sigma * cosine / lambda;
  return std::exp(-x * x);
}

/// What is left of it, 1 - coherent_reflection(), to all digits.
[[nodiscard]] inline double incoherent_reflection(double cosine, double sigma, double lambda,
                                                  double n1 = 1.0) {
  const double x = 4.0 * std::numbers::pi * n1 * sigma * cosine / lambda;
  return -std::expm1(-x * x);
}

/// Share that passes straight (refracted) from n1 to n2, exp(-(2 pi sigma (n1 cos_i - n2 cos_t) /
/// lambda)^2); 0 under total reflection.
[[nodiscard]] inline double coherent_transmission(double cosine, double sigma, double lambda,
                                                  double n1, double n2) {
  const double sine = n1 / n2 * std::sqrt((1.0 - cosine) * (1.0 + cosine));
  if (!(sine <= 1.0)) return 0.0;
  const double cos_t = std::sqrt((1.0 - sine) * (1.0 + sine));
  const double x = 2.0 * std::numbers::pi * sigma * (n1 * cosine - n2 * cos_t) / lambda;
  return std::exp(-x * x);
}

/// Cosine mean of coherent_reflection over the hemisphere, (1 - exp(-g)) / g; 1 for sigma = 0.
[[nodiscard]] inline double coherent_reflection_mean(double sigma, double lambda, double n1 = 1.0) {
  const double x = 4.0 * std::numbers::pi * n1 * sigma / lambda;
  const double g = x * x;
  return g > 0.0 ? -std::expm1(-g) / g : 1.0;
}

}  // namespace atrium::material
