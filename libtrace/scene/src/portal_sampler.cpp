#include "portal_sampler.h"

#include <algorithm>
#include <cmath>

#include "directions.h"
#include "scene/spherical_triangle.h"

namespace atrium::scene {
namespace {

/// Is the point in the room and on the inner side of the opening?
bool faces(const Portal& portal, const Vec3f& p) {
  if (!portal.room.contains(p)) return false;
  const auto& c = portal.corners;
  return (c[1] - c[0]).cross(c[2] - c[0]).dot(p - c[0]) > 0.0f;
}

bool above(const Portal& portal, const Vec3f& p, const Vec3f& normal) {
  if (normal.isZero()) return true;
  return std::any_of(portal.corners.begin(), portal.corners.end(),
                     [&](const Vec3f& c) { return normal.dot(c - p) > 0.0f; });
}

/// Distance along a ray to the triangle (Moeller & Trumbore 1997).
std::optional<float> hit(const Portal& portal, const Vec3f& p, const Vec3f& w) {
  const auto& c = portal.corners;
  const Vec3f e1 = c[1] - c[0], e2 = c[2] - c[0], h = w.cross(e2);
  const float det = e1.dot(h);
  if (det == 0.0f) return std::nullopt;
  const Vec3f s = p - c[0], q = s.cross(e1);
  const float b1 = s.dot(h) / det, b2 = w.dot(q) / det, t = e2.dot(q) / det;
  if (!(b1 >= 0.0f && b2 >= 0.0f && b1 + b2 <= 1.0f && t > 0.0f)) return std::nullopt;
  return t;
}

// By area where the spherical triangle is too small to be sampled well.
float area_density(const Portal& portal, const Vec3f& w, float distance) {
  const auto& c = portal.corners;
  const float projected = 0.5f * std::abs((c[1] - c[0]).cross(c[2] - c[0]).dot(w));
  return projected > 0.0f ? distance * distance / projected : 0.0f;
}

double angle_of(const SphericalTriangle& seen) {
  const double a = seen.solid_angle();
  return a > 0.0 && std::isfinite(a) ? a : 0.0;
}

}  // namespace

double PortalSampler::solid_angle(const Vec3f& p, const Vec3f& normal) const {
  double sum = 0.0;
  for (const Portal& portal : portals_)
    if (faces(portal, p) && above(portal, p, normal))
      sum += angle_of(SphericalTriangle(portal.corners, p));
  return sum;
}

std::optional<Vec3f> PortalSampler::sample(const Vec3f& p, const Vec3f& normal, double total,
                                           const Vec2f& u) const {
  double left = static_cast<double>(u.x()) * total;
  for (const Portal& portal : portals_) {
    if (!faces(portal, p) || !above(portal, p, normal)) continue;
    const SphericalTriangle seen(portal.corners, p);
    const double angle = angle_of(seen);
    if (left >= angle) {
      left -= angle;
      continue;
    }
    const Vec2f v(std::min(static_cast<float>(left / angle), 0x1.fffffep-1f), u.y());
    if (seen.usable()) return seen.sample(v).cast<float>();
    const Vec2f b = uniform_triangle(v);
    const auto& c = portal.corners;
    return Vec3f(c[0] + b.x() * (c[1] - c[0]) + b.y() * (c[2] - c[0]) - p).normalized();
  }
  return std::nullopt;  // u.x() at its end and rounding
}

float PortalSampler::pdf(const Vec3f& p, const Vec3f& normal, double total, const Vec3f& w) const {
  double sum = 0.0;
  for (const Portal& portal : portals_) {
    if (!faces(portal, p) || !above(portal, p, normal)) continue;
    const auto t = hit(portal, p, w);
    if (!t) continue;
    const SphericalTriangle seen(portal.corners, p);
    const double angle = angle_of(seen);
    sum += seen.usable() ? 1.0 : angle * static_cast<double>(area_density(portal, w, *t));
  }
  return static_cast<float>(sum / total);
}

bool PortalSampler::shut(const Vec3f& p, const Vec3f& w) const {
  bool inside = false;
  for (const Portal& portal : portals_) {
    if (!faces(portal, p)) continue;
    if (hit(portal, p, w)) return false;
    inside = true;
  }
  return inside;
}

}  // namespace atrium::scene
