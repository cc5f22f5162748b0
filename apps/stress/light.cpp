#include <cmath>

#include "stress/setting.h"

namespace atrium::stress {
namespace {

using radiosity::Solver;
using trace::Method;

constexpr const char* kFamily = "Light";

radiosity::SolveOptions solve_options(Solver solver = Solver::Rows) {
  radiosity::SolveOptions o;
  o.solver = solver;
  o.element_size = 0.5;
  o.max_level = 1;
  o.gather_rays = 32;
  o.caustic_photons = 20000;
  return o;
}

trace::RenderOptions picture_options(Method method, int samples) {
  trace::RenderOptions o;
  o.method = method;
  o.width = 24;
  o.height = 16;
  o.samples = samples;
  return o;
}

double field_error(const radiosity::SolveResult& a) {
  return std::hypot(a.error_estimate, a.mesh_error);
}

struct Lit {
  Trial trial;
  trace::RenderResult hybrid, path;
  explicit Lit(double emission) : trial(furnished_room(emission)) {
    trial.solve(solve_options());
    hybrid = trial.picture(picture_options(Method::Hybrid, 16));
    path = trial.picture(picture_options(Method::Path, 64));
  }
};

Sweep emitters(Extent extent) {
  Sweep s{kFamily,
          "radiance of the lamp of a furnished room",
          "1e-20 .. 1e20 W/(sr m2)",
          "the room with 1 W/(sr m2), times that",
          {}};
  for (const double x : extent == Extent::Full
                            ? std::vector{1e-20, 1e-15, 1e-10, 1e-5, 1e5, 1e10, 1e15, 1e20}
                            : std::vector{1e-20, 1e20})
    s.cases.push_back({text(x), [x] {
                         static const Lit reference(1.0);
                         const Lit lit(x);
                         Outcome o = compare(lit.trial, reference.trial, x);
                         o.join(compare(lit.hybrid, reference.hybrid,
                                        std::hypot(field_error(lit.trial.solved()),
                                                   field_error(reference.trial.solved())),
                                        x));
                         o.join(compare(lit.path, reference.path, 0.0, x));
                         return o;
                       }});
  return s;
}

// One lamp next to another that outshines it by forty powers of ten.
Sweep unequal_emitters(Extent) {
  Sweep s{kFamily,
          "two lamps of unlike exitance in a closed room",
          "1 : 1 .. 1 : 1e40",
          "Phi / (1 - rho)",
          {}};
  for (const double x : {1.0, 1e5, 1e10, 1e20})
    s.cases.push_back(
        {text(1 / x) + " and " + text(x), [x] {
           SceneKit kit;
           kit.room({0, 0, 0}, {3, 3, 2}, kit.diffuse(0.5));
           kit.polygon("faint", kit.diffuse(0.5, 1 / x),
                       {{0.5, 1, 1.5}, {0.5, 2, 1.5}, {1, 2, 1.5}, {1, 1, 1.5}});
           kit.polygon("bright", kit.diffuse(0.5, x),
                       {{2, 1, 1.5}, {2, 2, 1.5}, {2.5, 2, 1.5}, {2.5, 1, 1.5}});
           Trial trial({std::move(kit.model()), look_at({0.2, 0.2, 1}, {2, 2, 0.5}, 1.0), 1.0});
           trial.solve(solve_options());
           Outcome o = judge_flux(trial, 0.5 * (x + 1 / x) / 0.5);
           o.not_finite += count_not_finite(trial.picture(picture_options(Method::Hybrid, 8)));
           o.not_finite += count_not_finite(trial.picture(picture_options(Method::Path, 8)));
           return o;
         }});
  return s;
}

// All surfaces emit the same: B = M / (1 - rho), at every point.
Outcome of_furnace(double rho, Solver solver, bool pictures) {
  SceneKit kit;
  kit.room({0, 0, 0}, {4, 3, 2.5}, kit.diffuse(rho, 1.0));
  Trial trial({std::move(kit.model()), look_at({0.2, 0.3, 0.4}, {4, 3, 1}, 1.0), 1.0});
  radiosity::SolveOptions options = solve_options(solver);
  options.max_iterations = 200000;
  if (solver == Solver::Shooting) options.element_size = 2.0;
  trial.solve(options);
  Outcome o = judge_flux(trial, 59.0 / (1 - rho));
  if (solver != Solver::Rows) {  // no sampling: what the iteration leaves, as it states
    o.imbalance = 0.0;
    o.stated = options.tolerance / (1 - rho) + 1e-4;
  }
  if (!pictures) return o;
  const double radiance = 1 / (M_PI * (1 - rho));
  Outcome seen = judge_radiance(trial.picture(picture_options(Method::Hybrid, 16)), radiance);
  seen.stated += o.stated;
  o.join(seen);
  return o;
}

Sweep reflectance(Extent extent) {
  Sweep s{kFamily,
          "reflectance of a closed furnace, rows, shooting, matrix and picture",
          "0.01 .. 0.9999",
          "M / (1 - rho)",
          {}};
  for (const double rho : extent == Extent::Full ? std::vector{0.01, 0.5, 0.9, 0.99, 0.999, 0.9999}
                                                 : std::vector{0.9999}) {
    s.cases.push_back(
        {text(rho) + ", rows", [rho] { return of_furnace(rho, Solver::Rows, true); }});
    s.cases.push_back(
        {text(rho) + ", matrix", [rho] { return of_furnace(rho, Solver::Matrix, false); }});
    // Bounce by bounce: not where light takes ten thousand of them.
    if (rho < 0.9995)
      s.cases.push_back(
          {text(rho) + ", shooting", [rho] { return of_furnace(rho, Solver::Shooting, false); }});
  }
  return s;
}

Sweep reflectance_of_paths(Extent extent) {
  Sweep s{kFamily,
          "reflectance of a closed furnace, path tracer",
          "0.01 .. 0.9999",
          "M / (1 - rho)",
          {}};
  for (const double rho : extent == Extent::Full ? std::vector{0.01, 0.5, 0.9, 0.99, 0.999, 0.9999}
                                                 : std::vector{0.999})
    s.cases.push_back(
        {text(rho), [rho] {
           SceneKit kit;
           kit.room({0, 0, 0}, {4, 3, 2.5}, kit.diffuse(rho, 1.0));
           Trial trial({std::move(kit.model()), look_at({0.2, 0.3, 0.4}, {4, 3, 1}, 1.0), 1.0});
           return judge_radiance(trial.picture(picture_options(Method::Path, 4)),
                                 1 / (M_PI * (1 - rho)));
         }});
  return s;
}

// A floor of 1 m2, seen from the light under a small angle.
Outcome of_floor(SceneKit& kit, double expected) {
  kit.polygon("floor", kit.diffuse(0.5), {{1, -0.5, 0}, {2, -0.5, 0}, {2, 0.5, 0}, {1, 0.5, 0}});
  Trial trial({std::move(kit.model()), look_at({1.5, 0, 2}, {1.5, 0, 0}, 0.5), 1.0});
  radiosity::SolveOptions options = solve_options();
  options.element_size = 0.1;
  options.direct_samples = 64;
  trial.solve(options);
  Outcome o = judge_flux(trial, expected);
  o.stated += trial.solved().mesh_error;
  o.not_finite += count_not_finite(trial.picture(picture_options(Method::Hybrid, 8)));
  o.not_finite += count_not_finite(trial.picture(picture_options(Method::Path, 8)));
  return o;
}

Sweep grazing_sun(Extent extent) {
  Sweep s{kFamily,
          "elevation of a directional light over a floor",
          "1 .. 1e-6 rad",
          "E0 sin(elevation)",
          {}};
  for (const double x : extent == Extent::Full
                            ? std::vector{1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}
                            : std::vector{1e-6})
    s.cases.push_back({text(x), [x] {
                         SceneKit kit;
                         kit.directional_light({std::cos(x), 0, std::sin(x)}, 100.0);
                         return of_floor(kit, 100.0 * std::sin(x));
                       }});
  return s;
}

// Flux of a source at (0, 0, height) over the floor: Simpson's rule, 200 x 200 cells.
double over_floor(const std::function<double(double x, double y)>& irradiance) {
  constexpr int kSteps = 400;
  double sum = 0.0;
  const auto weight = [](int i) { return i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0; };
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j)
      sum += weight(i) * weight(j) * irradiance(1.0 + 1.0 * i / kSteps, -0.5 + 1.0 * j / kSteps);
  return sum / (9.0 * kSteps * kSteps);
}

Sweep grazing_point(Extent extent) {
  Sweep s{kFamily,
          "height of a point light 1 m beside a floor",
          "1 .. 1e-6 m",
          "I h / d^3, integrated",
          {}};
  for (const double h : extent == Extent::Full
                            ? std::vector{1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}
                            : std::vector{1e-6})
    s.cases.push_back({text(h), [h] {
                         SceneKit kit;
                         kit.point_light({0, 0, h}, 10.0);
                         return of_floor(kit, over_floor([h](double x, double y) {
                                           return 10.0 * h / std::pow(x * x + y * y + h * h, 1.5);
                                         }));
                       }});
  return s;
}

// A strip that stands beside the floor, of width 1: to first order in its height h
// E = M h^2 / (2 pi) * integral of x / (x^2 + (y - t)^2)^2 dt, |t| < 1/2, times x.
Sweep grazing_lamp(Extent extent) {
  Sweep s{kFamily,
          "height of a strip light 1 m beside a floor",
          "1e-2 .. 1e-6 m",
          "closed form to first order",
          {}};
  for (const double h :
       extent == Extent::Full ? std::vector{1e-2, 1e-3, 1e-4, 1e-5, 1e-6} : std::vector{1e-6})
    s.cases.push_back({text(h), [h] {
                         SceneKit kit;
                         kit.polygon("strip", kit.diffuse(0.0, 1.0),
                                     {{0, -0.5, 0}, {0, 0.5, 0}, {0, 0.5, h}, {0, -0.5, h}});
                         const auto part = [](double x, double t) {  // of dt / (x^2 + t^2)^2
                           return t / (2 * x * x * (x * x + t * t)) +
                                  std::atan(t / x) / (2 * x * x * x);
                         };
                         const double flux = over_floor([&](double x, double y) {
                           return h * h / (2 * M_PI) * x * (part(x, y + 0.5) - part(x, y - 0.5));
                         });
                         Outcome o = of_floor(kit, flux);
                         o.stated += h * h;  // of the closed form
                         return o;
                       }});
  return s;
}

}  // namespace

std::vector<Sweep> light_sweeps(Extent extent) {
  return {emitters(extent),    unequal_emitters(extent),
          reflectance(extent), reflectance_of_paths(extent),
          grazing_sun(extent), grazing_point(extent),
          grazing_lamp(extent)};
}

}  // namespace atrium::stress
