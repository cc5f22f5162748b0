// CIE 171:2006 sections 5.2 to 5.8. Geometry from the report, references from closed forms: its
// printed tables are off by up to 0.25 % and partly wrong (5.7).
#include <cmath>
#include <numbers>

#include "radiosity/measure.h"
#include "validation/case.h"
#include "validation/reference.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using radiosity::Sensor;
using reference::Polygon;
using Part = Solution::Part;

constexpr double kPi = std::numbers::pi;
constexpr auto kLux = scene::RadianceUnit::Nit;

Case cie(std::string name, std::string source, int replicates) {
  return {"CIE 171:2006", std::move(name), std::move(source), {}, replicates, {}};
}

std::string text(double x) {
  char s[32];
  std::snprintf(s, sizeof s, "%g", x);
  return s;
}

/// Illuminance at sensors in a scene whose surfaces' light is `field`.
std::vector<double> readings(const scene::RayQuery& query, const scene::SurfaceField& field,
                             const std::vector<Sensor>& sensors, std::uint64_t seed) {
  const radiosity::MeasureResult result = radiosity::measure(
      query, material::SpectralBasis::grey(), field, sensors, {.error = 0.002, .seed = seed});
  std::vector<double> values;
  for (const radiosity::Reading& r : result.readings) values.push_back(r.total.y);
  return values;
}
/// In a scene where nothing reflects.
std::vector<double> readings(const scene::Scene& scene, const std::vector<Sensor>& sensors) {
  return readings(scene::RayQuery(scene), {}, sensors, 1);
}

// Six points down the middle of the wall y = 0, eight along the middle of floor or ceiling.
const std::vector<double> kWallHeights{2.75, 2.25, 1.75, 1.25, 0.75, 0.25};

Case point_source() {
  Case c = cie("5.2 point source, Lambertian, 1000 cd, 3 m over the floor", "E = I0 h^2 / d^4", 1);
  std::vector<Sensor> sensors;
  for (const auto& [x, y] : {std::pair{0.0, 0.0},
                             {0.5, 0.0},
                             {1.0, 0.0},
                             {1.5, 0.0},
                             {0.5, 0.5},
                             {1.0, 0.5},
                             {1.5, 0.5},
                             {1.0, 1.0},
                             {1.5, 1.0},
                             {1.5, 1.5}}) {
    const double d2 = x * x + y * y + 9;
    c.quantities.push_back(
        {"E(" + text(x) + ", " + text(y) + ") [lx]", 9000 / (d2 * d2), Kind::Point});
    sensors.push_back({{x, y, 0}, {0, 0, 1}});
  }
  c.measure = [sensors](std::uint64_t) {
    SceneKit kit(kLux);
    kit.polygon("floor", kit.diffuse(0.0), {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
    kit.lambertian_light({0, 0, 3}, 1000.0);
    return readings(kit.build(), sensors);
  };
  return c;
}

Case area_source() {
  Case c = cie("5.3 panel of 1 m2, 1000 cd/m2, in the ceiling of a black room 4 x 4 x 3 m",
               "E = L pi F, Lambert's formula", 1);
  const Polygon panel{{1.5, 1.5, 3}, {1.5, 2.5, 3}, {2.5, 2.5, 3}, {2.5, 1.5, 3}};
  std::vector<Sensor> sensors;
  const auto add = [&](const std::string& name, const Vec3d& p, const Vec3d& n) {
    c.quantities.push_back({name, 1000 * kPi * reference::point_factor(p, n, panel), Kind::Point});
    sensors.push_back({p, n});
  };
  for (const double z : kWallHeights) add("wall, z = " + text(z) + " [lx]", {2, 0, z}, {0, 1, 0});
  for (const double y : {0.25, 0.75, 1.25, 1.75})
    add("floor, y = " + text(y) + " [lx]", {2, y, 0}, {0, 0, 1});
  c.measure = [sensors, panel](std::uint64_t) {
    SceneKit kit(kLux);
    const auto black = kit.diffuse(0.0);
    kit.polygon("floor", black, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
    kit.polygon("wall", black, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
    kit.polygon("panel", kit.diffuse(0.0, 1000 * kPi), panel);
    return readings(kit.build(), sensors);
  };
  return c;
}

Case flux_conservation() {
  Case c = cie("5.4 flux conservation, isotropic 10 klm in a black room 4 x 4 x 3 m",
               "what arrives is what is emitted", 8);
  c.quantities = {{"sum of E A [lm]", 10000.0}};
  c.measure = [](std::uint64_t seed) {
    SceneKit kit(kLux);
    kit.room({0, 0, 0}, {4, 4, 3}, kit.diffuse(1e-6));  // black surfaces have no elements
    kit.point_light({2, 2, 2}, 10000 / (4 * kPi));
    const Solution s(kit.build(),
                     {.element_size = 0.25, .row_rays = 16, .gather_rays = 16, .seed = seed});
    return std::vector{s.sum("", Part::Direct).flux};
  };
  return c;
}

Case glass() {
  constexpr double kIndex = 1.52;
  Case c = cie("5.5 directional transmittance of clear glass, n = 1.52, no absorption",
               "incoherent slab, T = (1 - R) / (1 + R) per polarisation, then averaged", 1);
  const std::vector<double> angles{0, 10, 20, 30, 40, 50, 60, 70, 80};
  for (const double a : angles)
    c.quantities.push_back({"T at " + text(a) + " deg",
                            reference::pane_transmittance(kIndex, std::cos(a * kPi / 180)),
                            Kind::Point});
  c.measure = [angles](std::uint64_t) {
    std::vector<double> values;
    for (const double a : angles) {
      const auto reading = [&](bool with_pane) {
        SceneKit kit(kLux);
        const auto floor = kit.diffuse(0.0);
        kit.polygon("floor", floor, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
        if (with_pane)
          kit.polygon("pane", kit.pane(kIndex, 1.0),
                      {{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}});
        const double angle = a * kPi / 180;
        kit.directional_light({std::sin(angle), 0, std::cos(angle)}, 1000.0);
        return readings(kit.build(), {{{0, 0, 0}, {0, 0, 1}}})[0];
      };
      values.push_back(reading(true) / reading(false));
    }
    return values;
  };
  return c;
}

// Sunlight falls on a reflecting square of 4 m in the ground, past wall and ceiling (from the side,
// so that neither is lit); they receive what it reflects.
Case diffuse_reflection() {
  constexpr double kRho = 0.3;
  Case c = cie("5.6 reflection by a diffuse ground, scenario 2 (4 x 4 m, rho 0.3)",
               "E / (E_hz rho) = F, Lambert's formula, in %", 8);
  const Polygon ground{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  std::vector<Sensor> sensors;
  const auto add = [&](const std::string& name, const Vec3d& p, const Vec3d& n) {
    c.quantities.push_back({name, 100 * reference::point_factor(p, n, ground), Kind::Point});
    sensors.push_back({p, n});
  };
  for (const double z : {0.75, 1.25, 1.75, 2.25, 2.75})
    add("wall, z = " + text(z), {2, 0, z}, {0, 1, 0});
  for (const double y : {0.25, 0.75, 1.25, 1.75})
    add("ceiling, y = " + text(y), {2, y, 3}, {0, 0, -1});
  c.measure = [sensors, ground](std::uint64_t seed) {
    SceneKit kit(kLux);
    const auto black = kit.diffuse(0.0);
    kit.polygon("ground", kit.diffuse(kRho), ground);
    kit.polygon("wall", black, {{0, 0, 0.5}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0.5}});
    kit.polygon("ceiling", black, {{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
    kit.directional_light({std::sqrt(0.75), 0, 0.5}, 20000.0);  // 30 degrees high: E_hz = 10 klx
    const Solution s(kit.build(), {.element_size = 0.5, .seed = seed});
    std::vector<double> values = readings(s.query(), s.result().field, sensors, seed);
    for (double& v : values) v *= 100 / (10000 * kRho);
    return values;
  };
  return c;
}

/// The part of the wall y = 4 (z from 0 to 3) that a beam across the room, y from 2.5 to 2.7 and up
/// to z = 1, leaves visible from p: above the shadow line of the edge that is higher from there.
Polygon above_obstruction(const Vec3d& p) {
  double line = 0.0;
  for (const double y : {2.5, 2.7})
    line = std::max(line, p.z() + (1 - p.z()) * (4 - p.y()) / (y - p.y()));
  if (line >= 3) return {};
  return {{0, 4, line}, {4, 4, line}, {4, 4, 3}, {0, 4, 3}};
}

Case obstruction() {
  constexpr double kRho = 0.6;
  Case c = cie(
      "5.7 reflection by a diffuse wall past an obstruction (rho 0.6)",
      "E / (E_v rho) = F of the part above the shadow line, in %; the report's Table 19 is wrong",
      8);
  std::vector<Sensor> sensors;
  const auto add = [&](const std::string& name, const Vec3d& p, const Vec3d& n) {
    // Errors of dark points count against a tenth of the brightest.
    c.quantities.push_back(
        {name, 100 * reference::point_factor(p, n, above_obstruction(p)), Kind::Point, 1.6});
    sensors.push_back({p, n});
  };
  for (const double z : kWallHeights) add("wall, z = " + text(z), {2, 0, z}, {0, 1, 0});
  for (const double y : {0.25, 0.75, 1.25, 1.75, 2.25})
    add("floor, y = " + text(y), {2, y, 0}, {0, 0, 1});
  c.measure = [sensors](std::uint64_t seed) {
    SceneKit kit(kLux);
    const auto black = kit.diffuse(0.0);
    kit.polygon("bright wall", kit.diffuse(kRho), {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
    kit.polygon("wall", black, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
    kit.polygon("floor", black, {{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {0, 2.5, 0}});
    kit.polygon("near face", black, {{0, 2.5, 0}, {4, 2.5, 0}, {4, 2.5, 1}, {0, 2.5, 1}});
    kit.polygon("far face", black, {{0, 2.7, 0}, {0, 2.7, 1}, {4, 2.7, 1}, {4, 2.7, 0}});
    kit.polygon("top", black, {{0, 2.5, 1}, {4, 2.5, 1}, {4, 2.7, 1}, {0, 2.7, 1}});
    // Level and so far from the side that neither obstruction nor wall shades the bright wall.
    kit.directional_light({0.96, -0.28, 0}, 10000 / 0.28);
    const Solution s(kit.build(), {.element_size = 0.5, .seed = seed});
    std::vector<double> values = readings(s.query(), s.result().field, sensors, seed);
    for (double& v : values) v *= 100 / (10000 * kRho);
    return values;
  };
  return c;
}

Case interreflection() {
  Case c = cie("5.8 interreflection, 10 klm in the middle of a 4 m cube, eleven reflectances",
               "mean indirect E = rho Phi / (A (1 - rho)), exact as area mean", 8);
  const std::vector<double> reflectances{0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
  for (const double rho : reflectances)
    c.quantities.push_back(
        {"mean indirect E, rho = " + text(rho) + " [lx]", rho * 10000 / (96 * (1 - rho))});
  c.measure = [reflectances](std::uint64_t seed) {
    std::vector<double> values;
    for (const double rho : reflectances) {
      SceneKit kit(kLux);
      kit.room({0, 0, 0}, {4, 4, 4}, kit.diffuse(rho));
      kit.point_light({2, 2, 2}, 10000 / (4 * kPi));
      const Solution s(kit.build(), {.element_size = 0.5, .seed = seed});
      values.push_back(s.mean("", Part::Indirect));
    }
    return values;
  };
  return c;
}

}  // namespace

std::vector<Case> cie171_cases() {
  return {point_source(),       area_source(), flux_conservation(), glass(),
          diffuse_reflection(), obstruction(), interreflection()};
}

}  // namespace atrium::validation
