#include "validation/convergence.h"

#include <cmath>

#include "validation/case.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using radiosity::SolveOptions;
using radiosity::Solver;
using Part = Solution::Part;

scene::Scene room(double reflectance) {
  SceneKit kit;
  const auto white = kit.diffuse(reflectance);
  kit.room({0, 0, 0}, {3, 3, 2}, white);
  kit.polygon("table", white, {{1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {1, 2, 0.7}});
  kit.point_light({1.2, 1.7, 1.6}, 10.0);
  return kit.build();
}

std::vector<double> irradiance(const Solution& s, Part part) {
  std::vector<double> e;
  for (std::size_t k = 0; k < s.element_count(); ++k) e.push_back(s.irradiance(k, part));
  return e;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& reference) {
  double squares = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squares += (a[k] - reference[k]) * (a[k] - reference[k]);
    sum += reference[k];
  }
  const auto n = static_cast<double>(a.size());
  return std::sqrt(squares / n) / (sum / n);
}

Case convergence(std::string name, std::string source, std::vector<Quantity> quantities,
                 std::function<std::vector<double>()> measure) {
  return {"Convergence",
          std::move(name),
          std::move(source),
          std::move(quantities),
          1,
          [measure = std::move(measure)](std::uint64_t) { return measure(); }};
}

/// Largest error / bound^x of a curve.
double above_geometric(const ErrorCurve& c, double ratio) {
  double most = 0.0;
  for (std::size_t k = 0; k < c.x.size(); ++k)
    most = std::max(most, c.error[k] / std::pow(ratio, c.x[k]));
  return most;
}

}  // namespace

double order(const ErrorCurve& c) {
  const auto n = static_cast<double>(c.x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < c.x.size(); ++k) {
    const double x = std::log(c.x[k]), y = std::log(c.error[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

ErrorCurve rows_against_rays() {
  constexpr int kSeeds = 4;
  static constexpr int kMost = 512;
  const auto solved = [](int rays, std::uint64_t seed) {
    const Solution s(room(0.6), {.element_size = 0.5,
                                 .max_level = 0,
                                 .row_rays = std::min(rays / 2, kMost),
                                 .gather_rays = rays - std::min(rays / 2, kMost),
                                 .direct_samples = 1024,
                                 .seed = seed});
    return irradiance(s, Part::Indirect);
  };
  const std::vector<double> reference = solved(32 * kMost, 99);
  ErrorCurve curve{"rows", {}, {}};
  for (int rays = 32; rays <= kMost; rays *= 2) {
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
      squares += std::pow(rms_difference(solved(rays, seed), reference), 2) / kSeeds;
    curve.x.push_back(rays);
    curve.error.push_back(std::sqrt(squares));
  }
  return curve;
}

ErrorCurve rows_against_iterations() {
  const auto solved = [](int iterations) {
    const Solution s(room(kIterationReflectance),
                     {.element_size = 0.5, .max_iterations = iterations, .tolerance = 1e-9});
    return irradiance(s, Part::Total);
  };
  const std::vector<double> reference = solved(1000);
  ErrorCurve curve{"rows", {}, {}};
  for (int iterations = 1; iterations <= 16; iterations *= 2) {
    const std::vector<double> e = solved(iterations);
    double worst = 0.0;
    for (std::size_t k = 0; k < e.size(); ++k)
      worst = std::max(worst, std::abs(e[k] - reference[k]) / reference[k]);
    curve.x.push_back(iterations);
    curve.error.push_back(worst);
  }
  return curve;
}

ErrorCurve shooting_against_iterations() {
  ErrorCurve curve{"shooting", {}, {}};
  for (int iterations = 1; iterations <= 16; iterations *= 2) {
    const Solution s(room(kIterationReflectance), {.solver = Solver::Shooting,
                                                   .element_size = 1.0,
                                                   .max_iterations = iterations,
                                                   .tolerance = 1e-9});
    curve.x.push_back(iterations);
    curve.error.push_back(s.result().residual);
  }
  return curve;
}

std::vector<Figure> figures() {
  const SizeCurves size = manufactured_against_size();
  return {{"convergence-rays.svg",
           "Indirect irradiance, fixed mesh",
           "rays per element",
           "RMS error, relative to the mean",
           {rows_against_rays()}},
          {"convergence-iterations.svg",
           "Closed room, reflectance 0.7",
           "iterations",
           "largest error; shooting: unshot share",
           {rows_against_iterations(), shooting_against_iterations()},
           false},
          {"convergence-size.svg",
           "Manufactured solution, unit cube",
           "element size [m]",
           "RMS error of irradiance [W/m2]",
           {size.constant, size.interpolated}}};
}

std::vector<Case> convergence_cases() {
  return {convergence("error against rays, rows", "random samples have the slope -0.5",
                      {{"slope", -0.5, Kind::AtMost}},
                      [] { return std::vector{order(rows_against_rays())}; }),
          convergence("error against iterations, reflectance 0.7",
                      "an iteration leaves at most the share rho of the error",
                      {{"rows: largest error / rho^iterations", 1.0, Kind::AtMost},
                       {"shooting: largest unshot share / rho^iterations", 1.0, Kind::AtMost}},
                      [] {
                        return std::vector{
                            above_geometric(rows_against_iterations(), kIterationReflectance),
                            above_geometric(shooting_against_iterations(), kIterationReflectance)};
                      }),
          convergence("error against element size, manufactured solution",
                      "order of approximation of constants, and of bilinear interpolation",
                      {{"order, constant", 1.0, Kind::Point, 0.0, 0.1},
                       {"minus the order, interpolated", -1.5, Kind::AtMost}},
                      [] {
                        const SizeCurves c = manufactured_against_size();
                        return std::vector{order(c.constant), -order(c.interpolated)};
                      })};
}

}  // namespace atrium::validation
