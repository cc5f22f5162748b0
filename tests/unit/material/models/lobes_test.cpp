#include "material/models/lobes.h"

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

constexpr double kPi = std::numbers::pi;
using Lobe = ComparisonLobe<3>;
using Rgb3 = Spectrum<3>;

struct Case {
  std::string name;
  Lobe lobe;
  double albedo_limit = 1.0;  ///< above 1 where the model is only a fit: as documented
};

Rgb3 rgb(float a, float b, float c) {
  Rgb3 s;
  s.lane = {a, b, c};
  return s;
}

// Reflectors that lose nothing (ks = 1, F = 1 through k = 1e6, W = 1): the hardest for bounds.
std::vector<Case> cases() {
  std::vector<Case> all;
  const Rgb3 one = Rgb3::one(), metal(1e6f);
  const auto add = [&](const std::string& name, double number, const Lobe& lobe,
                       double limit = 1.0) {
    all.push_back({name + " " + std::to_string(number), lobe, limit});
  };
  for (const float p : {0.0f, 0.5f, 1.0f, 5.0f, 50.0f, 1e4f}) {
    add("phong", p, PhongLobe<3>{{}, one, p});
    // 2 ks / (p + 1) at normal incidence.
    add("phong 1975", p, PhongLobe<3>{{}, one, p, true}, 2.0);
  }
  for (const float p : {0.0f, 1.0f, 9.9f, 10.1f, 60.0f, 1e4f})
    add("blinn_phong", p, BlinnPhongLobe<3>{{}, one, p});
  for (const float m : {1e-3f, 0.07f, 0.3f, 0.6f, 2.0f})
    add("cook_torrance", m, CookTorranceLobe<3>{{}, one, one, metal, m});
  for (const float alpha : {1e-3f, 0.1f, 0.4f, 1.0f})
    add("ggx", alpha, GgxLobe<3>{{}, {}, {}, one, alpha});
  for (const float s : {0.0f, 0.3f, 1.0f})
    for (const bool full : {false, true})
      add(full ? "oren_nayar full" : "oren_nayar", s,
          OrenNayarLobe<3>{{}, rgb(1.0f, 0.5f, 0.1f), s, full}, 1.06);
  for (const float g : {-0.7f, 0.0f, 0.5f, 0.9f}) {
    add("hanrahan_krueger", g, HanrahanKruegerLobe<3>{{}, one, rgb(0.1f, 1.0f, 1e9f), 1.4f, g});
    add("hanrahan_krueger n = 1", g,
        HanrahanKruegerLobe<3>{{}, one, rgb(0.1f, 1.0f, 1e9f), 1.0f, g});
  }
  for (const float r : {0.001f, 0.05f, 0.3f, 0.5f, 0.8f, 1.0f})
    add("schlick1994", r, Schlick1994Lobe<3>{{}, one, r}, 1.6);
  add("schlick1994 p = 0.2, r", 0.2, Schlick1994Lobe<3>{{}, one, 0.2f, 0.2f}, 1.6);
  // sigma / lambda from smooth to geometric optics, correlation lengths from a wavelength on.
  constexpr float he[][2] = {{0.005f, 1.0f}, {0.05f, 1.0f}, {0.15f, 3.0f}, {0.15f, 0.7f},
                             {0.5f, 10.0f},  {0.5f, 2.0f},  {3.0f, 60.0f}, {3.0f, 10.0f}};
  for (const auto& [sigma, tau] : he)
    add("he sigma " + std::to_string(sigma) + " tau", static_cast<double>(tau),
        He1991Lobe<3>{{}, one, metal, {0.65f, 0.55f, 0.45f}, sigma, tau}, 1.05);
  return all;
}

Vec3f direction(double cosine, double phi) {
  const double s = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return Vec3d(s * std::cos(phi), s * std::sin(phi), cosine).cast<float>();
}

float pdf_of(const Lobe& lobe, const Vec3f& wo, const Vec3f& wi) {
  return std::visit([&](const auto& x) { return x.pdf(wo, wi); }, lobe);
}
Rgb3 eval_of(const Lobe& lobe, const Vec3f& wo, const Vec3f& wi) {
  return std::visit([&](const auto& x) { return x.eval(wo, wi); }, lobe);
}
std::optional<Vec3f> sample_of(const Lobe& lobe, const Vec3f& wo, const Vec2f& u) {
  return std::visit([&](const auto& x) { return x.sample(wo, u); }, lobe);
}
float bound_of(const Lobe& lobe) {
  return std::visit([](const auto& x) { return x.kLargestWeight; }, lobe);
}
Rgb3 mirror_of(const Lobe& lobe, float mu) {
  return std::visit([&](const auto& x) { return x.mirror(mu); }, lobe);
}

// Quadrature over the hemisphere for lobes of any width: rings about the mirror direction of wo,
// radii growing geometrically, blended into a grid over the hemisphere that ends at the horizon.
struct Cell {
  Vec3f wi;
  double solid_angle;
};
double share_of_rings(double angle) {
  const double x = angle / 0.12;
  return 1.0 / (1.0 + x * x * x * x);
}
std::vector<Cell> hemisphere(const Vec3f& wo, int rings, int sectors) {
  std::vector<Cell> cells;
  const Vec3f mirrored(-wo.x(), -wo.y(), wo.z());
  const Frame frame(mirrored);
  const auto radius = [&](int i) {  // from 1e-5 to pi; the first ring is the cap
    return i == 0 ? 0.0 : 1e-5 * std::pow(kPi / 1e-5, static_cast<double>(i) / rings);
  };
  for (int i = 0; i < rings; ++i) {
    const double a = radius(i), b = radius(i + 1), middle = 0.5 * (a + b);
    const double ring = 2.0 * std::sin(middle) * std::sin(0.5 * (b - a));  // cos a - cos b
    for (int j = 0; j < sectors; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / sectors;
      const Vec3f local = Vec3d(std::sin(middle) * std::cos(phi), std::sin(middle) * std::sin(phi),
                                std::cos(middle))
                              .cast<float>();
      const Vec3f wi = frame.to_world(local).normalized();
      if (wi.z() > 0.0f) cells.push_back({wi, share_of_rings(middle) * ring * 2.0 * kPi / sectors});
    }
  }
  // Sectors narrow towards the plane of incidence: lobes at grazing angles are slender.
  const int lines = rings / 2;
  const double plane = std::atan2(static_cast<double>(-wo.y()), static_cast<double>(-wo.x()));
  for (int i = 0; i < lines; ++i) {
    const double a = 0.5 * kPi * i / lines, b = 0.5 * kPi * (i + 1) / lines;
    for (int j = 0; j < sectors; ++j) {
      const double t = 2.0 * (j + 0.5) / sectors - 1.0;
      const double phi = plane + kPi * (0.15 * t + 0.85 * t * t * t);
      const double width = kPi * (0.15 + 2.55 * t * t) * 2.0 / sectors;
      const Vec3f wi = direction(std::cos(0.5 * (a + b)), phi);
      const double half = 0.5 * static_cast<double>((wi - mirrored).norm());
      const double rest = 1.0 - share_of_rings(2.0 * std::asin(std::min(1.0, half)));
      cells.push_back({wi, rest * (std::cos(a) - std::cos(b)) * width});
    }
  }
  return cells;
}

// Densities integrate, with the absorbed share, to 1; the mean weight is the albedo by quadrature.
TEST(Lobes, SamplesFollowTheirDensityInTheMean) {
  for (const Case& c : cases())
    for (const double mu : {0.999, 0.7, 0.2}) {
      SCOPED_TRACE(testing::Message() << c.name << " mu " << mu);
      const Vec3f wo = direction(mu, 0.4);
      double density = 0.0, albedo[3] = {0.0, 0.0, 0.0};
      for (const Cell& cell : hemisphere(wo, 140, 72)) {
        density += static_cast<double>(pdf_of(c.lobe, wo, cell.wi)) * cell.solid_angle;
        const Rgb3 f = eval_of(c.lobe, wo, cell.wi);
        for (int i = 0; i < 3; ++i)
          albedo[i] += static_cast<double>(f[i] * cell.wi.z()) * cell.solid_angle;
      }
      std::mt19937 rng(3);
      std::uniform_real_distribution<float> u(0.0f, 1.0f);
      const int count = 6000;
      double kept = 0.0, sum[3] = {}, sum2[3] = {};
      for (int s = 0; s < count; ++s) {
        const float u1 = std::min(u(rng), 0.99999994f), u2 = std::min(u(rng), 0.99999994f);
        const auto wi = sample_of(c.lobe, wo, {u1, u2});
        if (!wi) continue;
        kept += 1.0;
        const float pdf = pdf_of(c.lobe, wo, *wi);
        ASSERT_GT(pdf, 0.0f);
        const Rgb3 f = eval_of(c.lobe, wo, *wi);
        for (int i = 0; i < 3; ++i) {
          const double weight = static_cast<double>(f[i] * wi->z() / pdf);
          sum[i] += weight;
          sum2[i] += weight * weight;
        }
      }
      // 3e-3: quadrature, most of it where the rings cross the horizon.
      const double p = kept / count;
      EXPECT_NEAR(density, p, 5.0 * std::sqrt(std::max(p * (1.0 - p), 1e-4) / count) + 3e-3);
      for (int i = 0; i < 3; ++i) {
        const double mean = sum[i] / count;
        const double error = std::sqrt(std::max(0.0, sum2[i] / count - mean * mean) / count);
        EXPECT_NEAR(mean, albedo[i], 5.0 * error + 3e-3 * std::max(0.3, albedo[i])) << i;
      }
    }
}

// chi^2 over cells of theta and phi, those of small expectation pooled, the absorbed one of them.
// Significance 1e-5 for some 180 tests; chi^2 to normal by Wilson & Hilferty 1931.
TEST(Lobes, ChiSquareOfSamplesAgainstDensity) {
  for (const Case& c : cases()) {
    if (c.name.find("0.001") != std::string::npos || c.name.find("10000") != std::string::npos)
      continue;  // narrower than the cells; the means above cover them
    for (const double mu : {0.98, 0.5, 0.25}) {
      SCOPED_TRACE(testing::Message() << c.name << " mu " << mu);
      const Vec3f wo = direction(mu, 2.5);
      const int rings = 16, sectors = 32, fine = 10, count = 20000;
      std::vector<double> expected(rings * sectors + 1, 0.0), seen(rings * sectors + 1, 0.0);
      double total = 0.0;
      for (int i = 0; i < rings * fine; ++i)
        for (int j = 0; j < sectors * fine; ++j) {
          const double theta = 0.5 * kPi * (i + 0.5) / (rings * fine);
          const Vec3f wi =
              direction(std::cos(theta), 2.0 * kPi * (j + 0.5) / (sectors * fine) - kPi);
          const double share = static_cast<double>(pdf_of(c.lobe, wo, wi)) * std::sin(theta) *
                               (0.5 * kPi / (rings * fine)) * (2.0 * kPi / (sectors * fine));
          expected[static_cast<std::size_t>(i / fine * sectors + j / fine)] += count * share;
          total += share;
        }
      expected.back() = count * std::max(0.0, 1.0 - total);
      std::mt19937 rng(17);
      std::uniform_real_distribution<float> u(0.0f, 1.0f);
      for (int s = 0; s < count; ++s) {
        const float u1 = std::min(u(rng), 0.99999994f), u2 = std::min(u(rng), 0.99999994f);
        const auto wi = sample_of(c.lobe, wo, {u1, u2});
        std::size_t cell = expected.size() - 1;
        if (wi) {
          const Vec3d w = wi->cast<double>();
          const double theta = std::acos(std::min(1.0, w.z()));
          const double phi = std::atan2(w.y(), w.x()) + kPi;
          const int i = std::min(rings - 1, static_cast<int>(theta / (0.5 * kPi) * rings));
          const int j = std::min(sectors - 1, static_cast<int>(phi / (2.0 * kPi) * sectors));
          cell = static_cast<std::size_t>(i * sectors + j);
        }
        seen[cell] += 1.0;
      }
      double chi2 = 0.0, pooled_expected = 0.0, pooled_seen = 0.0;
      int cells = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        pooled_expected += expected[i];
        pooled_seen += seen[i];
        if (pooled_expected < 10.0) continue;
        chi2 += (pooled_seen - pooled_expected) * (pooled_seen - pooled_expected) / pooled_expected;
        pooled_expected = pooled_seen = 0.0;
        ++cells;
      }
      const double dof = std::max(1, cells - 1);
      const double z =
          (std::cbrt(chi2 / dof) - (1.0 - 2.0 / (9.0 * dof))) / std::sqrt(2.0 / (9.0 * dof));
      EXPECT_LT(z, 4.6) << "chi2 " << chi2 << " of " << cells << " cells";
    }
  }
}

// f cos / pdf over directions of every kind, grazing included.
TEST(Lobes, WeightsAreBounded) {
  for (const Case& c : cases()) {
    double worst = 0.0;
    std::string where;
    for (const double mu : {1.0, 0.95, 0.8, 0.6, 0.4, 0.25, 0.12, 0.05, 0.02, 0.005, 1e-3}) {
      const Vec3f wo = direction(mu, 0.4);
      std::vector<Cell> cells = hemisphere(wo, 40, 24);
      for (double z = 1e-4; z < 1.0; z *= 1.25)
        for (int j = 0; j < 24; ++j) cells.push_back({direction(z, 0.4 + kPi * j / 12), 0.0});
      for (const Cell& cell : cells) {
        const float pdf = pdf_of(c.lobe, wo, cell.wi);
        const float f = eval_of(c.lobe, wo, cell.wi).max() * cell.wi.z();
        ASSERT_TRUE(std::isfinite(f) && std::isfinite(pdf) && pdf >= 0.0f && f >= 0.0f) << c.name;
        if (f < 1e-20f) continue;
        ASSERT_GT(pdf, 0.0f) << c.name << " mu " << mu << " wi " << cell.wi.transpose();
        if (static_cast<double>(f / pdf) > worst) {
          worst = static_cast<double>(f / pdf);
          where = " mu " + std::to_string(mu) + " z " + std::to_string(cell.wi.z());
        }
      }
    }
    EXPECT_LE(worst, static_cast<double>(bound_of(c.lobe)) * 1.001) << c.name << where;
  }
}

// Quadrature in the space of u: the density follows the lobe however slender it is, which a grid of
// directions does not. That density and samples agree is what the tests above show.
TEST(Lobes, AlbedoStaysBelowWhatTheModelPromises) {
  constexpr int side = 48;
  for (const Case& c : cases()) {
    double largest = 0.0, at = 0.0;
    for (const double mu :
         {1.0, 0.97, 0.9, 0.8, 0.65, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05, 0.02, 0.01, 0.003, 1e-3}) {
      const Vec3f wo = direction(mu, 0.4);
      Rgb3 sum;
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const Vec2f u(static_cast<float>((i + 0.5) / side), static_cast<float>((j + 0.5) / side));
          const auto wi = sample_of(c.lobe, wo, u);
          if (wi) sum += eval_of(c.lobe, wo, *wi) * (wi->z() / pdf_of(c.lobe, wo, *wi));
        }
      sum /= static_cast<float>(side * side);
      const double albedo = static_cast<double>((sum + mirror_of(c.lobe, wo.z())).max());
      if (albedo > largest) {
        largest = albedo;
        at = mu;
      }
    }
    EXPECT_LE(largest, c.albedo_limit + 5e-3) << c.name << " mu " << at;  // 5e-3: 48^2 points
  }
}

// blinn_phong_norm() makes the albedo 1 at normal incidence; that no other angle exceeds it, for
// any exponent, is shown here.
TEST(Lobes, BlinnPhongIsBrightestAtNormalIncidence) {
  for (const double mu : {1.0, 0.99, 0.97, 0.94, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5, 0.3, 0.1, 0.01}) {
    const Vec3f wo = direction(mu, 0.4);
    const std::vector<Cell> cells = hemisphere(wo, 120, 48);
    for (float p = 0.0f; p < 2000.0f; p = 1.2f * p + 0.1f) {
      double albedo = 0.0;
      for (const Cell& cell : cells)
        albedo += static_cast<double>(blinn_phong(cell.wi, wo, 0.0f, 1.0f, p) * cell.wi.z()) *
                  cell.solid_angle;
      EXPECT_LE(albedo, 1.0 + 2e-3) << "p " << p << " mu " << mu;
      if (mu == 1.0) {
        EXPECT_NEAR(albedo, 1.0, 2e-3) << "p " << p;
      }
    }
  }
}

// Against a thinner medium the density has a pole of 1/sqrt at the critical angle, so integrate
// over the directions inside: dw = n^2 mu/cos dw'.
TEST(Lobes, HanrahanKruegerBeyondTheCriticalAngle) {
  const float n = 0.8f, g = 0.2f;
  const HanrahanKruegerLobe<3> lobe{{}, Rgb3::one(), Rgb3::one(), n, g};
  const Vec3f wo = direction(0.9, 0.4);
  double total = 0.0;
  const int lines = 200, sectors = 200;
  for (int i = 0; i < lines; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double mu = (i + 0.5) / lines;
      const Vec3f v = direction(mu, 2.0 * kPi * (j + 0.5) / sectors);
      const Vec3f wi(n * v.x(), n * v.y(), std::sqrt(1.0f - n * n * (1.0f - v.z() * v.z())));
      const double stretch = static_cast<double>(n * n * v.z() / wi.z());
      total += static_cast<double>(lobe.pdf(wo, wi)) * stretch * 2.0 * kPi / (lines * sectors);
    }
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  const int count = 40000;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const auto wi = lobe.sample(wo, {u(rng), u(rng)});
    if (!wi) continue;
    ++kept;
    EXPECT_GT(wi->z(), 0.599f);  // the cone of escape, cos^2 = 1 - n^2
    EXPECT_LE(lobe.eval(wo, *wi).max() * wi->z(), lobe.pdf(wo, *wi));
  }
  EXPECT_NEAR(total, static_cast<double>(kept) / count, 5.0 * 0.5 / std::sqrt(count) + 1e-3);
  EXPECT_FALSE(lobe.sample(direction(0.5, 0.0), {0.5f, 0.5f}));  // beyond it nothing enters
  EXPECT_EQ(lobe.pdf(direction(0.5, 0.0), wo), 0.0f);
}

}  // namespace
}  // namespace atrium::material
