#include <array>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "material/bsdf.h"
#include "material/coherent.h"
#include "material/models/he.h"

// Samples of every kind of material against its density, over the whole sphere, and the energy that
// they carry.
namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInf = std::numeric_limits<double>::infinity();
using Rgb3 = Spectrum<3>;

struct Case {
  const char* name;
  Material material;
};

Material facets(Material::Medium medium, double n, double kappa, double c,
                std::optional<double> sigma = std::nullopt) {
  Material m;
  m.medium = medium;
  m.n = n;
  m.kappa = kappa;
  m.c = c;
  m.sigma = sigma;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.k_tp_rg = medium == Material::Medium::Solid ? 1.0 : 0.0;
  m.fresnel_error = 0.0;
  return m;
}
Material coupled(double c, std::optional<double> sigma = std::nullopt) {
  Material m = facets(Material::Medium::Opaque, 1.5, 0.0, c, sigma);
  m.combination = Material::Combination::Coupled;
  m.body_reflectance = make_rgb(0.9, 0.5, 0.1);
  return m;
}
Material with(Material m, Masking masking, bool interreflection) {
  m.masking = masking;
  m.facet_interreflection = interreflection;
  return m;
}
// Weights of a convex mix.
Material mix(Material m, double k_df, double k_rg, double k_tp_df, double k_tp_rg) {
  m.k_df = k_df;
  m.k_rg = k_rg;
  m.k_tp_df = k_tp_df;
  m.k_tp_rg = k_tp_rg;
  m.body_reflectance = 0.9;
  m.body_transmittance = 0.8;
  return m;
}
Material literature(const LobeModel& lobe) {
  Material m = facets(Material::Medium::Opaque, 0.27, 10.9, kInf);
  m.lobe = lobe;
  m.k_df = is_body(lobe) ? 1.0 : 0.4;
  m.k_rg = is_body(lobe) ? 0.0 : 0.6;
  m.body_reflectance = make_rgb(0.8, 0.5, 0.2);
  return m;
}

std::vector<Case> cases() {
  using enum Material::Medium;
  const double metal = 10.9;
  return {{"rough metal", facets(Opaque, 0.27, metal, 5.0)},
          {"roughest metal", facets(Opaque, 0.27, metal, 0.0)},
          {"rough glass", facets(Solid, 1.5, 0.0, 3.0)},
          {"rough glass of low index", facets(Solid, 0.7, 0.0, 2.0)},
          {"smooth glass", facets(Solid, 1.5, 0.0, kInf)},
          {"coherent metal", facets(Opaque, 0.27, metal, 4.0, 40e-9)},
          {"coherent glass", facets(Solid, 1.5, 0.0, 3.0, 60e-9)},
          {"smooth plastic", coupled(kInf)},
          {"rough plastic", coupled(4.0)},
          {"coherent plastic", coupled(4.0, 40e-9)},
          {"convex mix", mix(facets(Opaque, 1.5, 0.0, 4.0), 0.5, 0.5, 0.0, 0.0)},
          {"sheet", mix(facets(Opaque, 1.5, 0.0, kInf), 0.5, 0.0, 1.0, 0.0)},
          {"transmitting mix", mix(facets(Solid, 1.5, 0.0, 3.0), 0.6, 0.4, 0.3, 0.7)},
          {"Smith metal", with(facets(Opaque, 0.27, metal, 2.0), Masking::Smith, false)},
          {"Smith glass", with(facets(Solid, 1.5, 0.0, 2.0), Masking::Smith, false)},
          {"interreflection", with(facets(Opaque, 0.27, metal, 1.0), Masking::VCavity, true)},
          {"interreflection, c = 5", with(facets(Opaque, 0.27, metal, 5.0), Masking::Smith, true)},
          {"Phong", literature(PhongModel{30.0})},
          {"Blinn-Phong", literature(BlinnPhongModel{60.0})},
          {"Cook-Torrance", literature(CookTorranceModel{0.3})},
          {"He", literature(HeModel{0.1e-6, 2e-6})},
          {"Oren-Nayar", literature(OrenNayarModel{0.5})},
          {"Hanrahan-Krueger", literature(HanrahanKruegerModel{1.0, 0.5})},
          {"Schlick", literature(SchlickModel{0.3, 0.5})},
          {"GGX", literature(GgxModel{0.3})}};
}

struct Surface {
  ResolvedMaterial<3> resolved;
  Bsdf<3> bsdf;
  Surface(const Material& m, bool front)
      : resolved(resolve_material<3>(m, SpectralBasis::rgb())),
        bsdf(resolved, front, Rgb3::one(), Rgb3::one(), 1.0f) {}
};

Vec3f direction(double mu, double phi) {
  const double s = std::sqrt((1.0 - mu) * (1.0 + mu));
  return Vec3d(s * std::cos(phi), s * std::sin(phi), mu).cast<float>();
}

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  float next() {
    return std::min(static_cast<float>(static_cast<double>(random_()) * 0x1p-32), 1.0f - 0x1p-24f);
  }

 private:
  std::mt19937 random_;
};

// ---- Chi-square ----

constexpr int kRings = 32, kSectors = 24, kInner = 12;
constexpr int kCells = kRings * kSectors;

// Expected share of each cell: midpoints of kInner^2 parts. Rings are even in the angle's cosine.
std::vector<double> integrate(const Bsdf<3>& bsdf, const Vec3f& wo) {
  std::vector<double> share(kCells);
  const double area = 4.0 * kPi / (kCells * kInner * kInner);
  for (int i = 0; i < kRings * kInner; ++i)
    for (int k = 0; k < kSectors * kInner; ++k) {
      const double mu = -1.0 + 2.0 * (i + 0.5) / (kRings * kInner);
      const double phi = 2.0 * kPi * (k + 0.5) / (kSectors * kInner);
      share[static_cast<std::size_t>(i / kInner * kSectors + k / kInner)] +=
          area * static_cast<double>(bsdf.pdf(wo, direction(mu, phi)));
    }
  return share;
}

std::size_t cell(const Vec3f& w) {
  const auto ring = static_cast<int>(0.5 * (static_cast<double>(w.z()) + 1.0) * kRings);
  double turn = std::atan2(static_cast<double>(w.y()), static_cast<double>(w.x())) / (2.0 * kPi);
  if (turn < 0.0) turn += 1.0;
  const auto sector = static_cast<int>(turn * kSectors);
  return static_cast<std::size_t>(std::min(ring, kRings - 1) * kSectors +
                                  std::min(sector, kSectors - 1));
}

// Reflectance of a Dirac event, from the closed forms of MATERIAL_MODEL 5.4 and 9, lane by lane in
// double, as flux.
double dirac_share(const Material& m, const Surface& s, bool front, double mu, Event event,
                   int lane) {
  const double nm = SpectralBasis::rgb().wavelengths_nm()[static_cast<std::size_t>(lane)];
  const auto n0 = static_cast<double>(s.resolved.n[lane]),
             k = static_cast<double>(s.resolved.k[lane]);
  const double f0 = ((n0 - 1) * (n0 - 1) + k * k) / ((n0 + 1) * (n0 + 1) + k * k);
  if (const auto* he = std::get_if<HeModel>(&m.lobe)) {
    const Vec3d b(std::sqrt(1 - mu * mu), 0, mu), l(-b.x(), 0, mu);
    return m.k_rg * he1991<double>(l, b, he->sigma, he->tau, nm * 1e-9, n0, k).specular;
  }
  if (const auto* schlick = std::get_if<SchlickModel>(&m.lobe))
    return m.k_rg * (f0 + (1 - f0) * std::pow(1 - mu, 5)) *
           (1.0 - 4.0 * schlick->r * (1.0 - schlick->r));
  const bool solid = m.medium == Material::Medium::Solid;
  const bool inside = solid && !front;
  const double n1 = inside ? n0 : 1.0, n2 = inside ? 1.0 : n0;
  const double f = fresnel(mu, n2 / n1, inside ? 0.0 : k).mean();
  const double sigma = m.sigma.value_or(0.0);
  if (event == kMirror) return m.k_rg * f * coherent_reflection(mu, sigma, nm * 1e-9, n1);
  return m.k_tp_rg * (1.0 - f) * coherent_transmission(mu, sigma, nm * 1e-9, n1, n2);
}

struct Counts {
  std::vector<double> cells = std::vector<double>(kCells);
  std::array<double, 2> dirac{}, dirac_expected{};  // mirror, refraction
  double absorbed = 0.0;
};

Counts draw(const Surface& s, const Case& c, bool front, const Vec3f& wo, int samples) {
  Counts n;
  Random random(17);
  for (int i = 0; i < samples; ++i) {
    const float choice = random.next();
    const Vec2f u(random.next(), random.next());
    const auto sample = s.bsdf.sample(wo, choice, u, kAllEvents, Transport::Flux);
    if (!sample) {
      ++n.absorbed;
    } else if (!sample->dirac()) {
      ++n.cells[cell(sample->wi)];
    } else {
      const std::size_t at = sample->event == kMirror ? 0 : 1;
      ++n.dirac[at];
      double share = 0.0;  // probability = reflectance / weight
      for (int lane = 0; lane < 3; ++lane)
        share +=
            dirac_share(c.material, s, front, static_cast<double>(wo.z()), sample->event, lane);
      n.dirac_expected[at] = share / 3.0 / static_cast<double>(sample->weight.mean());
    }
  }
  return n;
}

class ChiSquare {
 public:
  explicit ChiSquare(int samples) : samples_(samples) {}
  void add(double expected_share, double count) {
    const double expected = expected_share * samples_;
    if (expected < 10.0) {
      pooled_ += expected;
      pooled_count_ += count;
      return;
    }
    ++cells_;
    sum_ += (count - expected) * (count - expected) / expected;
  }
  // Standard normal of the same probability (Wilson & Hilferty 1931).
  double normal() {
    if (pooled_ >= 10.0) {
      ++cells_;
      sum_ += (pooled_count_ - pooled_) * (pooled_count_ - pooled_) / pooled_;
    } else if (pooled_count_ > 40.0) {
      return kInf;
    }
    const double v = std::max(1, cells_ - 1);
    return (std::cbrt(sum_ / v) - (1.0 - 2.0 / (9.0 * v))) / std::sqrt(2.0 / (9.0 * v));
  }

 private:
  double samples_, sum_ = 0.0, pooled_ = 0.0, pooled_count_ = 0.0;
  int cells_ = 0;
};

// Each of some 100 tests fails by chance with a probability of 1e-6: 4.75 standard deviations.
TEST(BsdfChiSquare, SamplesFollowTheDensity) {
  for (const Case& c : cases())
    for (const bool front : {true, false}) {
      if (!front && c.material.medium != Material::Medium::Solid) continue;
      const Surface s(c.material, front);
      const int samples = std::holds_alternative<HeModel>(c.material.lobe) ? 8000 : 60000;
      for (const double mu : {0.9, 0.25}) {
        const Vec3f wo = direction(mu, 0.7);
        const std::vector<double> share = integrate(s.bsdf, wo);
        const Counts n = draw(s, c, front, wo, samples);
        ChiSquare chi(samples);
        double rest = 1.0;
        for (std::size_t i = 0; i < share.size(); ++i) {
          chi.add(share[i], n.cells[i]);
          rest -= share[i];
        }
        for (std::size_t i = 0; i < 2; ++i) {
          chi.add(n.dirac_expected[i], n.dirac[i]);
          rest -= n.dirac_expected[i];
        }
        EXPECT_GE(rest, -2e-3) << c.name << front << mu;
        chi.add(std::max(rest, 0.0), n.absorbed);
        EXPECT_LT(chi.normal(), 4.75) << c.name << (front ? " front " : " back ") << mu;
      }
    }
}

// ---- Energy ----

struct Estimate {
  double mean, error;
};

// Flux sent out per flux arriving, of the brightest lane. Each Dirac event by itself, where one
// sample says all: as one of many it may be too rare to be drawn at all, and its share of the
// others' weights would look like too much energy.
Estimate sampled_albedo(const Bsdf<3>& bsdf, const Vec3f& wo, int samples) {
  std::array<double, 3> sum{}, square{}, dirac{};
  for (const Event event : {kMirror, kRefraction})
    if (const auto s = bsdf.sample(wo, 0.5f, {0.5f, 0.5f}, event, Transport::Flux))
      for (std::size_t k = 0; k < 3; ++k) dirac[k] += static_cast<double>(s->weight.lane[k]);
  Random random(23);
  for (int i = 0; i < samples; ++i) {
    const float choice = random.next();
    const Vec2f u(random.next(), random.next());
    const auto s = bsdf.sample(wo, choice, u, kDiffuseEvents | kLobeEvents, Transport::Flux);
    for (std::size_t k = 0; s && k < 3; ++k) {
      const auto w = static_cast<double>(s->weight.lane[k]);
      sum[k] += w / samples;
      square[k] += w * w / samples;
    }
  }
  Estimate brightest{0.0, 0.0};
  for (std::size_t k = 0; k < 3; ++k)
    if (sum[k] + dirac[k] > brightest.mean)
      brightest = {sum[k] + dirac[k],
                   std::sqrt(std::max(0.0, square[k] - sum[k] * sum[k]) / samples)};
  return brightest;
}

// MATERIAL_MODEL 11.4: R + T <= 1 for every mode of section 5, c from 0 to 1e4 and mu from 1e-3 to
// 1, from both sides. Nothing absorbs here, so that some of these are at 1. Five standard errors.
TEST(BsdfEnergy, AlbedoIsAtMostOneOnADenseGrid) {
  using enum Material::Medium;
  for (const double c : {0.0, 0.3, 1.0, 2.0, 4.0, 10.0, 100.0, 1e4, kInf}) {
    std::vector<Case> modes = {
        {"white metal", facets(Opaque, 1e-3, 1e6, c)},
        {"glass", facets(Solid, 1.5, 0.0, c)},
        {"coherent metal", facets(Opaque, 1e-3, 1e6, c, 50e-9)},
        {"coherent glass", facets(Solid, 1.5, 0.0, c, 50e-9)},
        {"coherent diamond", facets(Solid, 2.4, 0.0, c, 200e-9)},
        {"mix", mix(facets(Solid, 1.5, 0.0, c), 0.6, 0.4, 0.3, 0.7)},
        {"coherent mix", mix(facets(Solid, 1.3, 0.0, c, 100e-9), 0.3, 0.7, 0.8, 0.2)},
        {"opaque mix", mix(facets(Opaque, 1e-3, 1e6, c), 0.5, 0.5, 1.0, 0.0)},
        {"plastic", coupled(c)},
        {"coherent plastic", coupled(c, 50e-9)}};
    if (c < 1e3) {
      modes.push_back({"Smith", with(facets(Solid, 1.5, 0.0, c), Masking::Smith, false)});
      modes.push_back({"white", with(facets(Opaque, 1e-3, 1e6, c), Masking::VCavity, true)});
    }
    for (Case& mode : modes) {
      if (mode.material.combination == Material::Combination::Coupled)
        mode.material.body_reflectance = 1.0;
      for (const bool front : {true, false}) {
        if (!front && mode.material.medium == Opaque) continue;
        const Surface s(mode.material, front);
        for (const double mu : {1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.7, 0.75, 0.9, 1.0}) {
          const Estimate a = sampled_albedo(s.bsdf, direction(mu, 0.3), 2000);
          EXPECT_LE(a.mean, 1.0 + 5.0 * a.error + 2e-5)
              << mode.name << " c " << c << " mu " << mu << (front ? " front" : " back");
        }
      }
    }
  }
}

// MATERIAL_MODEL 11.7: in uniform surroundings L the radiance is the sum of the albedos times L,
// whichever events are drawn together. The albedo of the body comes from its closed form, that of
// the lobe by quadrature over the sphere, of the Dirac parts from theirs; samples know none of it.
TEST(BsdfEnergy, UniformSurroundingsGiveTheSumOfAlbedos) {
  for (const Case& c : cases()) {
    if (std::holds_alternative<HeModel>(c.material.lobe)) continue;  // its own tests; slow here
    const Surface s(c.material, true);
    const double mu = 0.7;
    const Vec3f wo = direction(mu, 0.3);
    double expected = 0.0;
    constexpr int kPolar = 384, kAround = 384;
    std::array<double, 3> sum{};
    for (int i = 0; i < kPolar; ++i)
      for (int k = 0; k < kAround; ++k) {
        const double z = -1.0 + 2.0 * (i + 0.5) / kPolar;
        const Rgb3 f =
            s.bsdf.eval(wo, direction(z, 2.0 * kPi * (k + 0.5) / kAround), Transport::Flux).lobe;
        for (std::size_t lane = 0; lane < 3; ++lane)
          sum[lane] +=
              static_cast<double>(f.lane[lane]) * std::abs(z) * 4.0 * kPi / kPolar / kAround;
      }
    for (int lane = 0; lane < 3; ++lane) {
      expected += sum[static_cast<std::size_t>(lane)] / 3.0;
      expected += static_cast<double>(s.bsdf.diffuse_reflectance(wo)[lane]) / 3.0;
      expected += static_cast<double>(s.bsdf.diffuse_transmittance()[lane]) / 3.0;
      for (const Event event : {kMirror, kRefraction})
        if (s.bsdf.has(event)) expected += dirac_share(c.material, s, true, mu, event, lane) / 3.0;
    }
    double drawn = 0.0, square = 0.0;
    constexpr int kSamples = 60000;
    Random random(29);
    for (int i = 0; i < kSamples; ++i) {
      const float choice = random.next();
      const Vec2f u(random.next(), random.next());
      const auto sample = s.bsdf.sample(wo, choice, u, kAllEvents, Transport::Flux);
      const double w = sample ? static_cast<double>(sample->weight.mean()) : 0.0;
      drawn += w / kSamples;
      square += w * w / kSamples;
    }
    const double error = std::sqrt(std::max(0.0, square - drawn * drawn) / kSamples);
    EXPECT_NEAR(drawn, expected, 4.75 * error + 1e-3 * expected) << c.name;
  }
}

}  // namespace
}  // namespace atrium::material
