// CIE 171:2006 sections 5.9 to 5.14: daylight through openings of a black room 4 x 4 x 3 m under
// the CIE standard general skies, sun 60 degrees high in the south, without its direct light.
// Geometry and points from the report, references by quadrature of the sky's formula over the part
// of the opening that shows it: some printed tables are wrong (type 3 of 5.9; 1 m mask of 5.13;
// 6 and 9 m masks of 5.14). y runs to the south here, so that the sun stands over +y.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "radiosity/measure.h"
#include "validation/case.h"
#include "validation/reference.h"
#include "validation/scene_kit.h"
#include "validation/sky_reference.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

using radiosity::Sensor;
using reference::Opening;
using reference::Sky;

constexpr double kPi = std::numbers::pi;
constexpr double kGround = 0.3;      ///< reflectance; its luminance is uniform, as in the report
constexpr double kHorizontal = 1e4;  ///< illuminance from the sky [lx]
constexpr double kIndex = 1.52;
constexpr int kClear = 12;  ///< the type whose points are listed

struct Room {
  std::string name;
  Opening opening;
  bool roof = false, glazed = false;
};

Room roof(double side) {
  const double low = 2 - side / 2;
  return {"roof, " + std::string(side > 2 ? "4 x 4 m" : "1 x 1 m"),
          {{low, low, 3}, {side, 0, 0}, {0, side, 0}},
          true};
}
Room facade(bool whole) {
  if (whole) return {"facade, 4 x 3 m", {{0, 4, 0}, {4, 0, 0}, {0, 0, 3}}};
  return {"facade, 2 x 1 m", {{1, 4, 1}, {2, 0, 0}, {0, 0, 1}}};
}

/// What of a rectangle lies around an opening in it, both along the same axes.
void frame(SceneKit& kit, scene::MaterialId material, const Opening& wall, const Opening& hole) {
  const Vec3d s = wall.u.normalized(), t = wall.v.normalized();
  const double width = wall.u.norm(), height = wall.v.norm();
  const double s0 = (hole.corner - wall.corner).dot(s), s1 = s0 + hole.u.norm();
  const double t0 = (hole.corner - wall.corner).dot(t), t1 = t0 + hole.v.norm();
  const auto part = [&](double a, double b, double c, double d) {
    if (!(b > a && d > c)) return;
    const auto at = [&](double x, double y) { return Vec3d(wall.corner + x * s + y * t); };
    kit.polygon("frame", material, {at(a, c), at(b, c), at(b, d), at(a, d)});
  };
  part(0, width, 0, t0);
  part(0, width, t1, height);
  part(0, s0, t0, t1);
  part(s1, width, t0, t1);
}

void build_room(SceneKit& kit, const Room& room, scene::MaterialId floor) {
  const auto black = kit.diffuse(0.0);
  kit.polygon("floor", floor, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  kit.polygon("back", black, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  kit.polygon("west", black, {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  kit.polygon("east", black, {{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  const Opening none{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const Opening ceiling{{0, 0, 3}, {4, 0, 0}, {0, 4, 0}}, front{{0, 4, 0}, {4, 0, 0}, {0, 0, 3}};
  frame(kit, black, ceiling, room.roof ? room.opening : Opening{ceiling.corner, none.u, none.v});
  frame(kit, black, front, room.roof ? Opening{front.corner, none.u, none.v} : room.opening);
  const auto& [o, u, v] = room.opening;
  const std::vector<Vec3d> corners{o, o + u, o + u + v, o + v};
  if (room.glazed) kit.polygon("pane", kit.pane(kIndex, 1.0), corners);
}

/// The library's sky, in its frame: y up, x east, z south.
void add_sky(SceneKit& kit, int type) {
  scene::Environment sky;
  sky.radiance = kHorizontal;
  sky.pattern = scene::SkyDome(scene::cie_sky(type), {0, std::sqrt(0.75), 0.5}, kGround);
  sky.to_scene.linear() << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  kit.model().environment = sky;
}

struct Point {
  std::string name;
  Sensor sensor;
};
std::string number(double x) {
  char s[32];
  std::snprintf(s, sizeof s, "%g", x);
  return s;
}
constexpr std::array kAlong{0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75};

std::vector<Point> points_of(const Room& room) {
  std::vector<Point> points;
  for (const double z : {2.75, 2.25, 1.75, 1.25, 0.75, 0.25})
    points.push_back({"wall, z = " + number(z), {{2, 0, z}, {0, 1, 0}}});
  for (const double y : kAlong)
    points.push_back({"floor, y = " + number(y), {{2, y, 0}, {0, 0, 1}}});
  for (const double y : kAlong)
    if (!room.roof) points.push_back({"ceiling, y = " + number(y), {{2, y, 3}, {0, 0, -1}}});
  return points;
}

double glazing(const Room& room, const Vec3d& w) {
  if (!room.glazed) return 1.0;
  return reference::pane_transmittance(kIndex, std::abs(room.roof ? w.z() : w.y()));
}

/// Where the opening shows the horizon, in its second coordinate.
std::vector<double> horizon(const Room& room, const Vec3d& p) {
  if (room.roof) return {};
  const double t = (p.z() - room.opening.corner.z()) / room.opening.v.z();
  return t > 0 && t < 1 ? std::vector{t} : std::vector<double>{};
}

double expected(const Room& room, const Sky& sky, const Sensor& s) {
  return 100 * reference::through_opening(
                   s.position, s.normal, room.opening,
                   [&](const Vec3d& w) { return sky.luminance(w) * glazing(room, w); },
                   horizon(room, s.position));
}

Case cie(std::string name, std::string source, int replicates) {
  return {"CIE 171:2006", std::move(name), std::move(source), {}, replicates, {}};
}

/// Share of the horizontal illuminance at points, in %.
std::vector<double> shares(const scene::RayQuery& query, const scene::SurfaceField& field,
                           const std::vector<Point>& points,
                           const radiosity::MeasureOptions& options) {
  std::vector<Sensor> sensors;
  sensors.reserve(points.size());
  for (const Point& p : points) sensors.push_back(p.sensor);
  const radiosity::MeasureResult result =
      radiosity::measure(query, material::SpectralBasis::grey(), field, sensors, options);
  std::vector<double> values;
  for (const radiosity::Reading& r : result.readings)
    values.push_back(100 * r.total.y / kHorizontal);
  return values;
}

// All points under the clear sky; the mean over the points under every sky, and the largest
// deviation at any point, which a single bad one would show.
Case opening_case(const std::string& section, const Room& room, const std::vector<int>& types) {
  Case c =
      cie(section + " " + room.name + (room.glazed ? ", clear glass" : ", unglazed"),
          std::string("E / E_hz in %: quadrature of the sky") +
              (room.roof ? "" : " and of ground of uniform luminance") +
              (room.glazed ? ", times the slab's transmittance (5.5)," : "") + " over the opening",
          4);
  const std::vector<Point> points = points_of(room);
  const auto mean_of = [](const std::vector<double>& list) {
    double sum = 0.0;
    for (const double x : list) sum += x / static_cast<double>(list.size());
    return sum;
  };
  std::vector<Quantity> means;
  std::vector<std::vector<double>> references;
  for (const int type : types) {
    const Sky sky(type, kGround);
    auto& list = references.emplace_back();
    for (const Point& p : points) {
      list.push_back(expected(room, sky, p.sensor));
      if (type == kClear) c.quantities.push_back({"sky 12, " + p.name, list.back(), Kind::Point});
    }
    means.push_back({"sky " + std::to_string(type) + ", mean over the points", mean_of(list)});
  }
  c.quantities.insert(c.quantities.end(), means.begin(), means.end());
  c.quantities.push_back({"largest error of a reading, all skies", 0.05, Kind::AtMost});
  c.measure = [room, types, points, references, mean_of](std::uint64_t seed) {
    // Behind small openings measure() would spend more rays than this needs.
    const radiosity::MeasureOptions fine{.error = 0.005, .max_rays = 1U << 15, .seed = seed};
    const radiosity::MeasureOptions coarse{.error = 0.01, .max_rays = 1U << 13, .seed = seed};
    std::vector<double> at_points, values;
    double worst = 0.0;
    for (std::size_t k = 0; k < types.size(); ++k) {
      SceneKit kit(scene::RadianceUnit::Nit);
      build_room(kit, room, kit.diffuse(0.0));
      add_sky(kit, types[k]);
      const scene::Scene scene = kit.build();
      const bool listed = types[k] == kClear;
      const std::vector<double> e =
          shares(scene::RayQuery(scene), {}, points, listed ? fine : coarse);
      for (std::size_t i = 0; i < e.size(); ++i)
        worst = std::max(worst, std::abs(e[i] / references[k][i] - 1));
      if (listed) at_points = e;
      values.push_back(mean_of(e));
    }
    at_points.insert(at_points.end(), values.begin(), values.end());
    at_points.push_back(worst);
    return at_points;
  };
  return c;
}

// The solver's own direct light of the sky: mean over the floor.
Case floor_case() {
  Case c = cie("5.9, 5.11 mean over the floor, solver", "quadrature over opening and floor", 4);
  const std::vector<Room> rooms{roof(1), roof(4), facade(false)};
  const std::vector<int> types{5, kClear, 16};
  for (const Room& room : rooms)
    for (const int type : types) {
      const Sky sky(type, kGround);
      const double mean = reference::integral(0, 4, 2, [&](double y) {
        return reference::integral(0, 4, 2, [&](double x) {
          return expected(room, sky, {{x, y, 0}, {0, 0, 1}}) / 16;
        });
      });
      c.quantities.push_back({room.name + ", sky " + std::to_string(type), mean});
    }
  c.measure = [rooms, types](std::uint64_t seed) {
    std::vector<double> values;
    for (const Room& room : rooms)
      for (const int type : types) {
        SceneKit kit(scene::RadianceUnit::Nit);
        build_room(kit, room, kit.diffuse(1e-6));  // black surfaces have no elements
        add_sky(kit, type);
        const Solution s(kit.build(), {.element_size = 0.5, .direct_samples = 128, .seed = seed});
        values.push_back(100 * s.mean("floor", Solution::Part::Direct) / kHorizontal);
      }
    return values;
  };
  return c;
}

// ---- masks ----

constexpr double kMask = 0.3;   ///< reflectance; the report does not give one
constexpr double kFar = 500.0;  ///< half the length of a "continuous" black facade

/// A mask outside, its reference luminance and where it begins in the opening.
struct Mask {
  bool horizontal;
  double size;
};

/// E of the underside at depth d: ground of uniform luminance, half hidden by the facade below.
double underside(double d) { return kGround * 0.5 * (1 + d / std::hypot(d, 3.0)); }

/// E of the north side at height z, from 0 to the mask's height in equal steps: sky over a long
/// black building (y 0 to 4, z up to 3), ground before and behind it. In the plane across it
/// everything is a matter of the profile angle alpha; beta is the angle from that plane.
std::vector<double> north_side(const Sky& sky, double height, int steps) {
  std::vector<double> table;
  for (int i = 0; i <= steps; ++i) {
    const double z = height * i / steps;
    const auto between = [&](double from, double to) {
      if (!(to > from)) return 0.0;
      return reference::integral(from, to, 8, [&](double alpha) {
        return reference::integral(-kPi / 2, kPi / 2, 8, [&](double beta) {
          const double c = std::cos(beta);
          const Vec3d w(std::sin(beta), -c * std::cos(alpha), c * std::sin(alpha));
          return sky.luminance(w) * c * c * std::cos(alpha);
        });
      });
    };
    const double below = std::atan(-z / 6);  // foot of the facade, nearer ground under it
    const double above = std::max(std::atan((3 - z) / 6), std::atan((3 - z) / 10));
    const double level = std::max(0.0, above);
    table.push_back(between(-kPi / 2, below) + between(above, level) + between(level, kPi / 2));
  }
  return table;
}

double mask_case_expected(const Mask& mask, const Sky& sky, const std::vector<double>& north,
                          double y) {
  const Opening opening = facade(false).opening;
  const double edge = mask.horizontal ? 3 * (4 - y) / (4 + mask.size - y)
                                      : mask.size * (4 - y) / (10 - y);  // height in the opening
  const auto seen = [&](const Vec3d& w) {
    const double slope = w.z() / w.y(), height = slope * (4 - y);
    if (mask.horizontal)
      return height > edge ? kMask / kPi * underside(3 / slope + y - 4) : sky.luminance(w);
    if (height > edge) return sky.luminance(w);
    const double at = slope * (10 - y) / mask.size * static_cast<double>(north.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(at), north.size() - 2);
    const double t = at - static_cast<double>(k);
    return kMask / kPi * ((1 - t) * north[k] + t * north[k + 1]);
  };
  std::vector<double> breaks;
  if (edge > 1 && edge < 2) breaks.push_back(edge - 1);
  return 100 * reference::through_opening({2, y, 0}, {0, 0, 1}, opening, seen, std::move(breaks));
}

void build_mask(SceneKit& kit, const Mask& mask) {
  const auto black = kit.diffuse(0.0), grey = kit.diffuse(kMask);
  const auto facing_out = [&](double z0, double z1, double x0, double x1) {
    kit.polygon("facade", black, {{x1, 4, z0}, {x0, 4, z0}, {x0, 4, z1}, {x1, 4, z1}});
  };
  facing_out(0, 3, -kFar, 0);
  facing_out(0, 3, 4, kFar);
  // Long enough for every ray from the points through the opening.
  if (mask.horizontal) {
    kit.polygon("mask", grey,
                {{-2, 4, 3}, {-2, 4 + mask.size, 3}, {6, 4 + mask.size, 3}, {6, 4, 3}});
    return;
  }
  kit.polygon("roof", black, {{-kFar, 0, 3}, {0, 0, 3}, {0, 4, 3}, {-kFar, 4, 3}});
  kit.polygon("roof", black, {{4, 0, 3}, {kFar, 0, 3}, {kFar, 4, 3}, {4, 4, 3}});
  kit.polygon("mask", grey, {{-8, 10, 0}, {12, 10, 0}, {12, 10, mask.size}, {-8, 10, mask.size}});
}

// The mask reflects: its light comes from a solution.
Case mask_case(const Mask& mask) {
  const std::string size = number(mask.size);
  Case c =
      cie(mask.horizontal ? "5.13 facade, 2 x 1 m, horizontal mask of " + size + " m at z = 3"
                          : "5.14 facade, 2 x 1 m, vertical mask of " + size + " m, 6 m away",
          "E / E_hz in %: quadrature of sky and mask (rho 0.3) over the opening; the mask's E " +
              std::string(mask.horizontal ? "from the ground in closed form"
                                          : "by quadrature of sky and ground over a long building"),
          4);
  const std::vector<int> types{5, kClear, 16};
  std::vector<Point> points;
  points.reserve(std::size(kAlong));
  for (const double y : kAlong) points.push_back({"y = " + number(y), {{2, y, 0}, {0, 0, 1}}});
  for (const int type : types) {
    const Sky sky(type, kGround);
    const std::vector<double> north =
        mask.horizontal ? std::vector<double>{} : north_side(sky, mask.size, 60);
    std::vector<double> references;
    references.reserve(points.size());
    for (const Point& p : points)
      references.push_back(mask_case_expected(mask, sky, north, p.sensor.position.y()));
    // Errors of dark points count against a tenth of the brightest, as in 5.7.
    const double scale = 0.1 * *std::max_element(references.begin(), references.end());
    for (std::size_t i = 0; i < points.size(); ++i)
      c.quantities.push_back({"sky " + std::to_string(type) + ", floor, " + points[i].name,
                              references[i], Kind::Point, scale});
  }
  c.measure = [mask, points, types](std::uint64_t seed) {
    std::vector<double> values;
    for (const int type : types) {
      SceneKit kit(scene::RadianceUnit::Nit);
      build_room(kit, facade(false), kit.diffuse(0.0));
      build_mask(kit, mask);
      add_sky(kit, type);
      const Solution s(
          kit.build(),
          {.element_size = mask.horizontal ? 0.25 : 1.0, .direct_samples = 512, .seed = seed});
      const std::vector<double> e =
          shares(s.query(), s.result().field, points, {.error = 0.005, .seed = seed});
      values.insert(values.end(), e.begin(), e.end());
    }
    return values;
  };
  return c;
}

std::vector<Case> make_cases(Extent extent) {
  std::vector<int> types{5, kClear, 16};
  if (extent == Extent::Full) {
    types.resize(16);
    std::iota(types.begin(), types.end(), 1);
  }
  std::vector<Case> cases;
  for (const bool glazed : {false, true})
    for (Room room : {roof(1), roof(4)}) {
      room.glazed = glazed;
      cases.push_back(opening_case(glazed ? "5.10" : "5.9", room, types));
    }
  for (const bool glazed : {false, true})
    for (Room room : {facade(false), facade(true)}) {
      room.glazed = glazed;
      cases.push_back(opening_case(glazed ? "5.12" : "5.11", room, types));
    }
  cases.push_back(floor_case());
  for (const double size : {0.5, 1.0, 2.0}) cases.push_back(mask_case({true, size}));
  for (const double size : {3.0, 6.0, 9.0}) cases.push_back(mask_case({false, size}));
  return cases;
}

}  // namespace

std::vector<Case> cie171_daylight_cases(Extent extent) {
  // Their references take a second.
  if (extent == Extent::Quick) {
    static const std::vector<Case> quick = make_cases(extent);
    return quick;
  }
  static const std::vector<Case> full = make_cases(extent);
  return full;
}

}  // namespace atrium::validation
