#include <cmath>
#include <limits>

#include "material/bsdf.h"
#include "material/fresnel.h"
#include "stress/setting.h"

namespace atrium::stress {
namespace {

using material::Bsdf;
using material::Material;
using material::ResolvedMaterial;

constexpr const char* kFamily = "Materials";

const std::vector<double>& indices(Extent extent) {
  static const std::vector<double> full{0.05, 0.2, 0.7, 0.999, 1.0, 1.001, 1.5, 2.4, 5.0, 10.0},
      some{0.05, 1.0, 10.0};
  return extent == Extent::Full ? full : some;
}
const std::vector<double>& absorptions(Extent extent) {
  static const std::vector<double> full{0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3}, some{0.0, 1e3};
  return extent == Extent::Full ? full : some;
}

// ---- Fresnel's amplitudes with a complex cosine, in long double: shares nothing with the library

struct Complex {  // std::complex multiplies with checks for infinities that raise exceptions
  long double re, im;
  friend Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(Complex a, Complex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  [[nodiscard]] long double norm() const { return re * re + im * im; }
};

Complex root(Complex z) {
  const long double m = std::sqrt(z.norm());
  if (m == 0) return {0, 0};
  const long double a = std::sqrt((m + std::abs(z.re)) / 2);
  return z.re >= 0 ? Complex{a, z.im / (2 * a)} : Complex{z.im / (2 * a), a};
}

long double amplitudes(long double c, long double n, long double k) {
  if (n == 1 && k == 0) return 0;
  if (c == 0) return 1;
  const Complex square = Complex{n, k} * Complex{n, k}, cosine{c, 0};
  const Complex w = root(square - Complex{1 - c * c, 0});
  const Complex q = cosine * square;
  return ((cosine - w).norm() / (cosine + w).norm() + (q - w).norm() / (q + w).norm()) / 2;
}

Sweep fresnel(Extent extent) {
  Sweep s{kFamily,
          "Fresnel's reflectance over n, kappa, angle (double)",
          "n 0.05 .. 10, kappa 0 .. 1e3, 0 .. 90 deg",
          "amplitudes in long double",
          {}};
  for (const double n : indices(extent))
    s.cases.push_back({"n " + text(n), [n, extent] {
                         Outcome o;
                         for (const double kappa : absorptions(extent))
                           for (int i = 0; i <= 200; ++i) {
                             const double c = i / 200.0, k = n * kappa;
                             const double f = material::fresnel_unpolarised(c, n, k);
                             const auto r = static_cast<double>(amplitudes(c, n, k));
                             Outcome here;
                             here.deviation = r > 0.0 ? std::abs(f / r - 1) : std::abs(f);
                             // The reference loses digits of 1 - n and of total reflection.
                             here.stated = 1e-11;
                             here.not_finite = std::isfinite(f) && f >= 0.0 && f <= 1.0 ? 0U : 1U;
                             o.join(here);
                           }
                         return o;
                       }});
  return s;
}

// ---- BSDFs ----

Vec3f with_cosine(double mu, double phi) {
  const double s = std::sqrt((1 - mu) * (1 + mu));
  return Vec3d(s * std::cos(phi), s * std::sin(phi), mu).cast<float>();
}

// Directional albedo by sampling: mean of the weights over a grid of numbers, against 1; and what
// eval() and pdf() say of the sampled directions against the weights.
Outcome of_samples(const Bsdf<1>& bsdf, const Vec3f& wo) {
  constexpr int kGrid = 24;
  Outcome energy, agreement;
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const auto u = static_cast<float>((i + 0.5) / kGrid),
                 v = static_cast<float>((j + 0.5) / kGrid);
      const float choice = std::fmod(0.618034f * static_cast<float>(i * kGrid + j), 1.0f);
      const auto sample =
          bsdf.sample(wo, choice, {u, v}, material::kAllEvents, material::Transport::Flux);
      if (!sample) continue;
      const auto weight = static_cast<double>(sample->weight.max());
      energy.not_finite += std::isfinite(weight) && sample->wi.allFinite() ? 0U : 1U;
      sum += weight;
      square += weight * weight;
      if (sample->dirac()) continue;
      const double f =
          static_cast<double>(bsdf.eval(wo, sample->wi, material::Transport::Flux).sum().max());
      const double expected =
          f * std::abs(static_cast<double>(sample->wi.z())) / static_cast<double>(sample->pdf);
      Outcome here;
      here.deviation = std::abs(weight - expected);
      here.stated = 1e-3;
      agreement.join(here);
    }
  constexpr double kCount = kGrid * kGrid;
  const double mean = sum / kCount;
  energy.deviation = std::max(0.0, mean - 1.0);
  energy.stated = 1e-3 + 3 * std::sqrt(std::max(0.0, square / kCount - mean * mean) / kCount);
  energy.join(agreement);
  return energy;
}

// f(wo, wi) = f(wi, wo) above the surface.
Outcome of_reciprocity(const Bsdf<1>& bsdf, double mu_o, double mu_i) {
  const Vec3f a = with_cosine(mu_o, 0.3), b = with_cosine(mu_i, 2.5);
  const auto f = static_cast<double>(bsdf.eval(a, b).sum().max()),
             g = static_cast<double>(bsdf.eval(b, a).sum().max());
  Outcome o;
  o.deviation = std::abs(f - g) / std::max({f, g, 1e-30});
  o.stated = 1e-3;
  o.not_finite = std::isfinite(f) && std::isfinite(g) ? 0U : 1U;
  return o;
}

Outcome of_material(const Material& m) {
  const ResolvedMaterial<1> resolved =
      material::resolve_material<1>(m, material::SpectralBasis::grey());
  Outcome o;
  for (const bool front : {true, false}) {
    if (!front && m.medium != Material::Medium::Solid) continue;
    const Bsdf<1> bsdf(resolved, front, Spectrum<1>::one(), Spectrum<1>::one(), 1.0f);
    for (const double mu : {1e-6, 1e-3, 0.1, 0.5, 1.0}) {
      o.join(of_samples(bsdf, with_cosine(mu, 0.3)));
      if (m.medium == Material::Medium::Opaque)
        for (const double other : {1e-6, 0.2, 0.9}) o.join(of_reciprocity(bsdf, mu, other));
    }
  }
  return o;
}

constexpr double kSmooth = std::numeric_limits<double>::infinity();

// D ~ exp(-c^2 delta^2): glTF's roughness is about sqrt(1 / c).
double c_of_roughness(double roughness) {
  return roughness > 0.0 ? 1 / (roughness * roughness) : kSmooth;
}

Sweep bsdfs(Extent extent, Material::Medium medium, material::Material::Combination combination,
            const std::string& what) {
  Sweep s{kFamily,
          what + " over n, kappa, roughness and angle",
          "n 0.05 .. 10, kappa 0 .. 1e3, roughness 0 .. 1, cos 1e-6 .. 1",
          "energy at most 1, f(a, b) = f(b, a), weight = f cos / pdf",
          {}};
  const std::vector<double> roughnesses = extent == Extent::Full
                                              ? std::vector{0.0, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0}
                                              : std::vector{0.0, 1e-3, 1.0};
  for (const double roughness : roughnesses)
    s.cases.push_back({"roughness " + text(roughness), [=] {
                         Outcome o;
                         for (const double n : indices(extent))
                           for (const double kappa : absorptions(extent)) {
                             Material m;
                             m.medium = medium;
                             m.combination = combination;
                             m.n = n;
                             m.kappa = kappa;
                             m.c = c_of_roughness(roughness);
                             m.k_rg = 1.0;
                             m.k_df = combination == Material::Combination::Coupled ? 1.0 : 0.0;
                             m.k_tp_rg = medium == Material::Medium::Solid ? 1.0 : 0.0;
                             m.body_reflectance = 0.9;
                             o.join(of_material(m));
                           }
                         return o;
                       }});
  return s;
}

}  // namespace

std::vector<Sweep> material_sweeps(Extent extent) {
  using enum Material::Medium;
  using enum Material::Combination;
  return {fresnel(extent), bsdfs(extent, Opaque, Convex, "opaque interface"),
          bsdfs(extent, Opaque, Coupled, "interface over a body"),
          bsdfs(extent, Solid, Convex, "refracting interface")};
}

}  // namespace atrium::stress
