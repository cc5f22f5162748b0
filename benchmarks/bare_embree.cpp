#include "bare_embree.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace atrium::bench {
namespace {

using scene::Ray;

void set(RTCRay& r, const Ray& ray, std::uint32_t mask) {
  r.org_x = ray.origin.x(), r.org_y = ray.origin.y(), r.org_z = ray.origin.z();
  r.dir_x = ray.direction.x(), r.dir_y = ray.direction.y(), r.dir_z = ray.direction.z();
  r.tnear = ray.tmin, r.tfar = ray.tmax, r.time = 0.0f;
  r.mask = mask, r.id = 0, r.flags = 0;
}

RTCRayHit ray_hit(const Ray& ray) {
  RTCRayHit h;
  set(h.ray, ray, scene::kEverything);
  h.hit.geomID = h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return h;
}

void set(RTCRayHit8& h, std::size_t i, const Ray& ray) {
  h.ray.org_x[i] = ray.origin.x(), h.ray.org_y[i] = ray.origin.y();
  h.ray.org_z[i] = ray.origin.z(), h.ray.dir_x[i] = ray.direction.x();
  h.ray.dir_y[i] = ray.direction.y(), h.ray.dir_z[i] = ray.direction.z();
  h.ray.tnear[i] = ray.tmin, h.ray.tfar[i] = ray.tmax, h.ray.time[i] = 0.0f;
  h.ray.mask[i] = scene::kEverything, h.ray.id[i] = 0, h.ray.flags[i] = 0;
  h.hit.geomID[i] = h.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

std::size_t hit(const RTCRayHit& h) { return h.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1U : 0U; }

std::uint32_t mask_of(const material::Material& material) {
  const material::MaterialTraits t = material::traits(material);
  if (t.alpha_mask) return scene::kAlpha;
  return t.pane ? scene::kPane : scene::kOpaque;
}

RTCScene robust_scene(RTCDevice device) {
  RTCScene s = rtcNewScene(device);
  rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
  return s;
}

void attach(RTCScene to, RTCGeometry g, std::uint32_t id, std::uint32_t mask) {
  rtcSetGeometryMask(g, mask);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(to, g, id);
  rtcReleaseGeometry(g);
}

}  // namespace

RTCGeometry BareEmbree::geometry(const scene::Mesh& mesh) const {
  RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
  for (const Vec3f& p : mesh.positions) vertex = std::copy_n(p.data(), 3, vertex);
  std::memcpy(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                      mesh.triangles.size()),
              mesh.triangles.data(), mesh.triangles.size() * 12);
  return g;
}

BareEmbree::BareEmbree(const scene::Scene& scene)
    : device_(rtcNewDevice(nullptr)), top_(robust_scene(device_)), shared_(scene.meshes.size()) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    const scene::Mesh& mesh = scene.meshes[object.mesh.value];
    if (mesh.triangles.empty()) continue;
    const std::uint32_t mask = mask_of(scene.material_of(scene::ObjectId(i)));
    if (!object.instanced) {
      attach(top_, geometry(mesh), i, mask);
      continue;
    }
    RTCScene& shared = shared_[object.mesh.value];
    if (shared == nullptr) {
      shared = robust_scene(device_);
      attach(shared, geometry(mesh), 0, 0xffffffffU);
      rtcCommitScene(shared);
    }
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, shared);
    const Eigen::Matrix<float, 3, 4> m = object.to_scene.affine();
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
    attach(top_, g, i, mask);
  }
  rtcCommitScene(top_);
}

BareEmbree::~BareEmbree() {
  for (const RTCScene s : shared_)
    if (s != nullptr) rtcReleaseScene(s);
  rtcReleaseScene(top_);
  rtcReleaseDevice(device_);
}

std::size_t BareEmbree::single(std::span<const Ray> rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    RTCRayHit h = ray_hit(ray);
    rtcIntersect1(top_, &context, &h);
    hits += hit(h);
  }
  return hits;
}

std::size_t BareEmbree::packets(std::span<const Ray> rays, std::size_t group) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::size_t hits = 0;
  std::vector<std::uint32_t> order(group);
  for (std::size_t first = 0; first + group <= rays.size(); first += group) {
    for (std::uint32_t i = 0; i < group; ++i) order[i] = i;
    const auto octant = [&](std::uint32_t i) {
      const Vec3f& d = rays[first + i].direction;
      return (d.x() < 0) + 2 * (d.y() < 0) + 4 * (d.z() < 0);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return octant(a) < octant(b); });
    for (std::size_t k = 0; k < group; k += 8) {
      alignas(32) RTCRayHit8 h;
      alignas(32) int valid[8];
      for (std::size_t i = 0; i < 8; ++i) {
        valid[i] = k + i < group ? -1 : 0;
        if (valid[i] != 0) set(h, i, rays[first + order[k + i]]);
      }
      rtcIntersect8(valid, top_, &context, &h);
      for (int i = 0; i < 8; ++i)
        hits += valid[i] != 0 && h.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? 1U : 0U;
    }
  }
  return hits;
}

std::size_t BareEmbree::stream(std::span<const Ray> rays, std::size_t group) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::size_t hits = 0;
  std::vector<RTCRayHit> h(group);
  for (std::size_t first = 0; first + group <= rays.size(); first += group) {
    for (std::size_t i = 0; i < group; ++i) h[i] = ray_hit(rays[first + i]);
    rtcIntersect1M(top_, &context, h.data(), static_cast<unsigned>(group), sizeof(RTCRayHit));
    for (const RTCRayHit& r : h) hits += hit(r);
  }
  return hits;
}

std::size_t BareEmbree::occluded(std::span<const Ray> rays, std::uint32_t mask) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    RTCRay r;
    set(r, ray, mask);
    rtcOccluded1(top_, &context, &r);
    hits += r.tfar < 0.0f ? 1U : 0U;
  }
  return hits;
}

}  // namespace atrium::bench
