#pragma once

#include <vector>

#include "scene/mesh.h"
#include "yaml_scene.h"

namespace atrium::scene {

// Parts that plain shapes and subdivision cages share.

struct Box {
  Vec3d low;
  Vec3d high;
};
/// Either `min` and `max`, or `size` and `center`.
[[nodiscard]] Box read_extent(const YamlMap& map);
[[nodiscard]] std::vector<Vec3d> read_points(const YamlView& list);
[[nodiscard]] std::vector<std::vector<std::uint32_t>> read_faces(const YamlView& list,
                                                                 std::size_t points);
/// Takes vertices off what is left. \throws Error  if there are not as many.
void take_corners(std::size_t& left, std::size_t count, const YamlView& view);
/// A subdivision cage (yaml_cages.cpp).
[[nodiscard]] MeshData read_cage(const YamlView& view, std::size_t& corners_left);

}  // namespace atrium::scene
