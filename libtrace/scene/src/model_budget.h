#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"
#include "scene/scene_io.h"

namespace atrium::scene {

/// What a model may still take while it is read: limits::kTextureBytes for all its textures, and
/// ReadOptions::memory_limit for everything. The model must outlive it.
class ModelBudget {
 public:
  ModelBudget(const Model& model, const ReadOptions& options)
      : model_(model), limit_(options.memory_limit) {}

  /// \throws RuntimeFailure "WHAT: ..."  if `bytes` more go beyond the memory limit.
  void need(std::uint64_t bytes, const std::string& what);
  /// The same for a texture. \throws Error  if the textures become larger than any model's.
  void need_texture(std::uint64_t bytes, const std::string& what);

 private:
  void count();  ///< what the model has got since the last time

  const Model& model_;
  std::uint64_t limit_;
  std::size_t meshes_ = 0, textures_ = 0;  ///< counted so far
  std::uint64_t mesh_bytes_ = 0, texture_bytes_ = 0;
};

/// "12.5 MB", of 10^6 bytes.
[[nodiscard]] std::string megabytes(std::uint64_t bytes);

/// Bytes of a mesh's arrays.
[[nodiscard]] std::uint64_t bytes_of(const MeshData& mesh);

}  // namespace atrium::scene
