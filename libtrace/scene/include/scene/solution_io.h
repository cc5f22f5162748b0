#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/light_groups.h"
#include "scene/scene.h"
#include "scene/surface_field.h"

namespace atrium::scene {

/// A stored radiosity solution (`.atrium`): the field, and what it was computed for.
struct Solution {
  SurfaceField field;
  std::vector<GroupField> groups;  ///< whose sum, times GroupField::factor, the field is; or empty
  std::vector<char> state;         ///< radiosity::SolveResult::state, to go on from; may be empty
  std::uint64_t scene_hash = 0;    ///< hash_scene() of the scene that was solved
  std::string basis;               ///< SpectralBasis::describe()
  std::string options;             ///< how it was solved, for people
};

/// Dims a solution's groups, others stay as they are: sets its field and GroupField::factor, and
/// drops its state. No ray is traced.  \throws Error  that lists the groups if a name is not among
/// them, or a factor is negative or no number.
void dim(Solution& solution, const std::vector<std::pair<std::string, double>>& factors);

/// 64-bit hash of everything in a scene that light depends on: geometry, placement, materials,
/// textures, lights, environment, unit. Names, cameras and the load report do not count.
[[nodiscard]] std::uint64_t hash_scene(const Scene& scene);
/// The same in parts, so that a solution can go on where one of them has changed.
struct SceneHashes {
  std::uint64_t geometry = 0;   ///< meshes, and where which of them stands
  std::uint64_t materials = 0;  ///< materials but for the parts below, textures, air, unit
  /// What diffuse reflection alone depends on: the value of the body's reflectance of opaque
  /// materials whose parts are not coupled. That there is some, counts as `materials`.
  std::uint64_t reflectance = 0;
  std::uint64_t lights = 0;    ///< Scene::lights
  std::uint64_t emission = 0;  ///< environment, what surfaces emit
  bool operator==(const SceneHashes&) const = default;
};
[[nodiscard]] SceneHashes hash_parts(const Scene& scene);

/// Binary, complete or absent, with a checksum. \throws Error (folder), RuntimeFailure (writing).
void write_solution(const Solution& solution, const std::filesystem::path& file);

/// \throws Error  if the file is missing, no solution, of another version, truncated or damaged.
[[nodiscard]] Solution read_solution(const std::filesystem::path& file);

enum class Dimmed { Refused, Allowed };
/// Does a solution belong to this scene and basis? One of dimmed groups only where that is allowed:
/// the scene's lights are not dimmed.  \throws Error "FILE: ..." if not.
void check_solution(const Solution& solution, const Scene& scene, const std::string& basis,
                    const std::filesystem::path& file, Dimmed dimmed = Dimmed::Refused);

}  // namespace atrium::scene
