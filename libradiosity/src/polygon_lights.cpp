#include "polygon_lights.h"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "polygon.h"
#include "radiosity/form_factor.h"
#include "scene/spherical_triangle.h"
#include "scene/vertex_colors.h"

namespace atrium::radiosity {
namespace {

using scene::EmissiveTriangle;

// Coordinates are floats made doubles: what is flat and straight is so to about 1e-7.
constexpr double kFlat = 1e-6;
constexpr double kStraight = 1e-7;
constexpr std::size_t kTrianglesPerPolygon = 32;  // more are hardly going to join

struct Outline {
  std::vector<Vec3d> corners;
  Vec3d normal;
};

using Edge = std::tuple<double, double, double, double, double, double>;
Edge edge(const Vec3d& a, const Vec3d& b) { return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}; }

/// Sine of the turn at b, times both lengths, about the normal.
double turn(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& normal) {
  return normal.dot((b - a).cross(c - b));
}

bool convex(const Outline& o) {
  const std::size_t n = o.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d &a = o.corners[i], &b = o.corners[(i + 1) % n], &c = o.corners[(i + 2) % n];
    if (turn(a, b, c, o.normal) < -kStraight * (b - a).norm() * (c - b).norm()) return false;
  }
  return true;
}

void drop_straight_corners(Outline& o) {
  for (std::size_t i = 0; i < o.corners.size() && o.corners.size() > 3;) {
    const std::size_t n = o.corners.size();
    const Vec3d &a = o.corners[(i + n - 1) % n], &b = o.corners[i], &c = o.corners[(i + 1) % n];
    const bool straight =
        (b - a).cross(c - b).norm() <= kStraight * (b - a).norm() * (c - b).norm();
    if (straight && (b - a).dot(c - b) > 0.0)
      o.corners.erase(o.corners.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
}

/// a and b without their common edge, a.corners[i] to the next; nullopt unless flat and convex.
std::optional<Outline> join(const Outline& a, std::size_t i, const Outline& b, std::size_t j) {
  if (a.normal.cross(b.normal).norm() > kFlat || a.normal.dot(b.normal) < 0.0) return std::nullopt;
  Outline r;
  r.normal = a.normal;
  for (std::size_t k = 1; k <= a.corners.size(); ++k)
    r.corners.push_back(a.corners[(i + k) % a.corners.size()]);
  for (std::size_t k = 2; k < b.corners.size(); ++k)
    r.corners.push_back(b.corners[(j + k) % b.corners.size()]);
  if (!convex(r)) return std::nullopt;
  drop_straight_corners(r);
  r.normal = polygon_area_vector(r.corners).normalized();
  return r;
}

/// One pass over all pairs with a common edge. False if nothing could be joined.
bool join_neighbours(std::vector<Outline>& outlines) {
  std::map<Edge, std::pair<std::size_t, std::size_t>> owner;  // directed edge -> outline, corner
  for (std::size_t o = 0; o < outlines.size(); ++o) {
    const std::vector<Vec3d>& c = outlines[o].corners;
    for (std::size_t i = 0; i < c.size(); ++i) owner[edge(c[i], c[(i + 1) % c.size()])] = {o, i};
  }
  std::vector<std::uint8_t> done(outlines.size(), 0);  // joined in this pass: its edges are old
  std::vector<Outline> result;
  bool any = false;
  for (std::size_t o = 0; o < outlines.size(); ++o) {
    if (done[o] != 0) continue;
    Outline mine = outlines[o];
    for (std::size_t i = 0; i < outlines[o].corners.size(); ++i) {
      const std::vector<Vec3d>& c = outlines[o].corners;
      const auto found = owner.find(edge(c[(i + 1) % c.size()], c[i]));
      if (found == owner.end()) continue;
      const auto [other, j] = found->second;
      if (other <= o || done[other] != 0) continue;
      if (auto joined = join(outlines[o], i, outlines[other], j)) {
        mine = std::move(*joined);
        done[other] = 1;
        any = true;
        break;
      }
    }
    done[o] = 1;
    result.push_back(std::move(mine));
  }
  outlines = std::move(result);
  return any;
}

template <int N>
Lanes<N> to_lanes(const Spectrum<N>& s) {
  Lanes<N> r;
  for (int i = 0; i < N; ++i) r[i] = static_cast<double>(s[i]);
  return r;
}

}  // namespace

template <int N>
PolygonLights<N>::PolygonLights(const scene::Shading<N>& shading, std::size_t limit) {
  const std::span<const EmissiveTriangle> surfaces = shading.lights().surfaces();
  const scene::Scene& scene = shading.scene();
  covered_.assign(surfaces.size(), 0);
  covers_all_ = surfaces.empty();
  if (surfaces.size() > limit * kTrianglesPerPolygon) return;
  covers_all_ = true;
  for (std::size_t first = 0; first < surfaces.size();) {
    std::size_t last = first;
    while (last < surfaces.size() && surfaces[last].object == surfaces[first].object) ++last;
    const material::Material& m = scene.material_of(surfaces[first].object);
    const bool colored =
        scene::vertex_colors_emit(m) && !scene.mesh_of(surfaces[first].object).colors.empty();
    if (colored || m.emission_texture.texture.valid() || m.alpha_texture.texture.valid()) {
      covers_all_ = false;
      first = last;
      continue;
    }
    std::vector<Outline> outlines;
    for (std::size_t i = first; i < last; ++i) {
      covered_[i] = 1;
      Outline o;
      for (const Vec3f& c : scene.corners(surfaces[i].object, surfaces[i].triangle))
        o.corners.push_back(c.cast<double>());
      o.normal = polygon_area_vector(o.corners);
      if (!(o.normal.norm() > 0.0)) continue;  // lights nothing
      o.normal.normalize();
      outlines.push_back(std::move(o));
    }
    while (join_neighbours(outlines)) {
    }
    if (!outlines.empty()) {
      const scene::SurfacePoint point =
          scene::surface_point(scene, surfaces[first].object, surfaces[first].triangle, 0.3f, 0.3f);
      const Lanes<N> radiance = to_lanes<N>(shading.lights().emitted(point, point.ng));
      for (Outline& o : outlines)
        polygons_.push_back({std::move(o.corners), o.normal, m.emits_both_sides, radiance});
    }
    first = last;
  }
  if (polygons_.size() <= limit) return;
  polygons_.clear();
  covered_.assign(surfaces.size(), 0);
  covers_all_ = false;
}

template <int N>
double PolygonLights<N>::factor(const Polygon& polygon, const Vec3d& p, const Vec3d& normal) {
  const double height = polygon.normal.dot(p - polygon.corners[0]);
  if (!(polygon.two_sided ? height != 0.0 : height > 0.0)) return 0.0;
  return point_to_polygon(p, normal, polygon.corners);
}

template <int N>
Lanes<N> PolygonLights<N>::irradiance(const Vec3d& p, const Vec3d& normal) const {
  Lanes<N> sum = Lanes<N>::Zero();
  for (const Polygon& polygon : polygons_)
    sum += polygon.radiance * (std::numbers::pi * factor(polygon, p, normal));
  return sum;
}

template class PolygonLights<1>;
template class PolygonLights<3>;
template class PolygonLights<4>;
template class PolygonLights<8>;

PolygonSampler::PolygonSampler(const std::vector<Vec3d>& corners, const Vec3d& polygon_normal,
                               const Vec3d& p, const Vec3d& normal)
    : p_(p), normal_(normal), polygon_normal_(polygon_normal) {
  clip_polygon(
      corners, corners_, [&](const Vec3d& v) { return normal.dot(v - p); },
      [](const Vec3d& a, const Vec3d& b, double t) -> Vec3d { return a + t * (b - a); });
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < corners_.size(); ++i)
    factor_until_.push_back(
        sum += point_to_polygon(p, normal, std::array{corners_[0], corners_[i], corners_[i + 1]}));
}

std::optional<PolygonSampler::Sample> PolygonSampler::sample(float u_choice, const Vec2f& u) const {
  if (factor_until_.empty() || !(factor_until_.back() > 0.0)) return std::nullopt;
  const double total = factor_until_.back();
  const double x = static_cast<double>(u_choice) * total;
  std::size_t i = 0;
  while (i + 1 < factor_until_.size() && !(x < factor_until_[i])) ++i;
  const double share = (factor_until_[i] - (i > 0 ? factor_until_[i - 1] : 0.0)) / total;
  const std::array<Vec3d, 3> c{corners_[0], corners_[i + 1], corners_[i + 2]};
  const scene::SphericalTriangle seen(c, p_);
  Sample s;
  double density = 0.0;
  if (seen.usable()) {
    s.direction = seen.sample(u);
    const double cosine = polygon_normal_.dot(s.direction);
    s.distance = polygon_normal_.dot(c[0] - p_) / cosine;
    density = 1.0 / seen.solid_angle();
    if (!(s.distance > 0.0) || !std::isfinite(s.distance)) s.distance = (c[0] - p_).norm();
  } else {
    const double root = std::sqrt(static_cast<double>(u.x()));
    const double v = static_cast<double>(u.y());
    const Vec3d d = c[0] * (1.0 - root) + c[1] * (root * (1.0 - v)) + c[2] * (root * v) - p_;
    s.distance = d.norm();
    s.direction = d / s.distance;
    const double area = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
    density = s.distance * s.distance / (std::abs(polygon_normal_.dot(s.direction)) * area);
  }
  const double cosine = normal_.dot(s.direction);
  s.weight = cosine > 0.0 && share > 0.0 && density > 0.0 ? cosine / (density * share) : 0.0;
  if (!std::isfinite(s.weight)) s.weight = 0.0;
  return s;
}

}  // namespace atrium::radiosity
