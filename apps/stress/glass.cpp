#include <cmath>
#include <memory>

#include "stress/setting.h"

namespace atrium::stress {
namespace {

using material::Material;
using trace::Method;

constexpr const char* kFamily = "Mirrors and glass";

trace::RenderOptions picture_options(Method method, int samples) {
  trace::RenderOptions o;
  o.method = method;
  o.width = 12;
  o.height = 12;
  o.samples = samples;
  return o;
}

// Looks along +x at right angles, at a square of 2 m round the axis.
scene::Camera straight_camera(double x) {
  scene::Camera camera = look_at({x, 0, 0}, {x + 1, 0, 0}, 1.0);
  camera.kind = scene::Camera::Kind::Orthographic;
  camera.height = 1.0;
  return camera;
}

void square(SceneKit& kit, const std::string& name, scene::MaterialId material, double x,
            double towards) {
  const double s = towards;
  kit.polygon(name, material, {{x, -2 * s, -2}, {x, 2 * s, -2}, {x, 2 * s, 2}, {x, -2 * s, 2}});
}

// Pictures of what the camera sees, with neither diffuse surfaces nor a field: both integrators.
Outcome of_pictures(SceneKit& kit, double camera_x, double expected, int samples) {
  scene::BuildOptions build;
  build.pane_detection = false;
  const Trial trial({std::move(kit.model()), straight_camera(camera_x), 1.0}, build);
  Outcome o = judge_radiance(trial.picture(picture_options(Method::Direct, samples)), expected);
  o.join(judge_radiance(trial.picture(picture_options(Method::Path, samples)), expected));
  return o;
}

Sweep panes(Extent extent) {
  Sweep s{kFamily, "panes before a lamp, each passes 0.999", "1 .. 4096", "0.999^n", {}};
  for (const int n :
       extent == Extent::Full ? std::vector{1, 16, 60, 70, 256, 1024, 4096} : std::vector{256})
    s.cases.push_back({text(n), [n] {
                         SceneKit kit;
                         const auto pane = kit.pane(1.0, 0.999);
                         for (int i = 0; i < n; ++i) square(kit, "pane", pane, 1e-3 * (i + 1), -1);
                         square(kit, "lamp", kit.diffuse(0.0, M_PI), 1e-3 * (n + 1), -1);
                         return of_pictures(kit, 0.0, std::pow(0.999, n), 16);
                       }});
  return s;
}

// Incoherent: T = t / (t + n r) with r and t of one pane; of two faces r = 2 R / (1 + R).
Sweep reflecting_panes(Extent extent) {
  Sweep s{kFamily, "panes of clear glass before a lamp", "1 .. 256", "t / (t + n r)", {}};
  for (const int n : extent == Extent::Full ? std::vector{1, 4, 16, 64, 256} : std::vector{16})
    s.cases.push_back({text(n), [n] {
                         SceneKit kit;
                         const auto pane = kit.pane(1.5, 1.0);
                         for (int i = 0; i < n; ++i) square(kit, "pane", pane, 1e-3 * (i + 1), -1);
                         square(kit, "lamp", kit.diffuse(0.0, M_PI), 1e-3 * (n + 1), -1);
                         const double r = 2 * 0.04 / 1.04;
                         return of_pictures(kit, 0.0, (1 - r) / (1 - r + n * r), 32);
                       }});
  return s;
}

// The lamp's light on a wall behind panes, and nothing else.
Sweep panes_before_walls(Extent extent) {
  Sweep s{kFamily,
          "panes between a lamp and a wall, radiosity",
          "1 .. 1024",
          "0.999^n of the wall without",
          {}};
  const auto solved = [](int n) {
    SceneKit kit;
    const auto pane = kit.pane(1.0, 0.999);
    const auto black = kit.diffuse(0.0);
    kit.room({0, -1, -1}, {1, 1, 1},
             {kit.diffuse(0.0, 1.0), kit.diffuse(0.5), black, black, black, black});
    for (int i = 0; i < n; ++i) {
      const double x = 0.4 + 0.2 * (i + 1) / (n + 1);
      kit.polygon("pane", pane, {{x, -1, -1}, {x, 1, -1}, {x, 1, 1}, {x, -1, 1}});
    }
    auto trial =
        std::make_unique<Trial>(Setting{std::move(kit.model()), straight_camera(0.1), 1.0});
    radiosity::SolveOptions o;
    o.element_size = 1.0;
    o.max_level = 0;
    o.row_rays = 16;
    o.gather_rays = 16;
    o.direct_samples = 64;
    o.caustic_photons = 500;
    trial->solve(o);
    return trial;
  };
  for (const int n : extent == Extent::Full ? std::vector{1, 64, 256, 1024} : std::vector{64})
    s.cases.push_back({text(n), [n, solved] {
                         const auto clear = solved(0), glazed = solved(n);
                         return compare(*glazed, *clear, std::pow(0.999, n));
                       }});
  return s;
}

// Two mirrors that face each other and shine: L (1 + R + R^2 ...).
Sweep hall_of_mirrors(Extent extent) {
  Sweep s{kFamily,
          "reflectance of two shining mirrors that face each other, camera between",
          "0.5 .. 0.9999",
          "L / (1 - R)",
          {}};
  for (const double reflectance :
       extent == Extent::Full ? std::vector{0.5, 0.9, 0.99, 0.999, 0.9999} : std::vector{0.999})
    s.cases.push_back({text(reflectance), [reflectance] {
                         SceneKit kit;
                         Material m;
                         m.k_df = 0.0;
                         m.k_rg = 1.0;
                         m.n = 1.0;  // R = k^2 / (4 + k^2)
                         m.kappa = std::sqrt(4 * reflectance / (1 - reflectance));
                         m.fresnel_error = 0.0;
                         m.emission = 1.0;
                         const auto mirror = kit.material(m);
                         square(kit, "left", mirror, -1.0, 1);
                         square(kit, "right", mirror, 1.0, -1);
                         return of_pictures(kit, 0.0, 1 / (1 - reflectance), 16);
                       }});
  return s;
}

// Plates at the ends of a duct of perfect mirrors: B1 = (M1 + rho1 M2) / (1 - rho1 rho2).
Sweep mirror_duct(Extent extent) {
  Sweep s{kFamily,
          "length of a duct of perfect mirrors, in widths",
          "1 .. 1000",
          "infinite plates: (M1 + rho1 M2) / (1 - rho1 rho2)",
          {}};
  for (const double length :
       extent == Extent::Full ? std::vector{1.0, 10.0, 100.0, 1000.0} : std::vector{100.0})
    s.cases.push_back(
        {text(length), [length] {
           SceneKit kit;
           const auto mirror = kit.perfect_mirror();
           const double rho = 0.5;
           kit.room({0, 0, 0}, {length, 1, 1},
                    {kit.diffuse(rho, 1.0), kit.diffuse(rho), mirror, mirror, mirror, mirror});
           Trial trial(
               {std::move(kit.model()), look_at({0.5, 0.5, 0.5}, {length, 0.6, 0.4}, 1.0), 1.0});
           radiosity::SolveOptions o;
           o.element_size = 0.25;
           o.max_level = 0;
           o.row_rays = 16;
           o.gather_rays = 64;
           o.caustic_photons = 4000;
           trial.solve(o);
           // E1 = rho B2', E2 = B1: B1 = 1 + rho E1, B2 = rho E2, E1 = B2.
           const double b1 = 1 / (1 - rho * rho);
           return judge_flux(trial, b1 + rho * b1);
         }});
  return s;
}

// Slabs of clear glass as solids: 2 n interfaces of R = 0.04 each, T = (1 - R) / (1 - R + 2 n R).
Sweep slabs(Extent extent) {
  Sweep s{kFamily,
          "slabs of clear glass (solids) before a lamp",
          "1 .. 256",
          "(1 - R) / (1 - R + 2 n R)",
          {}};
  for (const int n : extent == Extent::Full ? std::vector{1, 4, 16, 64, 256} : std::vector{32})
    s.cases.push_back({text(n), [n] {
                         SceneKit kit;
                         Material m;
                         m.medium = Material::Medium::Solid;
                         m.k_df = 0.0;
                         m.k_rg = m.k_tp_rg = 1.0;
                         m.fresnel_error = 0.0;
                         const auto glass = kit.material(m);
                         for (int i = 0; i < n; ++i) {
                           const double x = 0.01 * (i + 1);
                           kit.block("slab", glass, {x, -2, -2}, {x + 0.005, 2, 2});
                         }
                         square(kit, "lamp", kit.diffuse(0.0, M_PI), 0.01 * (n + 1), -1);
                         return of_pictures(kit, 0.0, 0.96 / (0.96 + 2 * n * 0.04), 32);
                       }});
  return s;
}

// Boxes of index 1 one in another, of which the k-th of n absorbs K = k: exp(-sum of K d).
Sweep nested(Extent extent) {
  Sweep s{kFamily, "absorbing bodies one in another, pictures", "1 .. 32", "exp(-sum K d)", {}};
  for (const int n : extent == Extent::Full ? std::vector{1, 2, 4, 8, 32} : std::vector{8})
    s.cases.push_back({text(n), [n] {
                         SceneKit kit;
                         double depth = 0.0;
                         for (int i = 1; i <= n; ++i) {
                           Material m;
                           m.medium = Material::Medium::Solid;
                           m.k_df = 0.0;
                           m.k_rg = m.k_tp_rg = 1.0;
                           m.n = 1.0;
                           m.extinction = static_cast<double>(i) / n;
                           const double half = 1.0 - 0.9 * (i - 1) / n,
                                        inner = i == n ? 0.0 : 1.0 - 0.9 * i / n;
                           depth += 2 * (half - inner) * i / n;
                           kit.block("body", kit.material(m), {-half, -1 - half, -1 - half},
                                     {half, 1 + half, 1 + half});
                         }
                         square(kit, "lamp", kit.diffuse(0.0, M_PI), 1.5, -1);
                         return of_pictures(kit, -1.5, std::exp(-depth), 64);
                       }});
  return s;
}

}  // namespace

std::vector<Sweep> glass_sweeps(Extent extent) {
  return {panes(extent),           reflecting_panes(extent), panes_before_walls(extent),
          hall_of_mirrors(extent), mirror_duct(extent),      slabs(extent),
          nested(extent)};
}

}  // namespace atrium::stress
