#pragma once

// Comparison models a second time, in long double and straight from the printed equations: angles
// by atan2, powers by pow, Fresnel by complex arithmetic, He's series term by term. Slow and
// without any of the rearrangements of the library.

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "material/frame.h"

namespace atrium::material::reference {

using Long = long double;
using V = Vec3<Long>;
inline constexpr Long kPi = std::numbers::pi_v<Long>;

inline Long fresnel(Long c, Long n, Long k) {
  using C = std::complex<Long>;
  const C N(n, k), s2(1 - c * c, 0);
  C root = std::sqrt(N * N - s2);  // N cos(theta_t)
  if (root.imag() < 0) root = -root;
  const C rs = (c - root) / (c + root);
  const C rp = (N * N * c - root) / (N * N * c + root);
  return (std::norm(rs) + std::norm(rp)) / 2;
}

struct Half {
  V h;
  Long cos_phi, delta, cos_delta, tan_delta;
  Half(const V& l, const V& b) {
    const V q = l + b;
    h = q / std::sqrt(q.dot(q));
    cos_phi = std::min(Long(1), std::sqrt(q.dot(q)) / 2);
    delta = std::atan2(std::sqrt(h.x() * h.x() + h.y() * h.y()), h.z());
    cos_delta = h.z();
    tan_delta = std::sqrt(h.x() * h.x() + h.y() * h.y()) / h.z();  // tan() near pi/2 is worse
  }
};

inline Long angle(const V& a, const V& b) {
  const V x = a.cross(b);
  return std::atan2(std::sqrt(x.dot(x)), a.dot(b));
}
inline V mirrored(const V& l) { return {-l.x(), -l.y(), l.z()}; }

inline Long cosine_power(Long a, Long p) {
  return p == 0 ? Long(1) : std::pow(std::max(Long(0), std::cos(a)), p);
}
inline Long phong_1975(const V& l, const V& b, Long kd, Long ks, Long p) {
  return kd * l.z() + ks * cosine_power(angle(mirrored(l), b), p);
}
inline Long phong_lafortune(const V& l, const V& b, Long kd, Long ks, Long p) {
  return kd / kPi + ks * (p + 2) / (2 * kPi) * cosine_power(angle(mirrored(l), b), p);
}
inline Long blinn_phong(const V& l, const V& b, Long kd, Long ks, Long p) {
  const Long C = (p + 2) * (p + 4) / (8 * kPi * (std::pow(Long(2), -p / 2) + p));
  return kd / kPi + ks * C * (p == 0 ? 1 : std::pow(Half(l, b).cos_delta, p));
}
inline Long vcavity(const V& l, const V& b) {
  const Half h(l, b);
  return std::min(Long(1), 2 * h.cos_delta * std::min(l.z(), b.z()) / h.cos_phi);
}
inline Long beckmann(const Half& h, Long m) {
  const Long t = h.tan_delta / m;
  return std::exp(-t * t) / (kPi * m * m * std::pow(h.cos_delta, 4));
}
inline Long cook_torrance(const V& l, const V& b, Long m, Long n, Long k) {
  const Half h(l, b);
  return fresnel(h.cos_phi, n, k) * beckmann(h, m) * vcavity(l, b) / (4 * l.z() * b.z());
}
inline Long ggx_facets(const V& l, const V& b, Long alpha) {
  const Half h(l, b);
  const Long tan_d = h.tan_delta;
  const Long x = alpha * alpha + tan_d * tan_d;
  const Long D = alpha * alpha / (kPi * std::pow(h.cos_delta, 4) * x * x);
  const auto lambda = [&](const V& v) {
    const Long t = std::sqrt(v.x() * v.x() + v.y() * v.y()) / v.z();
    return (std::sqrt(1 + alpha * alpha * t * t) - 1) / 2;
  };
  return D / (1 + lambda(l) + lambda(b)) / (4 * l.z() * b.z());
}
inline Long ggx(const V& l, const V& b, Long alpha, Long n, Long k) {
  return ggx_facets(l, b, alpha) * fresnel(Half(l, b).cos_phi, n, k);
}
inline Long ggx_schlick(const V& l, const V& b, Long alpha, Long f0) {
  return ggx_facets(l, b, alpha) * (f0 + (1 - f0) * std::pow(1 - Half(l, b).cos_phi, 5));
}

// Polar angles alpha >= beta with their complements and tangents, each without loss near pi/2.
struct Angles {
  Long alpha, beta, alpha_rest, beta_rest, tan_beta, tan_half, psi;
  Angles(const V& l, const V& b) {
    const auto sine = [](const V& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y()); };
    const V& va = l.z() < b.z() ? l : b;
    const V& vb = l.z() < b.z() ? b : l;
    alpha = std::atan2(sine(va), va.z());
    beta = std::atan2(sine(vb), vb.z());
    alpha_rest = std::atan2(va.z(), sine(va));
    beta_rest = std::atan2(vb.z(), sine(vb));
    tan_beta = sine(vb) / vb.z();
    tan_half = 1 / std::tan((alpha_rest + beta_rest) / 2);
    psi = std::atan2(l.x() * b.y() - l.y() * b.x(), l.x() * b.x() + l.y() * b.y());
  }
};
inline Long oren_nayar_qualitative(const V& l, const V& b, Long rho, Long s) {
  const Angles t(l, b);
  const Long A = 1 - s * s / 2 / (s * s + Long(33) / 100);
  const Long B = Long(45) / 100 * s * s / (s * s + Long(9) / 100);
  return rho / kPi * (A + B * std::max(Long(0), std::cos(t.psi)) * std::sin(t.alpha) * t.tan_beta);
}
inline Long oren_nayar_full(const V& l, const V& b, Long rho, Long s) {
  const Angles t(l, b);
  const Long s2 = s * s, c = std::cos(t.psi), x = 2 * t.beta / kPi;
  const Long C1 = 1 - s2 / 2 / (s2 + Long(33) / 100);
  // sin(alpha) - x^3 = (1 - x)(1 + x + x^2) - 2 sin^2((pi/2 - alpha)/2)
  const Long far = std::sin(t.alpha_rest / 2);
  const Long behind = 2 * t.beta_rest / kPi * (1 + x + x * x) - 2 * far * far;
  const Long C2 =
      Long(45) / 100 * s2 / (s2 + Long(9) / 100) * (c >= 0 ? std::sin(t.alpha) : behind);
  const Long ab = 4 * t.alpha * t.beta / (kPi * kPi);
  const Long C3 = s2 / 8 / (s2 + Long(9) / 100) * ab * ab;
  const Long half = c >= 0 ? std::sin(t.psi / 2) : std::cos(t.psi / 2);
  return rho / kPi * (C1 + c * C2 * t.tan_beta + 2 * half * half * C3 * t.tan_half) +
         Long(17) / 100 * rho * rho / kPi * s2 / (s2 + Long(13) / 100) * (1 - c * x * x);
}

// Quadruple precision for Hanrahan-Krueger, whose 1 - F and differences of exponentials cancel.
using Quad = __float128;
inline Quad root(Quad x) {
  if (!(x > 0)) return 0;
  Quad y = std::sqrt(static_cast<Long>(x));
  for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
  return y;
}
inline Quad exponential(Quad x) {  // x <= 0
  if (x < -11000) return 0;
  int halvings = 0;
  for (; x < -0.01; ++halvings) x /= 2;
  Quad sum = 1, term = 1;
  for (int i = 1; i < 16; ++i) sum += term *= x / i;
  for (; halvings > 0; --halvings) sum *= sum;
  return sum;
}

// b above: reflection; below: transmission. Unit vectors up to rounding: cosines from z.
inline Long hanrahan_krueger(const V& l, const V& b, Quad n, Quad W, Long taud, Quad g) {
  const auto inside = [n](Quad c) { return root((n * n - 1 + c * c) / (n * n)); };
  const auto transmitted = [n](Quad c, Quad m) {
    const Quad s = (c - n * m) / (c + n * m), p = (n * c - m) / (n * c + m);
    return 1 - (s * s + p * p) / 2;
  };
  const Quad zi = l.z(), zo = std::abs(b.z());
  const Quad mi = inside(zi), mo = inside(zo);
  const Quad ux = -Quad(l.x()) / n, uy = -Quad(l.y()) / n, vx = Quad(b.x()) / n,
             vy = Quad(b.y()) / n, vz = b.z() > 0 ? mo : -mo;
  const Quad dot = ux * vx + uy * vy - mi * vz;
  const Quad cosine = dot / root((ux * ux + uy * uy + mi * mi) * (vx * vx + vy * vy + vz * vz));
  const Quad d = 1 + g * g - 2 * g * cosine;
  const Quad phase = (1 - g * g) / (4 * Quad(kPi) * d * root(d));
  const Quad factor = transmitted(zi, mi) * transmitted(zo, mo) / (n * n) * W * phase;
  const bool infinite = std::isinf(taud);
  const auto decay = [&](Quad inverse) { return infinite ? 0 : exponential(-taud * inverse); };
  Quad path;
  if (b.z() > 0)
    path = (1 - decay(1 / mi + 1 / mo)) / (mi + mo);
  else if (mi - mo < 1e-14 * mi && mo - mi < 1e-14 * mi)  // closer than the quotient resolves
    path = infinite ? 0 : taud / (mi * mo) * decay(1 / mi);
  else
    path = (decay(1 / mi) - decay(1 / mo)) / (mi - mo);
  return static_cast<Long>(factor * path);
}

struct Schlick {
  Long f, dirac;
};
inline Schlick schlick1994(const V& l, const V& b, Long f0, Long r, Long p) {
  const Half h(l, b);
  const Long S = f0 + (1 - f0) * std::pow(1 - h.cos_phi, 5);
  const auto G = [r](Long v) { return v / (r - r * v + v); };
  const Long t2 = h.cos_delta * h.cos_delta;
  const Long sin2 = h.h.x() * h.h.x() + h.h.y() * h.h.y();
  const Long w = sin2 > 0 ? h.h.x() / std::sqrt(sin2) : Long(1);
  const Long A = std::sqrt(p / (p * p * (1 - w * w) + w * w));
  const Long Z = r / std::pow(r * t2 + sin2, 2);
  const Long GG = G(l.z()) * G(b.z());
  const Long D = GG * Z * A / (4 * kPi * l.z() * b.z()) + (1 - GG) / kPi;
  const Long lobe = 4 * r * (1 - r);
  const bool smooth = r < Long(0.5);
  return {S * ((smooth ? 0 : 1 - lobe) / kPi + lobe * D), smooth ? S * (1 - lobe) : 0};
}

// Term by term from m = 1, logarithms, until the terms beyond the mode are negligible.
inline Long he_sum(Long g, Long B) {
  Long mode = g;  // of g^m e^{-B/m} / m!, by bisection of ln(m/g) - B/m^2
  Long high = std::max(Long(2), 2 * (g + std::sqrt(B) + 1));
  for (int i = 0; i < 60; ++i)
    if (std::log(high / g) < B / (high * high)) high *= 2;
  Long low = g;
  for (int i = 0; i < 200; ++i) {
    mode = (low + high) / 2;
    (std::log(mode / g) < B / (mode * mode) ? low : high) = mode;
  }
  const Long width = std::sqrt(mode) + 1;
  const Long first = std::max(Long(1), std::floor(mode - 12 * width));
  const Long last = std::ceil(mode + 14 * width + 40);
  // exp(term - offset) by recurrence of the logarithm-free part, rescaled from the mode's value.
  const auto log_term = [&](Long m) {
    if (m > 1000) {  // Stirling with m ln(g/m) + m - g, whose terms cancel, by log1p
      const Long u = (g - m) / m;
      return m * (std::log1p(u) - u) - std::log(2 * kPi * m) / 2 - 1 / (12 * m) +
             1 / (360 * m * m * m) - std::log(m) - B / m;
    }
    return m * std::log(g) - g - std::lgamma(m + 1) - std::log(m) - B / m;
  };
  const Long middle = std::max(Long(1), std::round(mode));
  Long sum = 0, term = 1;
  for (Long m = middle; m <= last; m += 1) {
    sum += term;
    term *= g * m / ((m + 1) * (m + 1)) * std::exp(B / (m * (m + 1)));
  }
  term = 1;
  for (Long m = middle; m > first; m -= 1) {
    term *= m * m / (g * (m - 1)) * std::exp(-B / (m * (m - 1)));
    sum += term;
  }
  return std::exp(log_term(middle)) * sum;
}

inline Long he_sigma(Long cos_i, Long sin_i, Long cos_r, Long sin_r, Long sigma0, Long tau) {
  if (sigma0 == 0) return 0;
  const auto K = [&](Long c, Long s) {
    return s == 0 ? Long(0) : s / c * std::erfc(tau * c / s / (2 * sigma0));
  };
  const Long sum = (K(cos_i, sin_i) + K(cos_r, sin_r)) / 4;
  if (sum == 0) return sigma0;
  // sqrt(pi/2) z = sum e^{-z^2/2} for z = z0 / sigma0 by bisection (both sides monotonic).
  Long low = 0, high = sum;
  for (int i = 0; i < 300; ++i) {
    const Long z = (low + high) / 2;
    (std::sqrt(kPi / 2) * z < sum * std::exp(-z * z / 2) ? low : high) = z;
  }
  return sigma0 / std::sqrt(1 + low * low);
}

struct He {
  Long dd, specular, sigma, g, S, D, G, B;
};
inline He he1991(const V& l, const V& b, Long sigma0, Long tau, Long lambda, Long n, Long k) {
  const V q = l + b;
  const auto sine = [](const V& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y()); };
  He h{};
  h.sigma = he_sigma(l.z(), sine(l), b.z(), sine(b), sigma0, tau);
  h.g = std::pow(2 * kPi * h.sigma / lambda * (l.z() + b.z()), 2);
  h.G = std::pow(q.dot(q) / q.z(), 2);
  const Long v = 2 * kPi / lambda * std::sqrt(q.x() * q.x() + q.y() * q.y());
  h.B = v * v * tau * tau / 4;
  h.D = kPi * kPi * tau * tau / (4 * lambda * lambda) * (h.g > 0 ? he_sum(h.g, h.B) : 0);
  const auto S1 = [&](const V& d) {
    if (sine(d) == 0 || sigma0 == 0) return Long(1);
    const Long a = tau * d.z() / sine(d) / (2 * sigma0);
    const Long Lambda = (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a)) / 2;
    return (1 - std::erfc(a) / 2) / (1 + Lambda);
  };
  h.S = S1(l) * S1(b);
  h.specular = fresnel(b.z(), n, k) * std::exp(-h.g) * h.S;
  h.dd = fresnel(std::sqrt(q.dot(q)) / 2, n, k) / kPi * h.G * h.S * h.D / (l.z() * b.z());
  return h;
}

// Pairs of directions that matter: anywhere, close to the mirror direction at many scales, grazing
// at many scales, poles. Same components for every scalar type they are cast to.
struct Pair {
  Vec3d l, b;
};
inline Vec3d polar(double cosine, double phi) {
  const double s = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return {s * std::cos(phi), s * std::sin(phi), cosine};
}
inline std::vector<Pair> pairs(int count, unsigned seed, int grazing_decades = 12) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const auto azimuth = [&] { return 2.0 * std::numbers::pi * u(rng); };
  std::vector<Pair> result = {{{0, 0, 1}, {0, 0, 1}},
                              {{0, 0, 1}, {0.6, 0, 0.8}},
                              {{0.6, 0, 0.8}, {0.6, 0, 0.8}},
                              {{-0.6, 0, 0.8}, {0.6, 0, 0.8}},
                              {{0, 0.6, 0.8}, {0.6, 0, 0.8}}};
  for (int i = 0; i < count; ++i) {
    const double cosine = 1.0 - u(rng), phi = azimuth();
    const Vec3d b = polar(cosine, phi);
    result.push_back({polar(1.0 - u(rng), azimuth()), b});
    const double offset = std::pow(10.0, -8.0 * u(rng));
    const Vec3d near = polar(std::clamp(cosine + offset * (u(rng) - 0.5), 1e-3, 1.0),
                             phi + std::numbers::pi + offset * (u(rng) - 0.5));
    result.push_back({near, b});
    result.push_back({polar(std::pow(10.0, -grazing_decades * u(rng)), azimuth()), b});
    result.push_back({polar(std::pow(10.0, -grazing_decades * u(rng)), azimuth()),
                      polar(std::pow(10.0, -grazing_decades * u(rng)), phi)});
  }
  return result;
}

}  // namespace atrium::material::reference
