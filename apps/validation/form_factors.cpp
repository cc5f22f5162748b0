#include "radiosity/form_factor.h"

#include <memory>

#include "validation/case.h"
#include "validation/l_room.h"
#include "validation/reference.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using radiosity::Solver;
using Part = Solution::Part;
using Polygon = std::vector<Vec3d>;

constexpr double kAlmostBlack = 1e-6;  // black surfaces have no elements
constexpr double kUnitSquares = 0.199824896;

std::string text(double x) {
  std::string s = std::to_string(x);
  while (s.back() == '0') s.pop_back();
  if (s.back() == '.') s.pop_back();
  return s;
}

Case exact(std::string name, std::string source, std::vector<Quantity> quantities,
           const std::vector<double>& values) {
  for (Quantity& q : quantities) q.kind = Kind::Exact;
  return {"Form factors",
          std::move(name),
          std::move(source),
          std::move(quantities),
          1,
          [values](std::uint64_t) { return values; }};
}

Case parallel_squares() {
  std::vector<Quantity> quantities;
  std::vector<double> values;
  for (const auto& [c, f] : {std::pair{0.1, 0.826994522},
                             {0.5, 0.415253284},
                             {1.0, kUnitSquares},
                             {2.0, 0.068589589},
                             {5.0, 0.012403977},
                             {10.0, 0.003162057}}) {
    const Polygon low{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const Polygon high{{0, 0, c}, {0, 1, c}, {1, 1, c}, {1, 0, c}};
    quantities.push_back({"F at distance " + text(c), f});
    values.push_back(radiosity::polygon_exchange_area(low, high));
  }
  return exact("parallel unit squares", "closed form (Eq. 3), 9 digits", quantities, values);
}

Case perpendicular_rectangles() {
  struct Size {
    double h, w, f;
  };
  std::vector<Quantity> quantities;
  std::vector<double> values;
  for (const Size& s : {Size{1, 1, 0.200043776}, Size{1, 2, 0.116426301}, Size{2, 1, 0.232852603},
                        Size{0.5, 1, 0.146186679}, Size{1, 0.1, 0.432513694}}) {
    const Polygon floor{{0, 0, 0}, {s.w, 0, 0}, {s.w, 1, 0}, {0, 1, 0}};
    const Polygon wall{{0, 0, 0}, {0, 1, 0}, {0, 1, s.h}, {0, 0, s.h}};
    quantities.push_back({"F, H = " + text(s.h) + ", W = " + text(s.w), s.f});
    values.push_back(radiosity::polygon_exchange_area(floor, wall) / s.w);
  }
  return exact("rectangles at a right angle, common edge", "closed form (Eq. 4), 9 digits",
               quantities, values);
}

Case point_to_polygon() {
  const Polygon corner{{0, 0, 0}, {2, 0, 0}, {2, 0.5, 0}, {0, 0.5, 0}};
  const Polygon across{{-3, -0.5, 0}, {2, -0.5, 0}, {2, 0.5, 0}, {-3, 0.5, 0}};
  const Vec3d p(0, 0, 1);
  return exact("point to polygon", "closed forms of a surface element and a rectangle",
               {{"over a corner, parallel", reference::corner_parallel(2, 0.5)},
                {"over a corner, upright", reference::corner_upright(2, 0.5)},
                {"upright, cut by the horizon", 2 * reference::corner_upright(2, 0.5)}},
               {radiosity::point_to_polygon(p, {0, 0, -1}, corner),
                radiosity::point_to_polygon(p, {1, 0, 0}, corner),
                radiosity::point_to_polygon(p, {1, 0, 0}, across)});
}

// ---- scenes that solvers see ----

// Unit squares that face each other at distance 1; `screen` in the plane half-way.
Case screened(const std::string& name, const Polygon& screen, double open_share) {
  Case c{"Form factors",
         "unit squares, " + name,
         "symmetry of reflections: share of the plane left open",
         {},
         8,
         {}};
  for (const char* solver : {"matrix", "rows"})
    c.quantities.push_back(
        {std::string("F, ") + solver, open_share * kUnitSquares, Kind::Global, kUnitSquares});
  c.measure = [screen](std::uint64_t seed) {
    const auto scene = [&] {
      SceneKit kit;
      const auto black = kit.diffuse(kAlmostBlack);
      kit.polygon("lamp", kit.diffuse(kAlmostBlack, 1.0),
                  {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
      kit.polygon("receiver", black, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
      kit.polygon("screen", black, screen);
      return kit.build();
    };
    const Solution matrix(scene(), {.solver = Solver::Matrix, .element_size = 10.0, .seed = seed});
    const Solution rows(scene(), {.element_size = 0.125,
                                  .row_rays = 16,
                                  .gather_rays = 16,
                                  .direct_samples = 256,
                                  .seed = seed});
    return std::vector{matrix.mean("receiver", Part::Direct), rows.mean("receiver", Part::Direct)};
  };
  return c;
}

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0.5}, {x1, y0, 0.5}, {x1, y1, 0.5}, {x0, y1, 0.5}};
}

// The inner sphere emits: all of it reaches the outer one, F12 = 1 and F21 = A1 / A2. The same
// tessellation of both has the same ratio of areas, so there is no error from it.
Case concentric_spheres() {
  Case c{"Form factors",
         "concentric spheres, r1 / r2 = 0.5",
         "F12 = 1, F21 = (r1 / r2)^2",
         {{"F12 = A2 E2 / A1, sphere 1 emits", 1.0},
          {"F21 = E2, sphere 1 emits", 0.25},
          {"F12 = E1, sphere 2 emits", 1.0},
          {"F22 = E2, sphere 2 emits", 0.75}},
         8,
         {}};
  c.measure = [](std::uint64_t seed) {
    const auto solved = [&](bool inner_emits) {
      SceneKit kit;
      const auto lamp = kit.diffuse(kAlmostBlack, 1.0), black = kit.diffuse(kAlmostBlack);
      kit.sphere("inner", {{inner_emits ? lamp : black}}, 1.0, 3, false);
      kit.sphere("outer", {{inner_emits ? black : lamp}}, 2.0, 3, true);
      return std::make_unique<Solution>(kit.build(), radiosity::SolveOptions{.element_size = 0.3,
                                                                             .row_rays = 16,
                                                                             .gather_rays = 16,
                                                                             .direct_samples = 256,
                                                                             .seed = seed});
    };
    const auto one = solved(true), two = solved(false);
    const Solution::Sum outer = one->sum("outer", Part::Direct);
    return std::vector{outer.flux / one->sum("inner", Part::Direct).area, outer.mean(),
                       two->mean("inner", Part::Direct), two->mean("outer", Part::Direct)};
  };
  return c;
}

// One element per surface, as the reference has it; wall 1, then the ceiling emits as a body of
// emissivity 0.9 and all absorb that share of what arrives.
Case l_room_case() {
  static constexpr double kEmissivity = 0.9;
  static constexpr std::size_t kEmitters[] = {0, 6};
  Case c{"Form factors",
         "L-shaped room, Pinney & Bean test 4",
         "point factors clipped at the inner corner, 24 x 24 Gauss points per rectangle; Hottel's "
         "matrix with emissivity 0.9",
         {},
         4,
         {}};
  // Pairs that the inner corner partly hides first; the rest as the largest deviation.
  const std::vector<std::pair<int, int>> shown{{0, 4}, {0, 5}, {0, 0}, {6, 0}, {6, 4}, {6, 7}};
  const std::vector<RoomSurface> room = l_room();
  const auto reference = std::make_shared<Eigen::MatrixXd>(l_room_exchange(kEmissivity));
  for (const auto& [i, j] : shown)
    c.quantities.push_back({"script F, " + room[static_cast<std::size_t>(i)].name + " to " +
                                room[static_cast<std::size_t>(j)].name,
                            (*reference)(i, j), Kind::Global, 0.02});
  c.quantities.push_back(
      {"largest deviation in a row of emitters / largest entry", 0.005, Kind::AtMost});
  c.measure = [room, reference, shown](std::uint64_t seed) {
    Eigen::MatrixXd exchange = *reference;
    for (const std::size_t i : kEmitters) {
      SceneKit kit;
      for (std::size_t j = 0; j < room.size(); ++j) {
        const auto m = kit.diffuse(1.0 - kEmissivity, j == i ? kEmissivity : 0.0);
        std::vector<Vec3d> corners;
        std::vector<scene::Triangle> triangles;
        for (const Polygon& r : room[j].rectangles) {
          const auto first = static_cast<std::uint32_t>(corners.size());
          corners.insert(corners.end(), r.begin(), r.end());
          triangles.push_back({first, first + 1, first + 2});
          triangles.push_back({first, first + 2, first + 3});
        }
        kit.mesh(room[j].name, m, corners, triangles);
      }
      const Solution s(kit.build(),
                       {.solver = Solver::Matrix, .element_size = 100.0, .seed = seed});
      const double area = s.sum(room[i].name, Part::Direct).area;
      for (std::size_t j = 0; j < room.size(); ++j)
        exchange(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            kEmissivity * s.sum(room[j].name, Part::Total).flux / area;
    }
    std::vector<double> values;
    values.reserve(shown.size() + 1);
    for (const auto& [i, j] : shown) values.push_back(exchange(i, j));
    values.push_back((exchange - *reference).cwiseAbs().maxCoeff() / reference->maxCoeff());
    return values;
  };
  return c;
}

}  // namespace

std::vector<Case> form_factor_cases() {
  return {parallel_squares(),
          perpendicular_rectangles(),
          point_to_polygon(),
          concentric_spheres(),
          screened("a quarter screened", rectangle(0, 0, 0.5, 0.5), 0.75),
          screened("half screened", rectangle(0, 0, 1, 0.5), 0.5),
          screened("an eighth screened by a triangle",
                   {{0, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0.5}}, 0.875),
          screened("all screened", rectangle(0, 0, 1, 1), 0.0),
          l_room_case()};
}

}  // namespace atrium::validation
