#include "scene/ray_query.h"

#include <algorithm>
#include <cmath>

namespace atrium::scene {

std::array<Vec3f, 3> Scene::corners(ObjectId id, std::uint32_t triangle) const {
  const Object& object = objects[id.value];
  const Mesh& mesh = meshes[object.mesh.value];
  const Triangle& t = mesh.triangles[triangle];
  std::array<Vec3f, 3> p{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  if (object.instanced)
    for (Vec3f& v : p) v = object.to_scene * v;
  return p;
}

std::uint64_t Scene::triangle_count() const {
  std::uint64_t n = 0;
  for (const Object& o : objects) n += meshes[o.mesh.value].triangles.size();
  return n;
}

namespace {

Vec3f shading_normal(const Object& object, const Mesh& mesh, const Triangle& t, float b0, float u,
                     float v, const Vec3f& ng) {
  if (mesh.normals.empty()) return ng;
  Vec3f n = b0 * mesh.normals[t[0]] + u * mesh.normals[t[1]] + v * mesh.normals[t[2]];
  if (object.instanced) n = object.to_scene.linear().inverse().transpose() * n;
  const float length = n.norm();
  if (!(length > 1e-6f)) return ng;
  n /= length;
  return n.dot(ng) < 0.0f ? Vec3f(-n) : n;
}

Vec3f facet_normal(const Vec3f& e1, const Vec3f& e2) {
  const Vec3f n = e1.cross(e2);
  const float square = n.squaredNorm();
  if (square > 1e-25f && square < 1e25f) return n * (1.0f / std::sqrt(square));
  // The cross product of scaled edges neither over- nor underflows.
  const float scale = std::max(e1.cwiseAbs().maxCoeff(), e2.cwiseAbs().maxCoeff());
  const Vec3f scaled = scale > 0.0f ? Vec3f((e1 / scale).cross(e2 / scale)) : Vec3f::Zero();
  const float length = scaled.norm();
  return length > 0.0f ? Vec3f(scaled / length) : Vec3f::UnitY();
}

}  // namespace

SurfacePoint surface_point(const Scene& scene, ObjectId id, std::uint32_t triangle, float u,
                           float v) {
  const Object& object = scene.objects[id.value];
  const Mesh& mesh = scene.meshes[object.mesh.value];
  const Triangle& t = mesh.triangles[triangle];
  const std::array<Vec3f, 3> c = scene.corners(id, triangle);
  const float b0 = 1.0f - u - v;

  SurfacePoint p;
  p.object = id;
  p.material = object.material;
  p.triangle = triangle;
  p.u = u;
  p.v = v;
  p.position = b0 * c[0] + u * c[1] + v * c[2];
  const Vec3f e1 = c[1] - c[0];
  const Vec3f e2 = c[2] - c[0];
  p.ng = facet_normal(e1, e2);
  p.ns = shading_normal(object, mesh, t, b0, u, v, p.ng);
  // Interpolation error gamma(7) of each coordinate (pbrt, 4th ed., sec. 6.8.4), doubled twice for
  // the transform of instances and for Embree's own rounding of t; along the normal.
  const Vec3f magnitude = c[0].cwiseAbs().cwiseMax(c[1].cwiseAbs()).cwiseMax(c[2].cwiseAbs());
  p.error = 28.0f * 0x1p-24f * p.ng.cwiseAbs().dot(magnitude);

  if (!mesh.uvs.empty()) {
    const Vec2f &t0 = mesh.uvs[t[0]], &t1 = mesh.uvs[t[1]], &t2 = mesh.uvs[t[2]];
    p.uv = b0 * t0 + u * t1 + v * t2;
    const Vec2f d1 = t1 - t0;
    const Vec2f d2 = t2 - t0;
    const float det = d1.x() * d2.y() - d1.y() * d2.x();
    if (det != 0.0f) p.dpdu = (d2.y() * e1 - d1.y() * e2) / det;
  }
  if (!mesh.colors.empty())
    p.color = b0 * mesh.colors[t[0]] + u * mesh.colors[t[1]] + v * mesh.colors[t[2]];
  return p;
}

Vec3f offset_origin(const SurfacePoint& point, const Vec3f& direction) {
  const float side = direction.dot(point.ng) >= 0.0f ? 1.0f : -1.0f;
  return offset_origin(point.position, point.error, side * point.ng);
}

}  // namespace atrium::scene
