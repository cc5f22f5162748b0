#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/scene.h"
#include "scene/surface_field.h"

namespace atrium::scene {

/// A stored radiosity solution (`.atrium`): the field, and what it was computed for.
struct Solution {
  SurfaceField field;
  std::uint64_t scene_hash = 0;  ///< hash_scene() of the scene that was solved
  std::string basis;             ///< SpectralBasis::describe()
  std::string options;           ///< how it was solved, for people
};

/// 64-bit hash of everything in a scene that light depends on: geometry, placement, materials,
/// textures, lights, environment, unit. Names, cameras and the load report do not count.
[[nodiscard]] std::uint64_t hash_scene(const Scene& scene);

/// Binary, complete or absent, with a checksum. \throws Error (folder), RuntimeFailure (writing).
void write_solution(const Solution& solution, const std::filesystem::path& file);

/// \throws Error  if the file is missing, no solution, of another version, truncated or damaged.
[[nodiscard]] Solution read_solution(const std::filesystem::path& file);

/// Does a solution belong to this scene and basis?  \throws Error "FILE: ..." if not.
void check_solution(const Solution& solution, const Scene& scene, const std::string& basis,
                    const std::filesystem::path& file);

}  // namespace atrium::scene
