#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace atrium::scene {

struct ReadOptions {
  double emissive_nits_per_unit = 1.0;  ///< --emissive-unit: how emissive numbers of models count
};

/// Reads one file by its ending (.glb .gltf .obj .ply .stl .yaml .yml) and appends it to the model.
/// \throws Error "FILE[:line[:column]]: what is wrong" for anything that cannot be read.
void read_into(Model& model, const std::filesystem::path& file, const ReadOptions& options = {});

/// All files into one model.
[[nodiscard]] Model read_model(const std::vector<std::filesystem::path>& files,
                               const ReadOptions& options = {});

// One reader per format; read_into() chooses.
void read_gltf(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_obj(Model& model, const std::filesystem::path& file, const ReadOptions& options);
void read_mesh_file(Model& model, const std::filesystem::path& file, const ReadOptions& options);  // PLY, STL
void read_yaml(Model& model, const std::filesystem::path& file, const ReadOptions& options);

}  // namespace atrium::scene
