#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/LU>

#include "validation/case.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using radiosity::SolveOptions;
using radiosity::Solver;
using Part = Solution::Part;

constexpr double kPi = std::numbers::pi;

std::string text(double x) {
  std::string s = std::to_string(x);
  while (s.back() == '0') s.pop_back();
  return s;
}

Case enclosure(std::string name, std::string source, int replicates) {
  return {"Enclosures", std::move(name), std::move(source), {}, replicates, {}};
}

struct Extremes {
  double least = 1e300, most = -1e300;
};
Extremes extremes(const Solution& s, const std::string& name, Part part) {
  Extremes x;
  for (std::size_t e = 0; e < s.element_count(); ++e) {
    if (!s.object_name(e).starts_with(name)) continue;
    x.least = std::min(x.least, s.irradiance(e, part));
    x.most = std::max(x.most, s.irradiance(e, part));
  }
  return x;
}

// B = M + rho E with E = M / (1 - rho) in every element.
Case furnace_exact() {
  Case c = enclosure("furnace: all surfaces emit M = 1, matrix", "B = M / (1 - rho)", 1);
  for (const double rho : {0.2, 0.5, 0.9, 0.95})
    for (const char* which : {"least B", "largest B"})
      c.quantities.push_back(
          {std::string(which) + ", rho = " + text(rho), 1 / (1 - rho), Kind::Exact});
  c.measure = [](std::uint64_t) {
    std::vector<double> values;
    for (const double rho : {0.2, 0.5, 0.9, 0.95}) {
      SceneKit kit;
      kit.room({0, 0, 0}, {4, 3, 2.5}, kit.diffuse(rho, 1.0));
      const Solution s(kit.build(), {.solver = Solver::Matrix, .element_size = 1.0});
      const Extremes e = extremes(s, "", Part::Total);
      values.insert(values.end(), {1 + rho * e.least, 1 + rho * e.most});
    }
    return values;
  };
  return c;
}

Case furnace_sampled() {
  Case c = enclosure("furnace: all surfaces emit M = 1", "B = M / (1 - rho)", 4);
  for (const char* solver : {"rows", "shooting"})
    for (const double rho : {0.2, 0.5, 0.9})
      c.quantities.push_back(
          {std::string("mean B, rho = ") + text(rho) + ", " + solver, 1 / (1 - rho)});
  c.measure = [](std::uint64_t seed) {
    std::vector<double> values;
    for (const Solver solver : {Solver::Rows, Solver::Shooting})
      for (const double rho : {0.2, 0.5, 0.9}) {
        SceneKit kit;
        kit.room({0, 0, 0}, {4, 3, 2.5}, kit.diffuse(rho, 1.0));
        const Solution s(
            kit.build(),
            {.solver = solver, .element_size = 1.0, .direct_samples = 256, .seed = seed});
        values.push_back(1 + rho * s.mean("", Part::Total));
      }
    return values;
  };
  return c;
}

// A room with a table and a lamp below the ceiling: any closed room of uniform reflectance. Both
// sides of lamp and table belong to it.
Case closed_room() {
  const std::vector<double> reflectances{0.3, 0.7, 0.9};
  Case c =
      enclosure("closed furnished room, uniform rho", "mean E = Phi / (A (1 - rho)), any light", 4);
  for (const char* solver : {"rows", "shooting", "matrix"})
    for (const double rho : reflectances)
      c.quantities.push_back(
          {std::string("mean E A (1 - rho) / Phi, rho = ") + text(rho) + ", " + solver, 1.0});
  c.measure = [reflectances](std::uint64_t seed) {
    std::vector<double> values;
    for (const Solver solver : {Solver::Rows, Solver::Shooting, Solver::Matrix})
      for (const double rho : reflectances) {
        SceneKit kit;
        const auto white = kit.diffuse(rho);
        kit.room({0, 0, 0}, {4, 3, 2.5}, white);
        kit.polygon("lamp", kit.diffuse(rho, 5.0),
                    {{1, 1, 2.2}, {1, 2, 2.2}, {2, 2, 2.2}, {2, 1, 2.2}});
        kit.polygon("table", white, {{2.5, 1, 0.7}, {3.5, 1, 0.7}, {3.5, 2, 0.7}, {2.5, 2, 0.7}});
        const Solution s(kit.build(), {.solver = solver,
                                       .element_size = 1.0,
                                       .row_rays = 512,
                                       .gather_rays = 512,
                                       .direct_samples = 1024,
                                       .seed = seed});
        const double flux = s.sum("", Part::Total).flux +
                            s.sum("lamp", Part::Total, scene::Side::Back).flux +
                            s.sum("table", Part::Total, scene::Side::Back).flux;
        values.push_back(flux * (1 - rho) / 5.0);
      }
    return values;
  };
  return c;
}

// Unit cube, one constant element per face, face 0 emits: 3 unknowns by symmetry, factors from the
// closed forms.
Eigen::Vector3d goral(double rho_emitter, double rho) {
  const double parallel = 0.19982489569838746;
  const double side = (1 - parallel) / 4;
  Eigen::Matrix3d f;  // emitter, opposite, sides
  f << 0, parallel, 4 * side, parallel, 0, 4 * side, side, side, parallel + 2 * side;
  const Eigen::Vector3d r(rho_emitter, rho, rho);
  return (Eigen::Matrix3d::Identity() - r.asDiagonal() * f).inverse() * Eigen::Vector3d(1, 0, 0);
}

struct Goral {
  double rho_emitter, rho;
};
const std::vector<Goral>& goral_cases() {
  static const std::vector<Goral> list{{0.5, 0.5}, {0.8, 0.8}, {0.95, 0.95}, {0.0, 0.5}};
  return list;
}

Case goral_cube(Solver solver, const char* name, bool is_exact) {
  Case c = enclosure(std::string("Goral cube, one element per face, ") + name,
                     "3 x 3 system with closed-form factors", is_exact ? 1 : 8);
  for (const Goral& g : goral_cases()) {
    const Eigen::Vector3d b = goral(g.rho_emitter, g.rho);
    const std::string rho =
        ", rho = " + text(g.rho) + (g.rho_emitter == 0.0 ? ", black emitter" : "");
    const Kind kind = is_exact ? Kind::Exact : Kind::Global;
    if (g.rho_emitter > 0.0) c.quantities.push_back({"B emitter" + rho, b[0], kind});
    c.quantities.push_back({"B opposite" + rho, b[1], kind});
    c.quantities.push_back({"B side" + rho, b[2], kind});
  }
  c.measure = [solver](std::uint64_t seed) {
    std::vector<double> values;
    for (const Goral& g : goral_cases()) {
      SceneKit kit;
      const auto white = kit.diffuse(g.rho);
      const auto lamp = kit.diffuse(g.rho_emitter, 1.0);
      kit.room({0, 0, 0}, {1, 1, 1}, {lamp, white, white, white, white, white});
      const Solution s(kit.build(), {.solver = solver,
                                     .element_size = 10.0,
                                     .row_rays = 1024,
                                     .gather_rays = 1024,
                                     .direct_samples = 4096,
                                     .tolerance = solver == Solver::Rows ? 1e-4 : 1e-8,
                                     .seed = seed});
      if (g.rho_emitter > 0.0) values.push_back(1 + g.rho_emitter * s.mean("x0", Part::Total));
      values.push_back(g.rho * s.mean("x1", Part::Total));
      values.push_back(g.rho * (s.sum("y", Part::Total).flux + s.sum("z", Part::Total).flux) / 4);
    }
    return values;
  };
  return c;
}

// Three zones of different reflectance and exitance. Of the sphere; a polyhedron of n triangles
// has other factors and areas, an error that falls as 1 / n.
struct Zone {
  double rho, exitance;
};
constexpr Zone kZones[] = {{0.8, 1.0}, {0.5, 0.0}, {0.2, 0.3}};

Case sphere_zones(int levels, bool converged) {
  const std::string triangles = std::to_string(8 << (2 * levels));
  Case c = enclosure("sphere of three zones, " + triangles + " triangles",
                     std::string("H = sum f_k M_k / (1 - sum f_k rho_k), f_k of the triangles") +
                         (converged ? "" : "; the rows are the error of the tessellation"),
                     8);
  for (int k = 0; k < 3; ++k) {
    const std::string zone = "H, zone " + std::to_string(k + 1);
    if (converged)
      c.quantities.push_back({zone + " / closed form", 1.0});
    else
      c.quantities.push_back({zone + ": deviation", 0.01, Kind::AtMost});
  }
  c.measure = [levels, converged](std::uint64_t seed) {
    SceneKit kit;
    std::vector<scene::MaterialId> zones;
    for (const Zone& z : kZones) zones.push_back(kit.diffuse(z.rho, z.exitance));
    kit.sphere("zone", zones, 1.0, levels, true);
    const Solution s(kit.build(), {.element_size = 0.2, .direct_samples = 128, .seed = seed});
    double emitted = 0.0, kept = 0.0;
    std::vector<double> values;
    for (std::size_t k = 0; k < 3; ++k) {
      const Solution::Sum sum = s.sum("zone" + std::to_string(k), Part::Total);
      emitted += sum.area * kZones[k].exitance;
      kept += sum.area * (1 - kZones[k].rho);
      values.push_back(sum.mean());
    }
    for (double& v : values) {
      v *= kept / emitted;
      if (!converged) v = std::abs(v - 1);
    }
    return values;
  };
  return c;
}

Case sphere_point_source() {
  constexpr double kRho = 0.6, kIntensity = 10.0;
  Case c = enclosure("point source off the centre of a sphere, 2048 triangles",
                     "indirect E = rho Phi / (A (1 - rho)) everywhere", 8);
  c.quantities = {{"mean indirect E / closed form", 1.0},
                  {"top third", 1.0},
                  {"middle third", 1.0},
                  {"bottom third", 1.0},
                  {"least direct E / largest", 0.3, Kind::AtMost}};
  c.measure = [](std::uint64_t seed) {
    SceneKit kit;
    const auto white = kit.diffuse(kRho);
    const std::vector zones{white, white, white};
    kit.sphere("zone", zones, 2.0, 4, true);
    kit.point_light({0.9, 0.3, -0.5}, kIntensity);
    const Solution s(kit.build(), {.element_size = 0.4, .direct_samples = 64, .seed = seed});
    const double exact =
        kRho * 4 * kPi * kIntensity / (s.sum("", Part::Indirect).area * (1 - kRho));
    const Extremes direct = extremes(s, "", Part::Direct);
    return std::vector{s.mean("", Part::Indirect) / exact, s.mean("zone0", Part::Indirect) / exact,
                       s.mean("zone1", Part::Indirect) / exact,
                       s.mean("zone2", Part::Indirect) / exact, direct.least / direct.most};
  };
  return c;
}

// An open scene, so that absorbed and escaped flux both count.
Case flux_balance(Solver solver, const char* name, double bound, int replicates) {
  Case c = enclosure(std::string("flux balance, two plates and a lamp in the open, ") + name,
                     "emitted = absorbed + escaped, counted independently", replicates);
  c.quantities = {{"imbalance / emitted", bound, Kind::AtMost},
                  {"escaped / emitted", 0.9, Kind::AtMost}};
  if (replicates > 1)
    c.quantities.push_back(
        {"imbalance / stated standard error, mean (0.8 if normal)", 1.5, Kind::AtMost});
  c.measure = [solver, replicates](std::uint64_t seed) {
    SceneKit kit;
    const auto white = kit.diffuse(0.6);
    kit.polygon("floor", white, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
    kit.polygon("wall", white, {{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
    kit.polygon("lamp", kit.diffuse(0.6, 1.0),
                {{1, 0.5, 1.5}, {1, 1.5, 1.5}, {2, 1.5, 1.5}, {2, 0.5, 1.5}});
    const Solution s(
        kit.build(),
        {.solver = solver, .element_size = 0.25, .direct_samples = 1024, .seed = seed});
    const radiosity::FluxBalance& f = s.result().flux;
    const double imbalance = std::abs(f.absorbed + f.escaped - f.emitted);
    std::vector values{imbalance / f.emitted, f.escaped / f.emitted};
    if (replicates > 1) values.push_back(imbalance / f.standard_error);
    return values;
  };
  return c;
}

// A_1 F_12 = A_2 F_21 for plates of which one emits, then the other; obstructed and as sampled.
Case reciprocity() {
  Case c = enclosure("reciprocity of direct light between plates of 1 and 3 m2, a screen between",
                     "A1 F12 = A2 F21", 8);
  c.quantities = {{"A1 F12 / (A2 F21), rows", 1.0}, {"A1 F12 / (A2 F21), matrix", 1.0}};
  c.measure = [](std::uint64_t seed) {
    const auto exchange = [&](Solver solver, bool first) {
      SceneKit kit;
      const auto lamp = kit.diffuse(0.5, 1.0), plate = kit.diffuse(0.5);
      kit.polygon("a", first ? lamp : plate, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
      kit.polygon("b", first ? plate : lamp,
                  {{-0.5, 0, 0.5}, {-0.5, 1, 0.5}, {-0.5, 1, 3.5}, {-0.5, 0, 3.5}});
      kit.polygon("screen", plate,
                  {{-0.2, 0, 0.3}, {-0.2, 0.6, 0.3}, {-0.2, 0.6, 1.5}, {-0.2, 0, 1.5}});
      const Solution s(kit.build(), {.solver = solver,
                                     .element_size = 0.25,
                                     .row_rays = 16,
                                     .gather_rays = 16,
                                     .direct_samples = 256,
                                     .seed = seed});
      return s.sum(first ? "b" : "a", Part::Direct).flux;
    };
    std::vector<double> values;
    for (const Solver solver : {Solver::Rows, Solver::Matrix})
      values.push_back(exchange(solver, true) / exchange(solver, false));
    return values;
  };
  return c;
}

// The same room moved, turned, scaled, cut into other triangles.
Case invariance() {
  Case c = enclosure(
      "room with a table, moved, turned, scaled, cut up",
      "the room as it was made (itself sampled); irradiance of exitance has no scale", 16);
  c.quantities = {{"scaled by 1e-3: mean E of the floor / reference", 1.0},
                  {"scaled by 1e3", 1.0},
                  {"moved by 1e4 m", 1.0},
                  {"turned about (1, 2, 3)", 1.0},
                  {"surfaces in reverse order", 1.0},
                  {"every triangle split in 4", 1.0}};
  c.measure = [](std::uint64_t seed) {
    const auto mean = [&](double scale, const Eigen::Affine3d& motion, bool reverse, bool split) {
      SceneKit kit;
      const auto white = kit.diffuse(0.6);
      kit.room({0, 0, 0}, {3, 2, 2}, {white, white, white, white, white, kit.diffuse(0.6, 1.0)});
      kit.polygon("table", white, {{1, 0.5, 0.7}, {2, 0.5, 0.7}, {2, 1.5, 0.7}, {1, 1.5, 0.7}});
      scene::Model& model = kit.model();
      for (scene::MeshData& mesh : model.meshes) {
        if (split) {
          std::vector<scene::Triangle> fine;
          for (const auto& [a, b, d] : mesh.triangles) {
            const auto middle = [&](std::uint32_t i, std::uint32_t j) {
              mesh.positions.push_back((mesh.positions[i] + mesh.positions[j]) / 2);
              return static_cast<std::uint32_t>(mesh.positions.size() - 1);
            };
            const std::uint32_t ab = middle(a, b), bd = middle(b, d), da = middle(d, a);
            fine.insert(fine.end(), {{a, ab, da}, {ab, b, bd}, {da, bd, d}, {ab, bd, da}});
          }
          mesh.triangles = std::move(fine);
        }
        for (Vec3d& p : mesh.positions) p = motion * (scale * p);
      }
      if (reverse) std::reverse(model.nodes.begin(), model.nodes.end());
      const Solution s(kit.build(),
                       {.element_size = 0.25 * scale, .direct_samples = 64, .seed = seed});
      return s.mean("z0", Part::Total);
    };
    const Eigen::Affine3d still = Eigen::Affine3d::Identity();
    const Eigen::Affine3d moved(Eigen::Translation3d(1e4, -1e4, 1e4));
    const Eigen::Affine3d turned(Eigen::AngleAxisd(1.0, Vec3d(1, 2, 3).normalized()));
    const double base = mean(1.0, still, false, false);
    return std::vector{
        mean(1e-3, still, false, false) / base, mean(1e3, still, false, false) / base,
        mean(1.0, moved, false, false) / base,  mean(1.0, turned, false, false) / base,
        mean(1.0, still, true, false) / base,   mean(1.0, still, false, true) / base};
  };
  return c;
}

}  // namespace

std::vector<Case> enclosure_cases() {
  return {furnace_exact(),
          furnace_sampled(),
          closed_room(),
          goral_cube(Solver::Matrix, "matrix", true),
          goral_cube(Solver::Rows, "rows", false),
          goral_cube(Solver::Shooting, "shooting", true),
          sphere_zones(3, false),
          sphere_zones(5, true),
          sphere_point_source(),
          flux_balance(Solver::Matrix, "matrix", 1e-9, 1),
          flux_balance(Solver::Shooting, "shooting", 1e-4, 1),
          flux_balance(Solver::Rows, "rows", 5e-3, 8),
          reciprocity(),
          invariance()};
}

}  // namespace atrium::validation
