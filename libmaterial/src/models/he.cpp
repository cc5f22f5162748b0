#include "material/models/he.h"

#include <array>

#include "material/fresnel.h"

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLogSqrt2Pi = 0.91893853320467274178;
constexpr double kLogMin = -708.0;  // below, e^x is subnormal
constexpr int kLargestDirectMode = 50;

constexpr std::array<double, kLargestDirectMode + 2> factorials() {
  std::array<double, kLargestDirectMode + 2> f{};
  f[0] = 1.0;
  for (std::size_t i = 1; i < f.size(); ++i) f[i] = f[i - 1] * static_cast<double>(i);
  return f;
}
constexpr auto kFactorial = factorials();

// ln m! - [m ln m - m + ln sqrt(2 pi m)] for real m > 0, Stirling's series; 1e-15 for m >= 15.
double stirling_rest(double m) {
  const double x = 1.0 / (m * m);
  return (1.0 / 12 - x * (1.0 / 360 - x * (1.0 / 1260 - x * (1.0 / 1680 - x / 1188)))) / m;
}

// m ln(m / g) - m + g >= 0 without the cancellation of its terms: with v = (m - g) / (m + g) it is
// (m - g) v + 2 m v (v^2/3 + v^4/5 + ...) (Loader 2000).
double poisson_deviance(double m, double g) {
  const double v = (m - g) / (m + g);
  if (std::abs(v) > 0.1) return m * std::log(m / g) - m + g;
  const double v2 = v * v;
  double series = 0.0;
  for (int j = 19; j >= 3; j -= 2) series = v2 * (series + 1.0 / j);
  return (m - g) * v + 2.0 * m * v * series;
}

// Outward from the largest term; the logarithm of the summand is concave in m.
double direct_sum(double g, double B, double mode) {
  const int start = std::max(1, static_cast<int>(std::lround(mode)));
  const double first = start * std::log(g) - g - B / start -
                       std::log(kFactorial[static_cast<std::size_t>(start)] * start);
  if (first < kLogMin) return 0.0;
  constexpr double negligible = 1e-17;
  double sum = 1.0;
  double term = 1.0;
  for (int k = start;; ++k) {
    const double m = k;
    const double ratio = g * m / ((m + 1.0) * (m + 1.0)) * std::exp(B / (m * (m + 1.0)));
    term *= ratio;
    sum += term;
    if (ratio < 1.0 && term < negligible * sum) break;
  }
  term = 1.0;
  for (int k = start; k > 1; --k) {
    const double m = k;
    const double ratio = m * m / (g * (m - 1.0)) * detail::exp_minus(B / (m * (m - 1.0)));
    term *= ratio;
    sum += term;
    if (ratio < 1.0 && term < negligible * sum) break;
  }
  return std::exp(first) * sum;
}

// The summand as a function of real m > 0, logarithm.
double log_summand(double m, double g, double B) {
  return -poisson_deviance(m, g) - stirling_rest(m) - kLogSqrt2Pi - 1.5 * std::log(m) - B / m;
}

double trapezoidal_sum(double g, double B, double mode) {
  const double curvature = 1.0 / mode + 2.0 * B / (mode * mode * mode);
  const double step = std::max(1.0, 0.7 / std::sqrt(curvature));
  const double peak = log_summand(mode, g, B);
  if (peak < kLogMin) return 0.0;
  double sum = 1.0;
  for (const double direction : {1.0, -1.0}) {
    for (int k = 1;; ++k) {
      const double m = mode + direction * step * k;
      if (!(m >= 1.0)) break;
      const double term = std::exp(log_summand(m, g, B) - peak);
      sum += term;
      if (term < 1e-17) break;
    }
  }
  return std::exp(peak) * sum * step;
}

// (1 - erfc(a)/2) / (1 + Lambda) and the same over cos, for one direction; a = tau cot / (2 sigma).
struct Shadowing {
  double S1 = 1.0, S1_over_cos = 1.0;
  Shadowing(double cosine, double sine, double sigma0, double tau) {
    S1_over_cos = 1.0 / cosine;
    if (!(tau * cosine < 60.0 * sigma0 * sine)) return;  // a >= 30: erfc(a) < 1e-390
    const double slope = 2.0 * sigma0 * sine / tau;
    const double a = cosine / slope;
    const double e = std::erfc(a);
    // cos (1 + Lambda), in which Lambda's pole at grazing angles is gone.
    const double cos_lambda =
        0.5 * (slope * std::exp(-a * a) * std::numbers::inv_sqrtpi - cosine * e);
    S1_over_cos = (1.0 - 0.5 * e) / (cosine + cos_lambda);
    S1 = S1_over_cos * cosine;
  }
};

// K = tan erfc(tau cot / (2 sigma0)).
double he_K(double cosine, double sine, double sigma0, double tau) {
  if (!(tau * cosine < 60.0 * sigma0 * sine)) return 0.0;
  return sine / cosine * std::erfc(tau * cosine / (2.0 * sigma0 * sine));
}

double effective_sigma(double K_sum, double sigma0) {
  if (!(K_sum > 0.0)) return sigma0;
  const double log_A = std::log(K_sum) - std::log(2.0 * std::sqrt(2.0 * kPi));
  return sigma0 / std::sqrt(1.0 + lambert_w_of_exp(2.0 * log_A));
}

double he_g(const HeGeometry& geometry, double lambda) {
  const double height = 2.0 * kPi * geometry.sigma / lambda;
  return height * height * geometry.sum_cos2;
}

}  // namespace

double lambert_w_of_exp(double x) {
  if (x < -745.0) return 0.0;
  if (x < -37.0) return std::exp(x);  // w (1 + w) = e^x to rounding
  // Halley's iteration on f = w - e^x e^-w below 1 (f'' = -(f' - 1)), Newton's on w + ln w = x
  // above.
  if (x < 1.0) {
    const double z = std::exp(x);
    double w = z / (1.0 + z);
    for (int i = 0; i < 4; ++i) {
      const double t = z * std::exp(-w);
      const double f = w - t, slope = 1.0 + t;
      w -= 2.0 * f * slope / (2.0 * slope * slope + f * t);
    }
    return w;
  }
  double w = x > 2.0 ? x - std::log(x) : 0.5 * (1.0 + x);
  for (int i = 0; i < 5; ++i) w *= (1.0 + x - std::log(w)) / (1.0 + w);
  return w;
}

double he_sum(double g, double B) {
  if (!(g > 0.0)) return 0.0;
  // Mode of g^m e^{-B/m} / m!: ln(g/m) + B/m^2 = 0, so (m/g)^2 = e^w with w e^w = 2 B / g^2.
  double mode = g;
  if (B > 0.0) {
    const double log_g = std::log(g);
    const double w = lambert_w_of_exp(std::log(2.0) + std::log(B) - 2.0 * log_g);
    const double log_mode = log_g + 0.5 * w;
    if (log_mode > 50.0) return 0.0;
    mode = std::exp(log_mode);
  }
  return mode < kLargestDirectMode ? direct_sum(g, B, mode) : trapezoidal_sum(g, B, mode);
}

double he_sigma(double theta_i, double theta_r, double sigma0, double tau) {
  if (!(sigma0 > 0.0)) return 0.0;
  return effective_sigma(he_K(std::cos(theta_i), std::sin(theta_i), sigma0, tau) +
                             he_K(std::cos(theta_r), std::sin(theta_r), sigma0, tau),
                         sigma0);
}

HeGeometry::HeGeometry(const Vec3d& l, const Vec3d& b, double sigma0, double tau)
    : above(detail::above(l, b)) {
  if (!above) return;
  const detail::Halfway<double> q(l, b);
  cos_theta = std::min(1.0, b.z());
  cos_phi = q.cos_phi();
  sum_cos2 = q.z * q.z;
  q_xy2 = q.xy2;
  const double ratio = q.norm2 / q.z;
  G = ratio * ratio;
  const double sine_l = std::sqrt(detail::sin2(l)), sine_b = std::sqrt(detail::sin2(b));
  const Shadowing at_l(l.z(), sine_l, sigma0, tau), at_b(b.z(), sine_b, sigma0, tau);
  S = at_l.S1 * at_b.S1;
  S_over_cosines = at_l.S1_over_cos * at_b.S1_over_cos;
  sigma = sigma0 > 0.0
              ? effective_sigma(he_K(l.z(), sine_l, sigma0, tau) + he_K(b.z(), sine_b, sigma0, tau),
                                sigma0)
              : 0.0;
}

double he1991_specular(const HeGeometry& geometry, double lambda, double n, double k) {
  if (!geometry.above) return 0.0;
  return fresnel(geometry.cos_theta, n, k).mean() * detail::exp_minus(he_g(geometry, lambda)) *
         geometry.S;
}

He1991<double> he1991(const HeGeometry& geometry, double tau, double lambda, double n, double k) {
  if (!geometry.above) return {};
  He1991<double> h{};
  h.sigma_eff = geometry.sigma;
  h.S = geometry.S;
  h.G = geometry.G;
  h.g = he_g(geometry, lambda);
  h.specular = he1991_specular(geometry, lambda, n, k);
  const double width = kPi * tau / lambda;
  const double sum = he_sum(h.g, width * width * geometry.q_xy2);
  h.D = 0.25 * width * width * sum;
  if (sum > 0.0)
    h.dd =
        fresnel(geometry.cos_phi, n, k).mean() / kPi * geometry.G * geometry.S_over_cosines * h.D;
  return h;
}

}  // namespace atrium::material
