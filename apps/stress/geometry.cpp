#include <cmath>
#include <memory>

#include "stress/setting.h"

namespace atrium::stress {
namespace {

using radiosity::Solver;
using trace::Method;

constexpr const char* kFamily = "Geometry";

radiosity::SolveOptions solve_options() {
  radiosity::SolveOptions o;
  o.element_size = 0.5;
  o.max_level = 1;
  o.gather_rays = 32;
  o.caustic_photons = 20000;
  return o;
}

trace::RenderOptions picture_options(Method method) {
  trace::RenderOptions o;
  o.method = method;
  o.width = 24;
  o.height = 18;
  o.samples = method == Method::Path ? 64 : 16;
  return o;
}

// The furnished room, where it was made.
struct Reference {
  Trial trial{furnished_room()};
  trace::RenderResult hybrid, path;
  Reference() {
    trial.solve(solve_options());
    hybrid = trial.picture(picture_options(Method::Hybrid));
    path = trial.picture(picture_options(Method::Path));
  }
  static const Reference& get() {
    static const Reference reference;
    return reference;
  }
};

double field_error(const radiosity::SolveResult& a) {
  return std::hypot(a.error_estimate, a.mesh_error);
}

Outcome of_furnished_room(const Eigen::Affine3d& t) {
  const Reference& r = Reference::get();
  Setting setting = furnished_room();
  move(setting, t);
  Trial trial(std::move(setting));
  trial.solve(solve_options());
  Outcome o = compare(trial, r.trial);
  o.join(compare(trial.picture(picture_options(Method::Hybrid)), r.hybrid,
                 std::hypot(field_error(trial.solved()), field_error(r.trial.solved()))));
  o.join(compare(trial.picture(picture_options(Method::Path)), r.path, 0.0));
  return o;
}

Eigen::Affine3d turned() {
  return Eigen::Affine3d(Eigen::AngleAxisd(1.1, Vec3d(0.3, -0.5, 0.8).normalized()));
}

Sweep scale(Extent extent) {
  Sweep s{kFamily, "scale of a furnished room", "1e-4 .. 1e6", "the room at scale 1", {}};
  for (const double x : extent == Extent::Full
                            ? std::vector{1e-4, 1e-3, 1e-2, 0.1, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}
                            : std::vector{1e-4, 1e6})
    s.cases.push_back(
        {text(x), [x] { return of_furnished_room(Eigen::Affine3d(Eigen::Scaling(x))); }});
  return s;
}

Sweep offset(Extent extent) {
  Sweep s{kFamily,
          "offset of a furnished room, turned, by its nodes",
          "0 .. 1e7 m",
          "the room at the origin",
          {}};
  for (const double x :
       extent == Extent::Full ? std::vector{0.0, 1.0, 1e2, 1e4, 1e5, 1e6, 1e7} : std::vector{1e7})
    s.cases.push_back(
        {text(x),
         [x] { return of_furnished_room(Eigen::Translation3d(x, -0.7 * x, 0.1 * x) * turned()); }});
  return s;
}

// A closed room of one reflectance with a lamp that stands in it: flux received in all is
// Phi / (1 - rho), whatever else is in the room.
constexpr double kRho = 0.6, kExitance = 5.0;

Outcome of_closed_room(SceneKit& kit, double lamp_area, const Vec3d& eye,
                       const radiosity::SolveOptions& options) {
  Trial trial({std::move(kit.model()), look_at(eye, eye + Vec3d(1, 0.2, 0.1), 1.0), 1.0});
  trial.solve(options);
  // Sheets in one place are stored as often as they are there, but what they absorb counts once.
  Outcome o = judge_absorbed(trial, kExitance * lamp_area);
  for (const Method method : {Method::Hybrid, Method::Path}) {
    Outcome seen;
    seen.not_finite = count_not_finite(trial.picture(picture_options(method)));
    seen.stated = 1.0;
    o.join(seen);
  }
  return o;
}

Sweep aspect_of_rooms(Extent extent) {
  Sweep s{kFamily, "aspect ratio of a closed room", "1 .. 1e6", "absorbed = emitted flux", {}};
  for (const double x :
       extent == Extent::Full ? std::vector{1.0, 1e2, 1e4, 1e5, 1e6} : std::vector{1e2})
    s.cases.push_back({text(x), [x] {
                         SceneKit kit;
                         kit.room({0, 0, 0}, {x, 1, 1}, kit.diffuse(kRho));
                         kit.polygon("lamp", kit.diffuse(kRho, kExitance),
                                     {{0, 0.2, 0.9}, {0, 0.8, 0.9}, {x, 0.8, 0.9}, {x, 0.2, 0.9}});
                         radiosity::SolveOptions o = solve_options();
                         o.element_size = 0.0;
                         o.max_elements = 2000;
                         return of_closed_room(kit, 0.6 * x, {0.1 * x, 0.5, 0.5}, o);
                       }});
  return s;
}

// The floor is cut into strips.
Sweep aspect_of_triangles(Extent extent) {
  Sweep s{kFamily,
          "aspect ratio of triangles (strips of a floor)",
          "10 .. 1e6",
          "absorbed = emitted flux",
          {}};
  for (const double x :
       extent == Extent::Full ? std::vector{1e1, 1e3, 1e4, 1e5, 1e6} : std::vector{1e6})
    s.cases.push_back({text(x), [x] {
                         SceneKit kit;
                         const auto white = kit.diffuse(kRho);
                         kit.room({0, 0, 0}, {1, 1, 1}, white);
                         std::vector<Vec3d> p;
                         std::vector<scene::Triangle> t;
                         constexpr std::uint32_t kStrips = 200;
                         for (std::uint32_t i = 0; i <= kStrips; ++i) {
                           p.emplace_back(0.2 + i / x, 0.0, 0.3);
                           p.emplace_back(0.2 + i / x, 1.0, 0.3);
                           if (i == kStrips) break;
                           const std::uint32_t k = 2 * i;
                           t.push_back({k, k + 2, k + 3});
                           t.push_back({k, k + 3, k + 1});
                         }
                         kit.mesh("strips", white, std::move(p), std::move(t));
                         kit.polygon(
                             "lamp", kit.diffuse(kRho, kExitance),
                             {{0.2, 0.2, 0.9}, {0.2, 0.8, 0.9}, {0.8, 0.8, 0.9}, {0.8, 0.2, 0.9}});
                         return of_closed_room(kit, 0.36, {0.1, 0.5, 0.5}, solve_options());
                       }});
  return s;
}

// A ball of 2048 triangles.
Sweep size_of_triangles(Extent extent) {
  Sweep s{kFamily,
          "area of triangles (a ball of 2048 in a room)",
          "1e-3 .. 1e-9 m2",
          "absorbed = emitted flux",
          {}};
  for (const double area :
       extent == Extent::Full ? std::vector{1e-3, 1e-5, 1e-7, 1e-8, 1e-9} : std::vector{1e-9})
    s.cases.push_back({text(area), [area] {
                         SceneKit kit;
                         const auto white = kit.diffuse(kRho);
                         kit.room({-2, -2, -2}, {2, 2, 2}, white);
                         const std::vector zones{white};
                         kit.sphere("ball", zones, std::sqrt(2048 * area / (4 * M_PI)), 4, false);
                         kit.polygon("lamp", kit.diffuse(kRho, kExitance),
                                     {{-1, -1, 1.5}, {-1, 1, 1.5}, {1, 1, 1.5}, {1, -1, 1.5}});
                         return of_closed_room(kit, 4.0, {-1.5, 0, 0}, solve_options());
                       }});
  return s;
}

// Sheets that lie in one place, and boxes that stand on one another.
Sweep coplanar_sheets(Extent extent) {
  Sweep s{kFamily, "coplanar sheets on a floor", "1 .. 256", "absorbed = emitted flux", {}};
  for (const int n : extent == Extent::Full ? std::vector{1, 2, 16, 64, 256} : std::vector{64})
    s.cases.push_back(
        {text(n), [n] {
           SceneKit kit;
           const auto white = kit.diffuse(kRho);
           kit.room({0, 0, 0}, {3, 3, 2}, white);
           for (int i = 0; i < n; ++i)
             kit.polygon("sheet", white, {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}});
           kit.polygon("lamp", kit.diffuse(kRho, kExitance),
                       {{1, 1, 1.5}, {1, 2, 1.5}, {2, 2, 1.5}, {2, 1, 1.5}});
           return of_closed_room(kit, 1.0, {0.2, 1.5, 1}, solve_options());
         }});
  return s;
}

Sweep touching_boxes(Extent extent) {
  Sweep s{kFamily, "boxes that touch, in a stack", "1 .. 256", "absorbed = emitted flux", {}};
  for (const int n : extent == Extent::Full ? std::vector{1, 4, 16, 64, 256} : std::vector{64})
    s.cases.push_back({text(n), [n] {
                         SceneKit kit;
                         const auto white = kit.diffuse(kRho);
                         kit.room({0, 0, 0}, {3, 3, 2}, white);
                         for (int i = 0; i < n; ++i) {
                           const double low = 1.0 * i / n, high = 1.0 * (i + 1) / n;
                           kit.block("box", white, {1, 1, low}, {2, 2, high});
                         }
                         kit.polygon("lamp", kit.diffuse(kRho, kExitance),
                                     {{1, 1, 1.5}, {1, 2, 1.5}, {2, 2, 1.5}, {2, 1, 1.5}});
                         return of_closed_room(kit, 1.0, {0.2, 1.5, 1}, solve_options());
                       }});
  return s;
}

}  // namespace

std::vector<Sweep> geometry_sweeps(Extent extent) {
  return {scale(extent),
          offset(extent),
          aspect_of_rooms(extent),
          aspect_of_triangles(extent),
          size_of_triangles(extent),
          coplanar_sheets(extent),
          touching_boxes(extent)};
}

}  // namespace atrium::stress
