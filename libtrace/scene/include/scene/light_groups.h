#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/surface_field.h"

namespace atrium::scene {

/// What sends light, numbered: Scene::lights first, then Scene::objects (those that emit), then the
/// environment.
[[nodiscard]] inline std::uint32_t light_source(const Scene& scene, ObjectId object) {
  return static_cast<std::uint32_t>(scene.lights.size()) + object.value;
}
[[nodiscard]] inline std::uint32_t environment_source(const Scene& scene) {
  return static_cast<std::uint32_t>(scene.lights.size() + scene.objects.size());
}

/// Lights that are switched and dimmed together.
struct LightGroups {
  std::vector<std::string> names;    ///< one or more
  std::vector<std::uint32_t> group;  ///< by source, into names

  [[nodiscard]] std::size_t size() const { return names.size(); }
};

enum class Grouping {
  One,       ///< all light in the group "all"
  Declared,  ///< as `light_group` in the scene says, the rest in "other"; "all" if it says nothing
  ByName     ///< as `light_group` says, the rest by the name of light or object
};
inline constexpr std::size_t kMostLightGroups = 64;

/// Groups in the order of their first source. \throws Error  with more than kMostLightGroups.
[[nodiscard]] LightGroups find_light_groups(const Scene& scene, Grouping grouping);

/// The part of a solution that is due to one group: arrays as in a SurfaceField.
struct GroupField {
  std::string name;
  double factor = 1.0;  ///< of this group in the field that it comes with; the arrays are of 1
  SurfaceField::Quantities irradiance, body_irradiance;
  /// By element and side, lane mean. Different groups' samples of lights and photons exclude each
  /// other, so their errors add up by squares at most; all groups share the rays of the indirect
  /// light, where errors add up as they are.
  std::vector<float> light_error;     ///< of direct and caustic light
  std::vector<float> indirect_error;  ///< of what diffuse surfaces reflect
};

/// The field of all groups as dimmed by `factors` (1: as it was solved), without a ray: irradiance
/// is linear in the lights. Standard errors are upper bounds from the groups' own:
/// sqrt(sum (f e_light)^2 + (sum f e_indirect)^2).
///
/// \param layout  a field of the same elements; its values do not count.
/// \param factors  >= 0, by group. GroupField::factor does not count.
/// \throws std::invalid_argument  if sizes disagree or a factor is negative or not finite.
[[nodiscard]] SurfaceField reweight(const SurfaceField& layout, std::span<const GroupField> groups,
                                    std::span<const double> factors);

}  // namespace atrium::scene
