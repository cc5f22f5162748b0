#include "scene/closed_bodies.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <span>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "adjacency.h"
#include "material/error.h"
#include "scene/edge_parts.h"

namespace atrium::scene {
namespace {

using Box = Eigen::AlignedBox3f;

/// What a ray crossed, collected by a filter that lets it go on.
struct Crossings {
#if EMBREE_MAJOR >= 4
  RTCRayQueryContext context;
#else
  RTCIntersectContext context;
#endif
  const std::uint32_t* first_body;  // by geometry of the top scene
  const std::vector<std::uint32_t>* candidates;
  std::vector<std::uint8_t>* odd;  // by candidate
};

void count_crossing(const RTCFilterFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  a->valid[0] = 0;
  auto* c = reinterpret_cast<Crossings*>(a->context);  // its first member
  const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
  const std::uint32_t instance = hit->instID[0];
  const std::uint32_t body = instance != RTC_INVALID_GEOMETRY_ID
                                 ? c->first_body[instance] + hit->geomID
                                 : c->first_body[hit->geomID];
  const auto it = std::lower_bound(c->candidates->begin(), c->candidates->end(), body);
  if (it == c->candidates->end() || *it != body) return;
  (*c->odd)[static_cast<std::size_t>(it - c->candidates->begin())] ^= 1U;
}

void trace(RTCScene scene, Crossings& c, RTCRayHit& ray) {
#if EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&c.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &c.context;
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcInitIntersectContext(&c.context);
  rtcIntersect1(scene, &c.context, &ray);
#endif
}

bool is_opaque(const material::Material& m) {
  const material::MaterialTraits t = material::traits(m);
  return m.medium == material::Material::Medium::Opaque && !t.diffuse_transmission && !t.alpha_mask;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Which triangles hang together, and where a boundary is left: at edges of an odd number of uses.
/// Where longer and shorter edges lie on each other (T-junctions) their parts are counted.
struct Connected {
  std::vector<std::uint32_t> parent;  ///< by triangle, see root_of()
  std::vector<std::uint32_t> open;    ///< triangles at a boundary
};

Connected connect(const Mesh& mesh) {
  const Weld weld = weld_positions(mesh.positions);
  const Adjacency edges = find_adjacency(mesh.triangles, weld);
  Connected c;
  c.parent.resize(mesh.triangles.size());
  std::iota(c.parent.begin(), c.parent.end(), 0U);
  std::vector<OpenEdge> odd;
  std::vector<std::uint32_t> triangle;  // of the odd edges
  edges.for_each_edge([&](const Adjacency::EdgeUse* first, const Adjacency::EdgeUse* last) {
    for (const auto* use = first + 1; use < last; ++use)
      c.parent[root_of(c.parent, use->slot / 3)] = root_of(c.parent, first->slot / 3);
    if ((last - first) % 2 == 0) return;
    const Triangle& t = mesh.triangles[first->slot / 3];
    const std::uint32_t v = t[first->slot % 3], w = t[(first->slot % 3 + 1) % 3];
    odd.push_back({mesh.positions[v].cast<double>(), mesh.positions[w].cast<double>(), weld.id[v],
                   weld.id[w]});
    triangle.push_back(first->slot / 3);
  });
  auto parts = divide_edges(odd);
  if (!parts) {
    c.open = std::move(triangle);
    return c;
  }
  const auto ends = [](const EdgePart& p) { return std::minmax(p.id_a, p.id_b); };
  std::stable_sort(parts->begin(), parts->end(),
                   [&](const EdgePart& x, const EdgePart& y) { return ends(x) < ends(y); });
  for (std::size_t i = 0, j = 0; i < parts->size(); i = j) {
    for (j = i; j < parts->size() && ends((*parts)[j]) == ends((*parts)[i]); ++j)
      c.parent[root_of(c.parent, triangle[(*parts)[j].edge])] =
          root_of(c.parent, triangle[(*parts)[i].edge]);
    if ((j - i) % 2 != 0) c.open.push_back(triangle[(*parts)[i].edge]);
  }
  return c;
}

/// Triangles of each closed part of a mesh; parts hang together across edges of any kind.
std::vector<std::vector<std::uint32_t>> closed_parts(const Mesh& mesh) {
  Connected connected = connect(mesh);
  std::vector<std::uint32_t>& parent = connected.parent;
  std::vector<bool> open(parent.size(), false);
  for (const std::uint32_t t : connected.open) open[root_of(parent, t)] = true;
  std::vector<std::uint32_t> part_of(parent.size(), Adjacency::kNone);
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::uint32_t t = 0; t < parent.size(); ++t) {
    const std::uint32_t root = root_of(parent, t);
    if (open[root]) continue;
    if (part_of[root] == Adjacency::kNone) {
      part_of[root] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part_of[root]].push_back(t);
  }
  return parts;
}

/// By the divergence theorem; 0 if the winding is visibly inconsistent.
double volume(const Scene& scene, ObjectId id, const std::vector<std::uint32_t>& part) {
  const Vec3d origin = scene.corners(id, part[0])[0].cast<double>();
  double sum = 0.0;
  Vec3d area = Vec3d::Zero();
  double total = 0.0;
  for (const std::uint32_t t : part) {
    const std::array<Vec3f, 3> c = scene.corners(id, t);
    const Vec3d a = c[0].cast<double>() - origin, b = c[1].cast<double>() - origin,
                d = c[2].cast<double>() - origin;
    const Vec3d cross = (b - a).cross(d - a);
    sum += a.dot(cross) / 6.0;
    area += cross;
    total += cross.norm();
  }
  // The area vector of a closed surface vanishes, but for the rounding of its corners.
  return area.norm() <= 1e-4 * total ? sum : 0.0;
}

}  // namespace

struct ClosedBodies::Impl {
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> shared;  // by mesh, null unless instanced
  std::vector<std::vector<std::vector<std::uint32_t>>> parts_of_mesh;
  std::vector<std::uint32_t> first_body;  // by geometry of `top`
  std::vector<Body> bodies;
  std::vector<Box> boxes;  // by body

  ~Impl() {
    for (const RTCScene s : shared)
      if (s != nullptr) rtcReleaseScene(s);
    if (top != nullptr) rtcReleaseScene(top);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  RTCGeometry geometry(const Mesh& mesh, const std::vector<std::uint32_t>& part) const {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::vector<std::uint32_t> to(mesh.positions.size(), Adjacency::kNone);
    std::vector<Vec3f> used;
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : part) {
      Triangle corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[t][k];
        if (to[v] == Adjacency::kNone) {
          to[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(mesh.positions[v]);
        }
        corners[k] = to[v];
      }
      triangles.push_back(corners);
    }
    auto* v = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), used.size()));
    void* t = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                      sizeof(Triangle), triangles.size());
    if (v == nullptr || t == nullptr) {
      rtcReleaseGeometry(g);
      throw RuntimeFailure("not enough memory for the closed bodies of mesh '" + mesh.name + "'");
    }
    std::ranges::uninitialized_copy(used, std::span(v, used.size()));
    std::memcpy(t, triangles.data(), triangles.size() * sizeof(Triangle));
    rtcSetGeometryIntersectFilterFunction(g, count_crossing);
    rtcCommitGeometry(g);
    return g;
  }

  static void attach(RTCScene scene, RTCGeometry g, std::size_t id) {
    rtcAttachGeometryByID(scene, g, static_cast<unsigned>(id));
    rtcReleaseGeometry(g);
  }

  RTCScene new_scene() const {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    return s;
  }

  void add(const Scene& scene, ObjectId id) {
    const Object& object = scene.objects[id.value];
    const Mesh& mesh = scene.mesh_of(id);
    const auto& parts = parts_of_mesh[object.mesh.value];
    if (parts.empty()) return;
    const auto first = static_cast<std::uint32_t>(boxes.size());
    for (const auto& part : parts) {
      Box box;
      for (const std::uint32_t t : part)
        for (const Vec3f& c : scene.corners(id, t)) box.extend(c);
      boxes.push_back(box);
      bodies.push_back({id, static_cast<std::uint32_t>(part.size()), volume(scene, id, part)});
    }
    if (!object.instanced) {
      for (std::size_t p = 0; p < parts.size(); ++p) {
        attach(top, geometry(mesh, parts[p]), first_body.size());
        first_body.push_back(first + static_cast<std::uint32_t>(p));
      }
      return;
    }
    RTCScene& s = shared[object.mesh.value];
    if (s == nullptr) {
      s = new_scene();
      for (std::size_t p = 0; p < parts.size(); ++p) attach(s, geometry(mesh, parts[p]), p);
      rtcCommitScene(s);
    }
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, s);
    const Eigen::Matrix<float, 3, 4> m = object.to_scene.affine();
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
    rtcCommitGeometry(g);
    attach(top, g, first_body.size());
    first_body.push_back(first);
  }

  /// Which of the candidates a ray from p crosses an odd number of times.
  void crossed_odd(const Vec3f& p, const Vec3f& direction, float length,
                   const std::vector<std::uint32_t>& candidates,
                   std::vector<std::uint8_t>& odd) const {
    odd.assign(candidates.size(), 0);
    RTCRayHit h{};
    h.ray.org_x = p.x();
    h.ray.org_y = p.y();
    h.ray.org_z = p.z();
    h.ray.dir_x = direction.x();
    h.ray.dir_y = direction.y();
    h.ray.dir_z = direction.z();
    h.ray.tfar = length;
    h.ray.mask = 0xffffffffU;
    h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Crossings c{{}, first_body.data(), &candidates, &odd};
    trace(top, c, h);
  }
};

ClosedBodies::ClosedBodies(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.parts_of_mesh.resize(scene.meshes.size());
  m.shared.resize(scene.meshes.size(), nullptr);
  std::vector<std::uint8_t> known(scene.meshes.size(), 0);
  m.device = rtcNewDevice(nullptr);
  if (m.device == nullptr) throw RuntimeFailure("Embree cannot create a device");
  m.top = m.new_scene();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ObjectId id(i);
    if (!is_opaque(scene.material_of(id))) continue;
    const std::uint32_t mesh = scene.objects[i].mesh.value;
    if (known[mesh] == 0) m.parts_of_mesh[mesh] = closed_parts(scene.meshes[mesh]);
    known[mesh] = 1;
    m.add(scene, id);
  }
  m.parts_of_mesh.clear();
  rtcCommitScene(m.top);
  if (const RTCError error = rtcGetDeviceError(m.device); error != RTC_ERROR_NONE)
    throw RuntimeFailure("Embree cannot build the closed bodies, error " + std::to_string(error));
}

ClosedBodies::~ClosedBodies() = default;
ClosedBodies::ClosedBodies(ClosedBodies&&) noexcept = default;
ClosedBodies& ClosedBodies::operator=(ClosedBodies&&) noexcept = default;

const std::vector<ClosedBodies::Body>& ClosedBodies::bodies() const { return impl_->bodies; }

std::vector<std::uint32_t> ClosedBodies::near(const Eigen::AlignedBox3f& box) const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t b = 0; b < impl_->boxes.size(); ++b)
    if (impl_->boxes[b].intersects(box)) result.push_back(b);
  return result;
}

std::vector<std::uint32_t> ClosedBodies::containing(
    const Vec3f& point, const std::vector<std::uint32_t>& candidates) const {
  std::vector<std::uint32_t> possible;
  float length = 0.0f;
  for (const std::uint32_t b : candidates) {
    const Box& box = impl_->boxes[b];
    if (!box.contains(point)) continue;
    possible.push_back(b);
    length = std::max(length, 2.0f * box.diagonal().norm());
  }
  if (possible.empty()) return possible;
  // Along no edge of what people build; a ray that meets one all the same is outvoted.
  static const std::array<Vec3f, 3> directions{Vec3f(0.5773f, 0.2113f, 0.7887f).normalized(),
                                               Vec3f(-0.6411f, 0.7421f, 0.1931f).normalized(),
                                               Vec3f(0.2371f, -0.4817f, -0.8437f).normalized()};
  std::array<std::vector<std::uint8_t>, 3> odd;
  impl_->crossed_odd(point, directions[0], length, possible, odd[0]);
  impl_->crossed_odd(point, directions[1], length, possible, odd[1]);
  if (odd[0] != odd[1]) impl_->crossed_odd(point, directions[2], length, possible, odd[2]);
  const bool third = odd[0] != odd[1];
  std::vector<std::uint32_t> inside;
  for (std::size_t k = 0; k < possible.size(); ++k) {
    const int votes = odd[0][k] + odd[1][k] + (third ? odd[2][k] : 0);
    if (votes >= 2) inside.push_back(possible[k]);
  }
  return inside;
}

}  // namespace atrium::scene
