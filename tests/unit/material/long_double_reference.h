#pragma once

#include <cmath>
#include <complex>
#include <numbers>

// A second evaluation of the interface in extended precision, written from the definitions and not
// from the library's code: complex Fresnel coefficients, sums of a Simpson rule, no rearrangement.
namespace atrium::material::reference {

using Quad = long double;
inline constexpr Quad kPi = std::numbers::pi_v<Quad>;

template <class F>
Quad simpson(F&& f, Quad a, Quad b, int panels) {
  Quad sum = f(a) + f(b);
  for (int i = 1; i < panels; ++i)
    sum += (i % 2 == 1 ? Quad(4) : Quad(2)) * f(a + (b - a) * i / panels);
  return sum * (b - a) / panels / 3;
}

inline Quad fresnel(Quad c, Quad n, Quad k) {
  const std::complex<Quad> N(n, k);
  const Quad s2 = 1 - c * c;
  const std::complex<Quad> root = std::sqrt(N * N - s2);  // N cos(beta)
  const Quad rs = std::norm((c - root) / (c + root));
  const Quad rp = std::norm((N * N * c - root) / (N * N * c + root));
  return (rs + rp) / 2;
}

inline Quad facets_norm(Quad c) {
  const Quad end = std::min(kPi / 2, 8 / std::max(c, Quad(1e-9)));
  return 1 / (kPi * simpson([&](Quad d) { return std::exp(-c * c * d * d) * std::sin(2 * d); }, 0,
                            end, 60000));
}

struct Vec {
  Quad x, y, z;
};
inline Quad dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec unit(const Vec& a) {
  const Quad length = std::sqrt(dot(a, a));
  return {a.x / length, a.y / length, a.z / length};
}

inline Quad vcavity(Quad nl, Quad nb, Quad nh, Quad lh, Quad bh) {
  return std::min(Quad(1), std::min(2 * nh * nb / bh, 2 * nh * nl / lh));
}

inline Quad density(Quad norm, Quad c, const Vec& h) {
  const Quad delta = std::asin(std::min(Quad(1), std::sqrt(h.x * h.x + h.y * h.y)));
  return norm * std::exp(-c * c * delta * delta);
}

inline Quad brdf(const Vec& l, const Vec& b, Quad c, Quad norm, Quad n, Quad k) {
  const Vec h = unit({l.x + b.x, l.y + b.y, l.z + b.z});
  const Quad bh = dot(b, h);
  return fresnel(bh, n, k) * density(norm, c, h) * vcavity(l.z, b.z, h.z, dot(l, h), bh) /
         (4 * l.z * b.z);
}

inline Quad btdf(const Vec& l, const Vec& b, Quad c, Quad norm, Quad n1, Quad n2) {
  const Quad side = n2 > n1 ? -1 : 1;
  const Vec h = unit(
      {side * (n1 * b.x + n2 * l.x), side * (n1 * b.y + n2 * l.y), side * (n1 * b.z + n2 * l.z)});
  const Quad lh = dot(l, h), bh = dot(b, h);
  if (!(bh > 0 && lh < 0 && h.z > 0)) return 0;
  const Quad d = n2 * lh + n1 * bh;
  return std::abs(lh * bh) / (std::abs(l.z) * b.z) * n1 * n1 * (1 - fresnel(-lh, n1 / n2, 0)) *
         density(norm, c, h) * vcavity(-l.z, b.z, h.z, -lh, bh) / (d * d);
}

}  // namespace atrium::material::reference
