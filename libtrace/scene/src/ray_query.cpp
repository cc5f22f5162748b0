#include "scene/ray_query.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "material/error.h"
#include "ray_clock.h"

namespace atrium::scene {
namespace {

// One source for Embree 3 and 4; rays here are incoherent unless traced in packets.
#if EMBREE_MAJOR >= 4
struct Context {
  RTCIntersectArguments intersect;
  RTCOccludedArguments occluded;
  Context() {
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    intersect.feature_mask = occluded.feature_mask =
        static_cast<RTCFeatureFlags>(RTC_FEATURE_FLAG_TRIANGLE | RTC_FEATURE_FLAG_INSTANCE);
  }
};
void trace_closest(RTCScene scene, Context& c, RTCRayHit* h) {
  rtcIntersect1(scene, h, &c.intersect);
}
void trace_closest(RTCScene scene, Context& c, RTCRayHit* h, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) trace_closest(scene, c, h + i);
}
void trace_any(RTCScene scene, Context& c, RTCRay* r) { rtcOccluded1(scene, r, &c.occluded); }
#else
struct Context {
  RTCIntersectContext context;
  Context() { rtcInitIntersectContext(&context); }
};
void trace_closest(RTCScene scene, Context& c, RTCRayHit* h) {
  rtcIntersect1(scene, &c.context, h);
}
// Not in packets: incoherent rays sorted by octant take as long in eights as one by one.
void trace_closest(RTCScene scene, Context& c, RTCRayHit* h, std::size_t count) {
  rtcIntersect1M(scene, &c.context, h, static_cast<unsigned>(count), sizeof(RTCRayHit));
}
void trace_any(RTCScene scene, Context& c, RTCRay* r) { rtcOccluded1(scene, &c.context, r); }
#endif

constexpr float kLargest = 1.0e18f;

// Debian's Embree aborts the process on such rays, so every ray passes here.
bool acceptable(const Ray& ray) {
  const auto fine = [](const Vec3f& v) {
    return std::abs(v.x()) <= kLargest && std::abs(v.y()) <= kLargest &&
           std::abs(v.z()) <= kLargest;
  };
  return fine(ray.origin) && fine(ray.direction) && ray.tmin >= 0.0f && ray.tmin <= kLargest &&
         ray.tmax >= ray.tmin;
}

void fill(RTCRay& r, const Ray& ray, std::uint32_t mask) {
  r.org_x = ray.origin.x();
  r.org_y = ray.origin.y();
  r.org_z = ray.origin.z();
  r.dir_x = ray.direction.x();
  r.dir_y = ray.direction.y();
  r.dir_z = ray.direction.z();
  r.tnear = ray.tmin;
  r.tfar = ray.tmax;
  r.time = 0.0f;
  r.mask = mask;
  r.id = 0;
  r.flags = 0;
}

void fill(RTCRayHit& h, const Ray& ray, std::uint32_t mask) {
  fill(h.ray, ray, mask);
  h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

std::uint32_t mask_of(const material::Material& material) {
  const material::MaterialTraits t = material::traits(material);
  if (t.alpha_mask) return kAlpha;
  return t.pane ? kPane : kOpaque;
}

}  // namespace

struct RayQuery::Impl {
  const Scene* scene = nullptr;
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> shared;  // by mesh, null unless instanced
  std::uint32_t present = 0;     // union of all masks
  ssize_t bytes = 0;
  RayClock clock;

  ~Impl() {
    for (const RTCScene s : shared)
      if (s != nullptr) rtcReleaseScene(s);
    if (top != nullptr) rtcReleaseScene(top);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  Hit hit(const RTCRayHit& h) const {
    Vec3f ng(h.hit.Ng_x, h.hit.Ng_y, h.hit.Ng_z);
    const bool instance = h.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    const std::uint32_t object = instance ? h.hit.instID[0] : h.hit.geomID;
    if (instance) {  // the normal of moved edges, mirrored ones too: the matrix of cofactors
      const Eigen::Matrix3f m = scene->objects[object].to_scene.linear();
      ng = Vec3f(m.col(1).cross(m.col(2)) * ng.x() + m.col(2).cross(m.col(0)) * ng.y() +
                 m.col(0).cross(m.col(1)) * ng.z());
    }
    return {h.ray.tfar, h.hit.u, h.hit.v, ObjectId(object), h.hit.primID, ng};
  }

  RTCGeometry make_geometry(const Mesh& mesh) const {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.positions.size()));
    auto* t = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (v == nullptr || t == nullptr) {
      rtcReleaseGeometry(g);
      throw RuntimeFailure("not enough memory for the geometry of mesh '" + mesh.name + "'");
    }
    std::ranges::uninitialized_copy(mesh.positions, std::span(v, mesh.positions.size()));
    std::memcpy(t, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
    return g;
  }

  void attach(RTCScene to, RTCGeometry g, std::uint32_t id, std::uint32_t mask) const {
    rtcSetGeometryMask(g, mask);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(to, g, id);
    rtcReleaseGeometry(g);
  }

  RTCScene shared_scene(MeshId id) {
    RTCScene& s = shared[id.value];
    if (s == nullptr) {
      s = rtcNewScene(device);
      rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
      attach(s, make_geometry(scene->meshes[id.value]), 0, 0xffffffffU);
      rtcCommitScene(s);
    }
    return s;
  }

  RTCGeometry make_instance(const Object& object) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, shared_scene(object.mesh));
    const Eigen::Matrix<float, 3, 4> m =
        object.to_scene.affine();  // column major, as Embree reads it
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
    return g;
  }
};

RayQuery::RayQuery(const Scene& scene, const RayQueryOptions& options)
    : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.scene = &scene;
  m.device = rtcNewDevice(options.device_config.empty() ? nullptr : options.device_config.c_str());
  if (m.device == nullptr) throw RuntimeFailure("Embree cannot create a device");
  rtcSetDeviceMemoryMonitorFunction(
      m.device,
      [](void* user, ssize_t bytes, bool) {
        __atomic_add_fetch(static_cast<ssize_t*>(user), bytes, __ATOMIC_RELAXED);
        return true;
      },
      &m.bytes);
  m.shared.resize(scene.meshes.size(), nullptr);
  m.top = rtcNewScene(m.device);
  rtcSetSceneFlags(m.top, RTC_SCENE_FLAG_ROBUST);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const Mesh& mesh = scene.meshes[object.mesh.value];
    if (mesh.triangles.empty()) continue;
    const std::uint32_t mask = mask_of(scene.material_of(ObjectId(i)));
    m.present |= mask;
    m.attach(m.top, object.instanced ? m.make_instance(object) : m.make_geometry(mesh), i, mask);
  }
  rtcCommitScene(m.top);
  if (const RTCError error = rtcGetDeviceError(m.device); error != RTC_ERROR_NONE)
    throw RuntimeFailure("Embree cannot build the scene, error " + std::to_string(error));
}

RayQuery::~RayQuery() = default;
RayQuery::RayQuery(RayQuery&&) noexcept = default;
RayQuery& RayQuery::operator=(RayQuery&&) noexcept = default;

std::optional<Hit> RayQuery::closest(const Ray& ray, Counters& counters, Counter kind,
                                     std::uint32_t mask) const {
  if (!acceptable(ray)) {
    ++counters[Counter::RaysRefused];
    return std::nullopt;
  }
  const std::uint64_t number = ++counters[kind];
  RTCRayHit h;
  fill(h, ray, mask);
  Context context;
  impl_->clock.time(number, kind, 1, [&] { trace_closest(impl_->top, context, &h); });
  if (h.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return impl_->hit(h);
}

void RayQuery::closest(std::span<const Ray> rays, std::span<Hit> hits, Counters& counters,
                       Counter kind, std::uint32_t mask) const {
  assert(hits.size() == rays.size());
  constexpr std::size_t kBatch = 64;
  std::array<RTCRayHit, kBatch> h;
  Context context;
  for (std::size_t first = 0; first < rays.size(); first += kBatch) {
    const std::size_t n = std::min(kBatch, rays.size() - first);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool fine = acceptable(rays[first + i]);
      // A ray that ends before it begins is one that Embree leaves alone.
      fill(h[i], fine ? rays[first + i] : Ray{Vec3f::Zero(), Vec3f::UnitX(), 1.0f, 0.0f}, mask);
      refused += fine ? 0U : 1U;
    }
    impl_->clock.time(counters[kind] / kBatch, kind, n,
                      [&] { trace_closest(impl_->top, context, h.data(), n); });
    for (std::size_t i = 0; i < n; ++i)
      hits[first + i] = h[i].hit.geomID == RTC_INVALID_GEOMETRY_ID ? Hit::none() : impl_->hit(h[i]);
    counters[Counter::RaysRefused] += refused;
    counters[kind] += n - refused;
  }
}

bool RayQuery::occluded(const Ray& ray, Counters& counters, Counter kind,
                        std::uint32_t mask) const {
  if (!acceptable(ray)) {
    ++counters[Counter::RaysRefused];
    return false;
  }
  const std::uint64_t number = ++counters[kind];
  RTCRay r;
  fill(r, ray, mask);
  Context context;
  impl_->clock.time(number, kind, 1, [&] { trace_any(impl_->top, context, &r); });
  return r.tfar < 0.0f;
}

const Scene& RayQuery::scene() const { return *impl_->scene; }
bool RayQuery::has(std::uint32_t mask) const { return (impl_->present & mask) != 0; }
RayTiming RayQuery::timing() const { return impl_->clock.timing(); }
std::size_t RayQuery::memory_bytes() const {
  return static_cast<std::size_t>(
      std::max<ssize_t>(0, __atomic_load_n(&impl_->bytes, __ATOMIC_RELAXED)));
}

}  // namespace atrium::scene
