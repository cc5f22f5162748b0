#pragma once

#include <cmath>

namespace atrium::material {

#ifdef __SIZEOF_FLOAT128__
using Wide = __float128;
#else
using Wide = long double;
#endif

/// Root by Newton's iteration from the long double one.
inline Wide wide_sqrt(Wide x) {
  if (!(x > 0)) return 0;
  Wide y = static_cast<Wide>(std::sqrt(static_cast<long double>(x)));
  for (int i = 0; i < 3; ++i) y = (y + x / y) / 2;
  return y;
}

struct WideComplex {
  Wide re, im;
  friend WideComplex operator+(WideComplex a, WideComplex b) { return {a.re + b.re, a.im + b.im}; }
  friend WideComplex operator-(WideComplex a, WideComplex b) { return {a.re - b.re, a.im - b.im}; }
  friend WideComplex operator*(WideComplex a, WideComplex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend WideComplex operator*(Wide s, WideComplex a) { return {s * a.re, s * a.im}; }
  friend WideComplex operator/(WideComplex a, WideComplex b) {
    const Wide d = b.re * b.re + b.im * b.im;
    return {(a.re * b.re + a.im * b.im) / d, (a.im * b.re - a.re * b.im) / d};
  }
  [[nodiscard]] Wide norm() const { return re * re + im * im; }
};

inline WideComplex wide_sqrt(WideComplex z) {
  const Wide m = wide_sqrt(z.norm());
  if (m == 0) return {0, 0};
  const Wide a = wide_sqrt((m + (z.re < 0 ? -z.re : z.re)) / 2);
  return z.re >= 0 ? WideComplex{a, z.im / (2 * a)} : WideComplex{z.im / (2 * a), a};
}

struct WideTerms {
  Wide s, p;
  [[nodiscard]] Wide mean() const { return (s + p) / 2; }
};

/// Fresnel's amplitudes with a complex cosine behind the surface, in quadruple precision: shares
/// nothing with the library. Takes exactly the arguments given.
inline WideTerms fresnel_amplitudes(Wide c, Wide n, Wide k) {
  if (n == 1 && k == 0) return {0, 0};
  if (c == 0) return {1, 1};
  const WideComplex N{n, k};
  const WideComplex s2{1 - c * c, 0};
  // N cos_t, the wave that decays: im >= 0 for im(N^2) = 2 n k >= 0.
  const WideComplex w = wide_sqrt(N * N - s2);
  const WideComplex C{c, 0};
  return {((C - w) / (C + w)).norm(), ((c * (N * N) - w) / (c * (N * N) + w)).norm()};
}

}  // namespace atrium::material
