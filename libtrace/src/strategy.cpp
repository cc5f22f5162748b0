#include "trace/strategy.h"

#include <variant>

#include "material/material.h"

namespace atrium::trace {
namespace {

constexpr double kSharpLobe = 20.0;   // c: facets within some 3 degrees
constexpr double kSmallLamps = 1e-3;  // of the area of the scene's bounds

/// What a scene has that matters here.
struct Inventory {
  bool receivers = false;  // something scatters with a density: paths may be joined there
  bool dirac = false;      // smooth mirrors, panes, glass
  bool sharp = false;      // lobes that hardly spread light
  bool points = false, suns = false;
  bool lamp_in_glass = false;
  double lamp_area = 0.0;
};

double area_of(const scene::Scene& scene, scene::ObjectId object) {
  const std::size_t count = scene.mesh_of(object).triangles.size();
  double sum = 0.0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto c = scene.corners(object, t);
    sum += 0.5 * static_cast<double>((c[1] - c[0]).cross(c[2] - c[0]).norm());
  }
  return sum;
}

Eigen::AlignedBox3f box_of(const scene::Scene& scene, scene::ObjectId object) {
  Eigen::AlignedBox3f box;
  const std::size_t count = scene.mesh_of(object).triangles.size();
  for (std::uint32_t t = 0; t < count; ++t)
    for (const Vec3f& c : scene.corners(object, t)) box.extend(c);
  return box;
}

void look_at_object(const scene::Scene& scene, scene::ObjectId id, Inventory& found,
                    std::vector<Eigen::AlignedBox3f>& lamps,
                    std::vector<Eigen::AlignedBox3f>& bodies) {
  const material::Material& m = scene.material_of(id);
  const material::MaterialTraits t = material::traits(m);
  found.receivers |= t.diffuse_reflection || t.diffuse_transmission || t.rough;
  found.dirac |= t.mirror || t.pane || (t.transmits && m.smooth());
  found.sharp |= t.rough && m.facets() && m.c > kSharpLobe;
  if (t.transmits) bodies.push_back(box_of(scene, id));
  if (!t.emissive) return;
  found.lamp_area += area_of(scene, id);
  lamps.push_back(box_of(scene, id));
}

Inventory look_through(const scene::Scene& scene) {
  Inventory found;
  std::vector<Eigen::AlignedBox3f> lamps, bodies;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    look_at_object(scene, scene::ObjectId(i), found, lamps, bodies);
  for (const auto& lamp : lamps)
    for (const auto& body : bodies) found.lamp_in_glass |= body.contains(lamp);
  for (const scene::Light& light : scene.lights) {
    const auto* sun = std::get_if<scene::DirectionalLight>(&light.kind);
    (sun != nullptr && sun->angular_radius > 0.0f ? found.suns : found.points) = true;
  }
  return found;
}

}  // namespace

PathStrategy choose_strategy(const scene::Scene& scene) {
  const Inventory found = look_through(scene);
  PathStrategy s;
  const Vec3d size = scene.bounds.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(scene.bounds.sizes());
  const double bounds = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const bool small_lamps = found.lamp_area > 0.0 && found.lamp_area < kSmallLamps * bounds;
  if (!found.dirac && !found.sharp) {
    s.reason = "nothing smooth deflects light: paths from the eye find all of it";
  } else if (!found.receivers) {
    s.reason = "no surface scatters light: nothing to join paths at";
  } else if (found.points) {
    s.reason = "lights without a size, and smooth surfaces that deflect their light";
  } else if (found.suns) {
    s.reason = "the sun, and smooth surfaces that deflect its light";
  } else if (found.lamp_in_glass) {
    s.reason = "lamps within glass";
  } else if (small_lamps) {
    s.reason = "lamps of less than a thousandth of the scene's area, and smooth surfaces";
  } else {
    s.reason = "lights are large enough for paths from the eye";
  }
  s.from_lights = found.receivers && (found.dirac || found.sharp) &&
                  (found.points || found.suns || found.lamp_in_glass || small_lamps);
  if (found.receivers && found.dirac && (found.points || found.suns)) {
    const std::string whose = !found.points ? "nearly all light of the sun"
                              : !found.suns
                                  ? "light of lights without a size"
                                  : "light of lights without a size, nearly all of the sun's,";
    s.missing.push_back("LSDSE, LSDDSE, LDDDSE: " + whose +
                        " that reaches every diffuse surface of its path by smooth mirrors or "
                        "glass and leaves it the same way");
  }
  return s;
}

}  // namespace atrium::trace
