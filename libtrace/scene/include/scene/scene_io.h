#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace atrium::scene {

struct ReadOptions {
  double emissive_nits_per_unit = 1.0;  ///< --emissive-unit: how emissive numbers of models count
  std::uint64_t memory_limit = 0;       ///< [bytes] for geometry and textures; 0: none
};

/// Reads one file by its ending (.glb .gltf .obj .ply .stl .yaml .yml) and appends it to the model.
/// \throws Error "FILE[:line[:column]]: what is wrong" for anything that cannot be read, or asks
/// for more than scene/limits.h allows. \throws RuntimeFailure  if it needs more than
/// ReadOptions::memory_limit.
void read_into(Model& model, const std::filesystem::path& file, const ReadOptions& options = {});

/// All files into one model.
[[nodiscard]] Model read_model(const std::vector<std::filesystem::path>& files,
                               const ReadOptions& options = {});

// One reader per format; read_into() chooses.
void read_gltf(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_obj(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_ply(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_stl(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_yaml(Model& model, const std::filesystem::path& file, const ReadOptions& options);

}  // namespace atrium::scene
