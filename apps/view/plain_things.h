#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh.h"
#include "scene/baked_model.h"
#include "scene/light_groups.h"
#include "selection.h"

namespace atrium::view {

struct LoadedScene;

/// What of a scene has no elements, so that no mesh holds it: mirrors, metals, glass, black lamps,
/// the sky. It is drawn plainly, without values.
struct PlainThings {
  scene::BakedModel model;  ///< a primitive per thing, then perhaps the sky
  Mesh shapes;  ///< the things; "object_id" says which primitive. Without polygons: none
  std::vector<std::uint32_t> object, material;  ///< ids in the scene, by thing

  [[nodiscard]] std::size_t size() const { return object.size(); }
  [[nodiscard]] bool has_sky() const { return model.primitives.size() > size(); }
  [[nodiscard]] bool is_glass(std::size_t thing) const;
  [[nodiscard]] const std::string& name(std::size_t thing) const {
    return model.primitives[thing].name;
  }
};

/// What has no polygon in the mesh. Nothing if the mesh does not name the scene's objects.
/// \param groups  of the solution, or empty. Things are as dimmed.
[[nodiscard]] PlainThings plain_things(const LoadedScene& loaded, const Mesh& mesh,
                                       std::span<const scene::GroupField> groups);

/// Light groups with these names and factors of 1, for plain_things(); none if the scene has
/// others.
[[nodiscard]] std::vector<scene::GroupField> groups_named(const scene::Scene& scene,
                                                          const std::vector<std::string>& names);

/// By thing: is it hidden as objects of the mesh are? \param no_ceilings  what covers its rooms is.
[[nodiscard]] std::vector<std::uint8_t> hidden_things(const PlainThings& things, const Mesh& mesh,
                                                      const std::vector<Selection>& hidden,
                                                      bool no_ceilings);

}  // namespace atrium::view
