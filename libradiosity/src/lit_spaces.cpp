#include "lit_spaces.h"

#include <algorithm>
#include <map>

#include "scene/sampler.h"

namespace atrium::radiosity {

using scene::ObjectId;
using scene::SurfacePoint;

LitSpaces::LitSpaces(const scene::Scene& scene) : scene_(&scene), bodies_(scene) {
  lit_.insert(Bodies{});
  if (bodies_.bodies().empty()) return;
  add_lights();
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.material_of(ObjectId(i)).emissive()) add_emissive(ObjectId(i));
}

LitSpaces::Bodies LitSpaces::space_of(const Vec3f& point) const {
  return bodies_.containing(point, bodies_.near(Eigen::AlignedBox3f(point)));
}

void LitSpaces::add_lights() {
  for (const scene::Light& light : scene_->lights)
    if (!std::holds_alternative<scene::DirectionalLight>(light.kind))
      lit_.insert(space_of(light.to_scene.translation().cast<float>()));
}

/// The spaces that hold at least half of a lamp: one that is sunk into a wall makes no room of it.
void LitSpaces::add_emissive(ObjectId object) {
  constexpr std::uint32_t kPoints = 32;
  const std::vector<scene::Triangle>& triangles = scene_->mesh_of(object).triangles;
  const bool both = scene_->material_of(object).emits_both_sides;
  std::vector<double> until(triangles.size());
  double area = 0.0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto c = scene_->corners(object, t);
    until[t] = area += static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
  }
  std::map<Bodies, std::uint32_t> found;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    scene::Sampler sampler(0x1a3bU, object.value, k);
    const double x = (k + static_cast<double>(sampler.next_1d())) / kPoints * area;
    const auto it = std::min(std::upper_bound(until.begin(), until.end(), x), until.end() - 1);
    const Vec2f u = sampler.next_2d();
    const float root = std::sqrt(u.x());
    const SurfacePoint p =
        scene::surface_point(*scene_, object, static_cast<std::uint32_t>(it - until.begin()),
                             root * (1.0f - u.y()), root * u.y());
    const bool front = !both || k % 2 == 0;
    ++found[space_of(scene::offset_origin(p, front ? p.ng : Vec3f(-p.ng)))];
  }
  for (const auto& [space, count] : found)
    if (2 * count >= kPoints) lit_.insert(space);
}

LitSpaces::Bodies LitSpaces::near(const Elements& elements, std::uint32_t element) const {
  if (bodies_.bodies().empty()) return {};
  Eigen::AlignedBox3f box;
  for (std::uint32_t p = elements.first_piece[element]; p < elements.first_piece[element + 1]; ++p)
    for (const Vec3f& c : elements.pieces[p].corners) box.extend(c);
  // Origins lie off the surface by more than its rounding.
  const float margin = 1e-5f * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  box.min().array() -= margin;
  box.max().array() += margin;
  return bodies_.near(box);
}

bool LitSpaces::contains(const Vec3f& origin, const Bodies& near) const {
  return lit_.contains(bodies_.containing(origin, near));
}

std::vector<std::uint8_t> LitSpaces::inner_sides() const {
  constexpr std::uint8_t kNone = 2;
  std::vector<std::uint8_t> inner(scene_->objects.size(), kNone);
  std::vector<std::uint32_t> triangles(inner.size(), 0);
  std::vector<bool> refused(inner.size(), false);
  for (std::uint32_t b = 0; b < bodies_.bodies().size(); ++b) {
    const auto& body = bodies_.bodies()[b];
    const std::uint32_t o = body.object.value;
    const std::uint8_t side = body.volume > 0.0 ? 1 : 0;
    const bool lit = std::any_of(lit_.begin(), lit_.end(), [&](const Bodies& space) {
      return std::binary_search(space.begin(), space.end(), b);
    });
    if (lit || body.volume == 0.0 || (inner[o] != kNone && inner[o] != side)) refused[o] = true;
    inner[o] = side;
    triangles[o] += body.triangles;
  }
  for (std::uint32_t o = 0; o < inner.size(); ++o)
    if (refused[o] || triangles[o] != scene_->mesh_of(ObjectId(o)).triangles.size())
      inner[o] = kNone;
  return inner;
}

}  // namespace atrium::radiosity
