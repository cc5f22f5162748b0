#include "patches.h"

#include <algorithm>

#include "polygon.h"
#include "radiosity/form_factor.h"

namespace atrium::radiosity {
namespace {

using Polygon = std::vector<Vec3d>;

double cross(const Vec2d& o, const Vec2d& a, const Vec2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Convex hull, counter-clockwise (Andrew 1979); `slack` [m^2] ignores corners on an edge.
std::vector<Vec2d> convex_hull(std::vector<Vec2d> p, double slack) {
  std::sort(p.begin(), p.end(), [](const Vec2d& a, const Vec2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2d& q : p) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), q) <= slack)
        hull.pop_back();
      hull.push_back(q);
    }
    hull.pop_back();
    std::reverse(p.begin(), p.end());
  }
  return hull;
}

/// The element as one polygon if its pieces fill their convex hull in a plane.
std::optional<Polygon> merged(const std::vector<Polygon>& pieces, double area) {
  if (pieces.size() == 1) return pieces[0];
  const Vec3d normal = polygon_area_vector(pieces[0]).normalized();
  const Vec3d x = normal.unitOrthogonal();
  const Vec3d y = normal.cross(x);
  const Vec3d origin = pieces[0][0];
  const double size = std::sqrt(area);
  std::vector<Vec2d> flat;
  for (const Polygon& piece : pieces)
    for (const Vec3d& p : piece) {
      if (std::abs(normal.dot(p - origin)) > 1e-5 * size) return std::nullopt;
      flat.emplace_back(x.dot(p - origin), y.dot(p - origin));
    }
  Polygon hull;
  for (const Vec2d& p : convex_hull(flat, 1e-6 * area))
    hull.push_back(origin + p.x() * x + p.y() * y);
  if (hull.size() < 3) return std::nullopt;
  const double hull_area = 0.5 * polygon_area_vector(hull).norm();
  if (std::abs(hull_area - area) > 1e-5 * area) return std::nullopt;
  return hull;
}

void finish(Patch& patch) {
  if (patch.back)
    for (Polygon& p : patch.polygons) std::reverse(p.begin(), p.end());
  double corners = 0.0;
  for (const Polygon& p : patch.polygons)
    for (const Vec3d& v : p) patch.centre += v, corners += 1.0;
  patch.centre /= corners;
  for (const Polygon& p : patch.polygons)
    for (const Vec3d& v : p) patch.radius = std::max(patch.radius, (v - patch.centre).norm());
}

struct Node {
  double a, b, c, weight;
};
/// Degree 5 on a triangle, weights sum to 1 (Radon 1948).
constexpr std::array<Node, 7> kRule{
    {{1.0 / 3, 1.0 / 3, 1.0 / 3, 0.225},
     {0.0597158717897698, 0.4701420641051151, 0.4701420641051151, 0.1323941527885062},
     {0.4701420641051151, 0.0597158717897698, 0.4701420641051151, 0.1323941527885062},
     {0.4701420641051151, 0.4701420641051151, 0.0597158717897698, 0.1323941527885062},
     {0.7974269853530873, 0.1012865073234563, 0.1012865073234563, 0.1259391805448271},
     {0.1012865073234563, 0.7974269853530873, 0.1012865073234563, 0.1259391805448271},
     {0.1012865073234563, 0.1012865073234563, 0.7974269853530873, 0.1259391805448271}}};

/// Integral over polygon a of the point factor to b, where a point is in front of b.
double point_rule(const Polygon& a, const Polygon& b) {
  const Vec3d normal_a = polygon_area_vector(a).normalized();
  const Vec3d normal_b = polygon_area_vector(b);
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < a.size(); ++i) {
    const double area = 0.5 * (a[i] - a[0]).cross(a[i + 1] - a[0]).norm();
    for (const Node& n : kRule) {
      const Vec3d p = n.a * a[0] + n.b * a[i] + n.c * a[i + 1];
      if (normal_b.dot(p - b[0]) > 0.0) sum += area * n.weight * point_to_polygon(p, normal_a, b);
    }
  }
  return sum;
}

}  // namespace

Patch element_patch(const Elements& elements, SideIndex side) {
  Patch patch;
  patch.element = side / 2;
  patch.back = side_of(side) == scene::Side::Back;
  for (std::uint32_t p = elements.first_piece[patch.element];
       p < elements.first_piece[patch.element + 1]; ++p) {
    Polygon polygon;
    for (const Vec3f& c : elements.pieces[p].corners) polygon.push_back(c.cast<double>());
    patch.area += 0.5 * polygon_area_vector(polygon).norm();
    patch.polygons.push_back(std::move(polygon));
  }
  if (auto one = merged(patch.polygons, patch.area)) {
    const Vec3d before = polygon_area_vector(patch.polygons[0]);
    if (polygon_area_vector(*one).dot(before) < 0.0) std::reverse(one->begin(), one->end());
    patch.polygons = {std::move(*one)};
  }
  finish(patch);
  return patch;
}

Patch triangle_patch(const scene::Scene& scene, scene::ObjectId object, std::uint32_t triangle,
                     bool back) {
  Patch patch;
  patch.object = object;
  patch.triangle = triangle;
  patch.back = back;
  Polygon polygon;
  for (const Vec3f& c : scene.corners(object, triangle)) polygon.push_back(c.cast<double>());
  patch.area = 0.5 * polygon_area_vector(polygon).norm();
  patch.polygons.push_back(std::move(polygon));
  finish(patch);
  return patch;
}

scene::SurfacePoint sample_patch(const scene::Scene& scene, const ElementPoints& points,
                                 const Patch& patch, const Vec2f& u) {
  if (!patch.object.valid()) return points.sample(patch.element, u);
  const float root = std::sqrt(u.x());
  return scene::surface_point(scene, patch.object, patch.triangle, root * (1.0f - u.y()),
                              root * u.y());
}

double unoccluded_exchange_area(const Patch& a, const Patch& b, bool always_contours) {
  const double distance = (a.centre - b.centre).norm();
  const bool near = always_contours || distance < 3.0 * (a.radius + b.radius);
  double sum = 0.0;
  for (const Polygon& p : a.polygons)
    for (const Polygon& q : b.polygons)
      sum += near ? polygon_exchange_area(p, q) : point_rule(p, q);
  return sum;
}

}  // namespace atrium::radiosity
