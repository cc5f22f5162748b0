#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "model_budget.h"

namespace atrium::scene {

/// A parsed glTF file. Its structure is what the JSON says: indices are not checked yet.
struct GltfDocument {
  std::filesystem::path file;
  tinygltf::Model model;  ///< Image::image holds encoded bytes (data URIs only)
  std::vector<std::string> warnings;

  /// "FILE: what"
  [[nodiscard]] std::string at(const std::string& what) const {
    return file.string() + ": " + what;
  }
};

/// Reads .gltf and .glb with external buffers and data URIs. Images stay encoded.
/// \throws Error for anything that is no glTF 2.0 or lacks a buffer; RuntimeFailure beyond the
/// memory limit.
[[nodiscard]] GltfDocument load_gltf(const std::filesystem::path& file, ModelBudget& budget);

/// A model as a binary file: its first buffer, and images that are views of it.
/// \throws RuntimeFailure.
[[nodiscard]] std::vector<std::uint8_t> encode_gltf(tinygltf::Model& model);

}  // namespace atrium::scene
