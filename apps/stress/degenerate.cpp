#include <cmath>
#include <memory>

#include "material/error.h"
#include "stress/setting.h"

namespace atrium::stress {
namespace {

using trace::Method;

constexpr const char* kFamily = "Degenerate scenes";

radiosity::SolveOptions solve_options(radiosity::Solver solver = radiosity::Solver::Rows) {
  radiosity::SolveOptions o;
  o.solver = solver;
  o.element_size = 0.5;
  o.max_level = 1;
  o.row_rays = 32;
  o.gather_rays = 32;
  o.caustic_photons = 10000;
  return o;
}

// Numbers in solution and pictures by every method, and the balance.
Outcome of_everything(Setting setting) {
  Outcome o;
  o.stated = 1.0;
  const scene::Camera camera = setting.camera;
  Trial trial(std::move(setting));
  for (const auto solver :
       {radiosity::Solver::Matrix, radiosity::Solver::Shooting, radiosity::Solver::Rows}) {
    trial.solve(solve_options(solver));
    o.not_finite += count_not_finite(trial.solved());
    if (solver == radiosity::Solver::Rows) o.imbalance = imbalance(trial.solved().flux);
  }
  for (const Method method : {Method::Hybrid, Method::Path, Method::Direct}) {
    trace::RenderOptions options;
    options.method = method;
    options.width = 12;
    options.height = 9;
    options.samples = 8;
    options.components = true;
    o.not_finite += count_not_finite(trial.picture(options));
  }
  return o;
}

// A scene that has nothing to show is an error that says so.
Outcome refused(SceneKit& kit, const std::string& fragment) {
  Outcome o;
  o.stated = 1.0;
  try {
    (void)scene::build_scene(std::move(kit.model()));
  } catch (const Error& e) {
    o.deviation = std::string(e.what()).find(fragment) == std::string::npos ? 2.0 : 0.0;
    return o;
  }
  o.deviation = 2.0;
  return o;
}

Sweep little(Extent) {
  Sweep s{kFamily,
          "scenes with next to nothing in them",
          "empty .. a closed box",
          "an error, or numbers that balance",
          {}};
  const scene::Camera camera = look_at({0.2, 0.3, 1}, {0.3, 0.3, 0}, 0.8);
  const std::vector<Vec3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto triangle = [corners](SceneKit& kit, scene::MaterialId m) {
    kit.mesh("t", m, corners, {{0, 1, 2}});
  };
  s.cases.push_back({"empty", [] {
                       SceneKit kit;
                       return refused(kit, "no geometry");
                     }});
  s.cases.push_back({"nothing but lights", [] {
                       SceneKit kit;
                       kit.point_light({0, 0, 1}, 10.0);
                       kit.directional_light({0, 0, 1}, 10.0);
                       return refused(kit, "no geometry");
                     }});
  s.cases.push_back(
      {"a triangle without area", [] {
         SceneKit kit;
         kit.mesh("t", kit.diffuse(0.5), {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}});
         return refused(kit, "no geometry");
       }});
  s.cases.push_back({"one triangle, no light", [=] {
                       SceneKit kit;
                       triangle(kit, kit.diffuse(0.5));
                       return of_everything({std::move(kit.model()), camera, 1.0});
                     }});
  s.cases.push_back({"one triangle that shines", [=] {
                       SceneKit kit;
                       triangle(kit, kit.diffuse(0.5, 1.0));
                       return of_everything({std::move(kit.model()), camera, 1.0});
                     }});
  s.cases.push_back({"one lit triangle", [=] {
                       SceneKit kit;
                       triangle(kit, kit.diffuse(0.5));
                       kit.point_light({0.3, 0.3, 1}, 10.0);
                       return of_everything({std::move(kit.model()), camera, 1.0});
                     }});
  s.cases.push_back({"a light on a triangle", [=] {
                       SceneKit kit;
                       triangle(kit, kit.diffuse(0.5));
                       kit.point_light({0.3, 0.3, 0}, 10.0);
                       return of_everything({std::move(kit.model()), camera, 1.0});
                     }});
  s.cases.push_back({"all black", [] {
                       SceneKit kit;
                       kit.room({0, 0, 0}, {1, 1, 1}, kit.diffuse(0.0));
                       kit.polygon(
                           "lamp", kit.diffuse(0.0, 1.0),
                           {{0.4, 0.4, 0.9}, {0.4, 0.6, 0.9}, {0.6, 0.6, 0.9}, {0.6, 0.4, 0.9}});
                       return of_everything({std::move(kit.model()),
                                             look_at({0.1, 0.1, 0.1}, {1, 1, 0.5}, 1.0), 1.0});
                     }});
  s.cases.push_back(
      {"a light in a closed box, seen from outside", [] {
         SceneKit kit;
         kit.room({0, 0, 0}, {1, 1, 1}, kit.diffuse(0.5));
         kit.point_light({0.5, 0.5, 0.5}, 1.0);
         return of_everything({std::move(kit.model()), look_at({3, 3, 3}, {0, 0, 0}, 1.0), 1.0});
       }});
  return s;
}

Sweep cameras(Extent) {
  Sweep s{kFamily,
          "degenerate cameras in a furnished room",
          "yfov 1e-6 .. 3.14, 1e-6 .. 1e6 m high, on surfaces, 1e7 m away",
          "numbers",
          {}};
  const auto room = [] {
    static Trial trial(furnished_room());
    static const radiosity::SolveResult& solved = trial.solve(solve_options());
    (void)solved;
    return &trial;
  };
  const auto add = [&](const std::string& at, const scene::Camera& camera, int width = 12,
                       int height = 9) {
    s.cases.push_back({at, [=] {
                         Outcome o;
                         o.stated = 1.0;
                         scene::Camera c = camera;
                         c.to_scene.translation() -= room()->scene().origin;
                         for (const Method method : {Method::Hybrid, Method::Path}) {
                           trace::RenderOptions options;
                           options.method = method;
                           options.width = width;
                           options.height = height;
                           options.samples = 8;
                           o.not_finite += count_not_finite(room()->picture(c, options));
                         }
                         return o;
                       }});
  };
  const Vec3d eye(3.7, 2.7, 1.5), target(1.3, 1.0, 0.8);
  add("yfov 1e-6", look_at(eye, target, 1e-6));
  add("yfov 3.14159", look_at(eye, target, 3.14159));
  add("on the floor", look_at({1, 2, 0}, {2, 2.5, 0}, 1.0));
  add("in a wall", look_at({0, 1, 1}, {0, 2, 1}, 1.0));
  add("in a corner", look_at({0, 0, 0}, {1, 1, 1}, 1.0));
  add("in the glass", look_at({1.8, 0.8, 0.2}, {3, 2, 1}, 1.0));
  add("1e7 m away", look_at({1e7, 1e7, 1e7}, {2, 1, 1}, 1e-6));
  add("straight up", look_at({1, 2, 1}, {1, 2, 2}, 1.0));
  add("of one pixel", look_at(eye, target, 1.0), 1, 1);
  add("2048 x 1", look_at(eye, target, 1.0), 2048, 1);
  add("1 x 2048", look_at(eye, target, 1.0), 1, 2048);
  scene::Camera parallel = look_at(eye, target, 1.0);
  parallel.kind = scene::Camera::Kind::Orthographic;
  for (const double height : {1e-6, 1e6}) {
    parallel.height = height;
    add("parallel, " + text(height) + " m high", parallel);
  }
  scene::Camera panorama = look_at(eye, target, 1.0);
  panorama.kind = scene::Camera::Kind::Panorama;
  add("panorama", panorama);
  return s;
}

}  // namespace

std::vector<Sweep> degenerate_sweeps(Extent extent) { return {little(extent), cameras(extent)}; }

}  // namespace atrium::stress
