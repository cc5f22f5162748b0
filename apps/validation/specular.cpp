#include <cmath>
#include <memory>
#include <numbers>

#include "validation/case.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using Part = Solution::Part;
using scene::Side;

Case specular(std::string name, std::string source) {
  return {"Mirrors, windows, sheets", std::move(name), std::move(source), {}, 8, {}};
}

/// Plates at x = 0, which emits 1, and x = 2, with perfect mirrors all round: infinite planes.
struct Corridor {
  double rho0, rho1;
};
void build(SceneKit& kit, const Corridor& c) {
  const auto mirror = kit.perfect_mirror();
  kit.room({0, 0, 0}, {2, 1, 1},
           {kit.diffuse(c.rho0, 1.0), kit.diffuse(c.rho1), mirror, mirror, mirror, mirror});
}
const std::vector<Vec3d> kMiddle{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}};

radiosity::SolveOptions corridor_options(std::uint64_t seed) {
  return {.element_size = 0.25, .direct_samples = 256, .caustic_photons = 200000, .seed = seed};
}

Case parallel_planes() {
  Case c = specular("infinite parallel planes: a corridor of four mirrors",
                    "B1 = (M1 + rho1 M2) / (1 - rho1 rho2)");
  for (const auto& [r0, r1] : {std::pair{0.5, 0.8}, {0.9, 0.9}}) {
    const std::string rho =
        ", rho = " + std::to_string(r0).substr(0, 3) + ", " + std::to_string(r1).substr(0, 3);
    const double b = 1 / (1 - r0 * r1);
    c.quantities.push_back({"B of the emitter" + rho, b});
    c.quantities.push_back({"B opposite" + rho, r1 * b});
  }
  c.measure = [](std::uint64_t seed) {
    std::vector<double> values;
    for (const Corridor& k : {Corridor{0.5, 0.8}, Corridor{0.9, 0.9}}) {
      SceneKit kit;
      build(kit, k);
      const Solution s(kit.build(), corridor_options(seed));
      values.push_back(1 + k.rho0 * s.mean("x0", Part::Total));
      values.push_back(k.rho1 * s.mean("x1", Part::Total));
    }
    return values;
  };
  return c;
}

// Plates of a corridor with a pane half-way that passes T of diffuse light and reflects R:
//   E0 = R B0 + T B1, E1 = T B0 + R B1, B0 = 1 + rho0 E0, B1 = rho1 E1.
struct TwoRooms {
  double e0, e1;
};
TwoRooms two_rooms(const Corridor& c, double t, double r) {
  // B1 = rho1 (T B0 + R B1), so B1 = k B0.
  const double k = c.rho1 * t / (1 - c.rho1 * r);
  const double b0 = 1 / (1 - c.rho0 * (r + t * k));
  return {(r + t * k) * b0, (t + r * k) * b0};
}

// Diffuse reflectance of a clear pane of index n, n by Fresnel, both faces with all reflections
// between them: 2 int R mu dmu, R = 2 r / (1 + r) for each polarisation.
double diffuse_pane_reflectance(double n) {
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps, inside = std::sqrt(1 - (1 - mu * mu) / (n * n));
    const double s = std::pow((mu - n * inside) / (mu + n * inside), 2);
    const double p = std::pow((n * mu - inside) / (n * mu + inside), 2);
    sum += 2 * mu * 0.5 * (2 * s / (1 + s) + 2 * p / (1 + p)) / kSteps;
  }
  return sum;
}

Case window(const std::string& name, double n, double tint, const Corridor& corridor) {
  const double r = n > 1.0 ? diffuse_pane_reflectance(n) : 0.0;
  const TwoRooms expected = two_rooms(corridor, (1 - r) * tint, r);
  Case c = specular("two half-rooms behind a window, " + name,
                    n > 1.0 ? "2 x 2 system, diffuse R and T by quadrature of Fresnel's equations"
                            : "2 x 2 system");
  c.quantities = {{"E in the lit half", expected.e0, Kind::Global, expected.e1},
                  {"E behind the window", expected.e1}};
  c.measure = [n, tint, corridor](std::uint64_t seed) {
    SceneKit kit;
    build(kit, corridor);
    kit.polygon("window", kit.pane(n, tint), kMiddle);
    const Solution s(kit.build(), corridor_options(seed));
    return std::vector{s.mean("x0", Part::Total), s.mean("x1", Part::Total)};
  };
  return c;
}

// A sheet between the plates: E_a on its side towards the lamp, E_b on the other.
//   E_a = 1 + r0 e0, e0 = rho E_a + tau E_b, E_b = r1 e1, e1 = rho E_b + tau E_a.
Case diffuse_sheet() {
  constexpr double kRho = 0.3, kTau = 0.5;
  static constexpr Corridor kCorridor{0.4, 0.7};
  const double k = kCorridor.rho1 * kTau / (1 - kCorridor.rho1 * kRho);
  const double ea = 1 / (1 - kCorridor.rho0 * (kRho + kTau * k)), eb = k * ea;
  Case c = specular("diffuse sheet (rho 0.3, tau 0.5) between plates, mirrors as side walls",
                    "4 x 4 system");
  c.quantities = {{"E of the sheet towards the lamp", ea},
                  {"E of the sheet, other side", eb},
                  {"E of the lamp", kRho * ea + kTau * eb},
                  {"E of the far plate", kRho * eb + kTau * ea}};
  c.measure = [](std::uint64_t seed) {
    SceneKit kit;
    build(kit, kCorridor);
    kit.polygon("sheet", kit.sheet(kRho, kTau), kMiddle);
    const Solution s(kit.build(), corridor_options(seed));
    return std::vector{s.mean("sheet", Part::Total, Side::Back), s.mean("sheet", Part::Total),
                       s.mean("x0", Part::Total), s.mean("x1", Part::Total)};
  };
  return c;
}

// Reflected in its mirror wall the room is the doubled room without it.
Case mirror_wall() {
  Case c = specular("box with one mirror wall", "the doubled box with both lamps (itself sampled)");
  c.quantities = {{"mean E / doubled", 1.0},
                  {"floor", 1.0},
                  {"wall opposite the mirror", 1.0},
                  {"RMS over elements of E / doubled - 1", 0.02, Kind::AtMost}};
  c.measure = [](std::uint64_t seed) {
    radiosity::SolveOptions options{.element_size = 0.5,
                                    .gather_rays = 256,
                                    .direct_samples = 64,
                                    .caustic_photons = 400000,
                                    .seed = seed};
    SceneKit half;
    const auto white = half.diffuse(0.6), mirror = half.perfect_mirror();
    half.room({0, 0, 0}, {2, 2, 2}, {mirror, white, white, white, white, white});
    half.point_light({0.7, 1.1, 1.3}, 10.0);
    const Solution a(half.build(), options);
    options.seed += 1000;
    SceneKit doubled;
    doubled.room({-2, 0, 0}, {2, 2, 2}, doubled.diffuse(0.6));
    doubled.point_light({0.7, 1.1, 1.3}, 10.0);
    doubled.point_light({-0.7, 1.1, 1.3}, 10.0);
    const Solution b(doubled.build(), options);

    struct Flux {
      double here = 0.0, there = 0.0;
      [[nodiscard]] double ratio() const { return here / there; }
    } all, floor, opposite;
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < a.element_count(); ++i)
      for (std::size_t k = 0; k < b.element_count(); ++k) {
        if ((a.centre(i) - b.centre(k)).norm() > 1e-3) continue;
        const double e = a.irradiance(i, Part::Total), f = b.irradiance(k, Part::Total);
        for (Flux* sum : {&all, a.object_name(i) == "z0" ? &floor : nullptr,
                          a.object_name(i) == "x1" ? &opposite : nullptr})
          if (sum != nullptr) {
            sum->here += a.area(i) * e;
            sum->there += a.area(i) * f;
          }
        squares += std::pow(e / f - 1, 2);
        ++count;
      }
    return std::vector{all.ratio(), floor.ratio(), opposite.ratio(), std::sqrt(squares / count)};
  };
  return c;
}

}  // namespace

std::vector<Case> specular_cases() {
  return {parallel_planes(), mirror_wall(), window("transmittance 0.6", 1.0, 0.6, {0.5, 0.8}),
          window("clear glass, n = 1.52", 1.52, 1.0, {0.5, 0.8}), diffuse_sheet()};
}

}  // namespace atrium::validation
